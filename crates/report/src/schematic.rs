//! A picture of a model: nodes from the ground outwards, what joins them, what drives it and what is measured.
//!
//! Points of a body stand beside it, joined by a plain line; a beam is a double line, a cylinder a piston in its tube. Blocks
//! and valves stand below the machine (`drives`).
//!
//! Column d holds the nodes that are d members away from what does not move freely: the ground and, below all other rows,
//! moving bases in column 0. Members between the same nodes lie beside each other.

mod drives;
mod parts;
mod simulator;

use parts::{BOX, COLUMN, FIRST, ROW, boxed, driven, label, lines_below, measured_at};
use simgap_model::{Drawing, GROUND, Glyph, Location, Model, same_pair};

use crate::chart::NEUTRAL_COLOURS;
use crate::markup::escape;

/// Where the wall stands.
const WALL: f64 = 30.0;
/// Distance between members that lie beside each other.
const BESIDE: f64 = 26.0;
/// Half the width of a spring or a damper.
const HALF: f64 = 8.0;
/// Half waves of a spring.
const WAVES: usize = 8;

/// A node and where it is drawn.
struct Node {
    name: String,
    column: usize,
    at: [f64; 2],
}

/// What a member is drawn as.
#[derive(Clone, Copy)]
enum Shape {
    Spring,
    Damper,
    Element(Glyph),
    Rigid,
}

/// The picture of a model as SVG. Equal models give equal bytes.
#[must_use]
pub fn schematic_svg(model: &Model) -> String {
    let nodes = placed(model);
    let rows = |node: &Node| (node.at[1] - FIRST[1]) / ROW;
    let most_rows = nodes.iter().map(rows).fold(0.0, f64::max);
    let columns = nodes.iter().map(|node| node.column).max().unwrap_or(0);
    let right = FIRST[0] + columns as f64 * COLUMN + 130.0;
    let below = FIRST[1] + most_rows * ROW + 80.0;
    let drives = drives::drawn(model, below + 20.0);
    let ink = NEUTRAL_COLOURS[0].light;
    let mut body = String::new();
    if nodes.iter().any(|node| node.name == GROUND) {
        body.push_str(&wall(below));
    }
    for pair in joints(model) {
        let members = members_between(model, &pair);
        for (k, (shape, name)) in members.iter().enumerate() {
            let beside = BESIDE * (k as f64 - (members.len() as f64 - 1.0) / 2.0);
            if let (Some(a), Some(b)) = (find(&nodes, &pair[0]), find(&nodes, &pair[1])) {
                // From left to right, so that the first member lies above the next.
                let (a, b) = if a.column > b.column { (b, a) } else { (a, b) };
                body.push_str(&member(
                    *shape,
                    name,
                    edge(a, b, beside),
                    edge(b, a, -beside),
                ));
            }
        }
    }
    for node in nodes.iter().filter(|node| node.name != GROUND) {
        body.push_str(&node_box(model, node));
    }
    let (width, height) = match (simulator::drawn(model), drives) {
        (Some((signals, size)), _) => {
            body = signals;
            (size[0], size[1])
        }
        (None, None) => (right, below),
        (None, Some((signals, [to_right, to_bottom]))) => {
            body.push_str(&signals);
            (right.max(to_right), to_bottom)
        }
    };
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" width=\"{width}\" height=\"{height}\" \
         role=\"img\" font-family=\"sans-serif\" font-size=\"12\"><title>{}</title><rect width=\"100%\" height=\"100%\" \
         fill=\"#FFFFFF\"/><g fill=\"none\" stroke=\"{ink}\" stroke-width=\"1.5\">{body}</g></svg>\n",
        escape(&model.name)
    )
}

/// Pairs of nodes that something joins, each once.
fn joints(model: &Model) -> Vec<[String; 2]> {
    let mut pairs: Vec<[String; 2]> = vec![];
    let drawings = model.drawings();
    let drawn = drawings.iter();
    let symbols = drawn.clone().filter_map(|(_, drawing)| match drawing {
        Drawing::Member { between, .. } => Some(between),
        _ => None,
    });
    let rigid = drawn.filter_map(|(_, drawing)| match drawing {
        Drawing::Rigid(pairs) => Some(pairs),
        _ => None,
    });
    let of_elements = symbols.chain(rigid.flatten()).cloned();
    for pair in model.members().into_iter().chain(of_elements) {
        if !pairs.iter().any(|known| same_pair(known, &pair)) {
            pairs.push(pair);
        }
    }
    pairs
}

/// Nodes column by column.
fn placed(model: &Model) -> Vec<Node> {
    let pairs = joints(model);
    let bases = model.base_nodes();
    let mut columns: Vec<Vec<&str>> = vec![bases];
    let joined = |a: &str, b: &str| {
        pairs
            .iter()
            .any(|pair| same_pair(pair, &[a.into(), b.into()]))
    };
    let is_grounded = pairs.iter().flatten().any(|node| node == GROUND);
    if is_grounded {
        columns[0].insert(0, GROUND);
    }
    // Coordinates that are no places: rolls, modes of beams, pressures, spools, states of blocks.
    let is_place = |name: &&str| !(model.is_roll(name) || model.is_internal(name));
    let masses = model.masses.iter().map(|mass| mass.name.as_str());
    let mut left: Vec<&str> = masses.filter(is_place).collect();
    for name in pairs.iter().flatten() {
        if name != GROUND && !left.contains(&name.as_str()) && !columns[0].contains(&name.as_str())
        {
            left.push(name);
        }
    }
    while !left.is_empty() {
        let last = columns.last().cloned().unwrap_or_default();
        let near = |name: &&str| last.iter().any(|other| joined(name, other));
        let (mut next, rest): (Vec<&str>, Vec<&str>) = left.iter().copied().partition(near);
        left = rest;
        if next.is_empty() {
            // Masses that nothing joins to the others.
            next = std::mem::take(&mut left);
        }
        columns.push(next);
    }
    let most = columns.iter().skip(1).map(Vec::len).max().unwrap_or(0);
    let mut nodes = vec![];
    for (column, names) in columns.iter().enumerate() {
        let mut row = if column == 0 { most } else { 0 };
        for &name in names {
            let is_wall = name == GROUND;
            let x = FIRST[0] + column as f64 * COLUMN;
            let y = FIRST[1] + ROW * if is_wall { 0.0 } else { row as f64 };
            let at = [x, y];
            let name = name.to_owned();
            nodes.push(Node { name, column, at });
            row += usize::from(!is_wall);
        }
    }
    nodes
}

fn find<'a>(nodes: &'a [Node], name: &str) -> Option<&'a Node> {
    nodes.iter().find(|node| node.name == name)
}

/// What joins two nodes, with its name; a point and its body have none.
fn members_between(model: &Model, pair: &[String; 2]) -> Vec<(Shape, String)> {
    // The static stiffness of a beam is drawn with the beam.
    let springs = model.springs.iter().filter(|s| !model.is_of_element(s));
    let springs = springs.filter(|s| same_pair(&s.between, pair));
    let dampers = model.dampers.iter().filter(|d| same_pair(&d.between, pair));
    let drawings = model.drawings().into_iter();
    let elements = drawings.filter_map(|(name, drawing)| match drawing {
        Drawing::Member { between, glyph } if same_pair(&between, pair) => {
            Some((Shape::Element(glyph), name))
        }
        _ => None,
    });
    let mut found: Vec<(Shape, String)> = springs
        .map(|spring| (Shape::Spring, spring.name.clone()))
        .chain(dampers.map(|damper| (Shape::Damper, damper.name.clone())))
        .chain(elements)
        .collect();
    if found.is_empty() {
        found.push((Shape::Rigid, String::new()));
    }
    found
}

/// Where a member leaves node `a` towards node `b`, `beside` the line between them.
fn edge(a: &Node, b: &Node, beside: f64) -> [f64; 2] {
    if a.name == GROUND {
        // The wall is as high as the picture.
        return [WALL, b.at[1] + beside];
    }
    if a.column == b.column {
        let down = if b.at[1] > a.at[1] { 1.0 } else { -1.0 };
        return [a.at[0] + beside * down, a.at[1] + down * BOX[1] / 2.0];
    }
    let right = if b.column > a.column { 1.0 } else { -1.0 };
    [a.at[0] + right * BOX[0] / 2.0, a.at[1] + right * beside]
}

/// The ground: a hatched wall.
fn wall(height: f64) -> String {
    let x = WALL;
    let hatches: String = (0..((height - 40.0) / 12.0) as usize)
        .map(|k| {
            let y = 24.0 + 12.0 * k as f64;
            format!("M{x} {y}l-10 10")
        })
        .collect();
    format!(
        "<path d=\"M{x} 20V{}{hatches}\"/>{}",
        height - 20.0,
        label([x - 4.0, height - 6.0], "ground")
    )
}

/// A member from one point to another.
fn member(shape: Shape, name: &str, from: [f64; 2], to: [f64; 2]) -> String {
    let [dx, dy] = [to[0] - from[0], to[1] - from[1]];
    let length = dx.hypot(dy).max(1.0);
    let (u, n) = ([dx / length, dy / length], [-dy / length, dx / length]);
    // A point so far along and so far beside the line.
    let point = |along: f64, beside: f64| {
        let x = from[0] + along * length * u[0] + beside * n[0];
        let y = from[1] + along * length * u[1] + beside * n[1];
        format!("{x:.1} {y:.1}")
    };
    let (begin, end) = (0.25, 0.75);
    let path = match shape {
        Shape::Spring => {
            let turns: String = (0..=WAVES)
                .map(|k| {
                    let along = begin + (end - begin) * k as f64 / WAVES as f64;
                    let side = if k == 0 || k == WAVES {
                        0.0
                    } else if k % 2 == 0 {
                        HALF
                    } else {
                        -HALF
                    };
                    format!("L{}", point(along, side))
                })
                .collect();
            format!("M{}{turns}L{}", point(0.0, 0.0), point(1.0, 0.0))
        }
        Shape::Damper => format!(
            "M{}L{}M{}L{}L{}L{}M{}L{}M{}L{}",
            point(0.0, 0.0),
            point(0.4, 0.0),
            point(0.6, -HALF),
            point(0.4, -HALF),
            point(0.4, HALF),
            point(0.6, HALF),
            point(0.52, -HALF + 2.0),
            point(0.52, HALF - 2.0),
            point(0.52, 0.0),
            point(1.0, 0.0)
        ),
        Shape::Element(Glyph::Beam) => {
            let [a, b, c, d] = [(0.0, -2.0), (1.0, -2.0), (0.0, 2.0), (1.0, 2.0)]
                .map(|(along, beside)| point(along, beside));
            format!("M{a}L{b}M{c}L{d}")
        }
        // The tube on the side of the first node, the piston and its rod on that of the second.
        Shape::Element(Glyph::Cylinder) => {
            let tube = [
                (0.25, -HALF),
                (0.7, -HALF),
                (0.7, HALF),
                (0.25, HALF),
                (0.25, -HALF),
            ]
            .map(|(along, beside)| point(along, beside));
            let [first, tube_end] = [point(0.0, 0.0), point(0.25, 0.0)];
            let piston = [(0.48, -HALF), (0.48, HALF), (0.48, 0.0), (1.0, 0.0)]
                .map(|(along, beside)| point(along, beside));
            format!(
                "M{first}L{tube_end}M{}M{}L{}M{}L{}",
                tube.join("L"),
                piston[0],
                piston[1],
                piston[2],
                piston[3]
            )
        }
        Shape::Rigid => format!("M{}L{}", point(0.0, 0.0), point(1.0, 0.0)),
    };
    let middle = [(from[0] + to[0]) / 2.0, (from[1] + to[1]) / 2.0];
    if matches!(shape, Shape::Rigid) {
        return format!("<path d=\"{path}\"/>");
    }
    let title = format!("<title>{}</title>", escape(name));
    let beyond = match shape {
        Shape::Element(Glyph::Beam) | Shape::Rigid => middle[1] - 7.0,
        Shape::Element(Glyph::Cylinder) | Shape::Spring => middle[1] - HALF - 3.0,
        Shape::Damper => middle[1] + HALF + 13.0,
    };
    format!(
        "<path d=\"{path}\">{title}</path>{}",
        label([middle[0], beyond], name)
    )
}

/// A node, what drives it above and what is measured or acts on it below.
fn node_box(model: &Model, node: &Node) -> String {
    let is_base = model.base_nodes().contains(&node.name.as_str());
    let mut text = boxed(&node.name, node.at, BOX, is_base);
    text.push_str(&driven(model, &node.name, node.at, BOX));
    let acting = model.effects.iter().filter(|effect| match &effect.at {
        Location::Between([a, b]) => *a == node.name || (*b == node.name && a == GROUND),
        Location::Mass(mass) => *mass == node.name,
        Location::Input(_) | Location::Channel(_) | Location::Parameter(_) => false,
    });
    let mut lines = measured_at(model, &node.name);
    lines.extend(acting.map(|effect| effect.kind.replace('_', " ")));
    text.push_str(&lines_below(node.at, &lines));
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verify_a_simulator_is_a_box_with_its_signals_and_ports() {
        let text = "schema = \"simgap-model/1\"\nname = \"arm\"\n\
            [[input]]\nchannel = \"torque\"\nkind = \"signal\"\nat = \"torque\"\n\
            [[port]]\nname = \"joint\"\ndisplacement = \"q\"\nvelocity = \"qd\"\n\
            [[output]]\nchannel = \"q\"\nkind = \"signal\"\n";
        let svg = schematic_svg(&Model::from_toml(text).unwrap());
        for shown in [">arm<", ">torque<", ">q<", ">force at joint<"] {
            assert!(svg.contains(shown), "{shown}: {svg}");
        }
    }

    fn model(name: &str) -> Model {
        let text = format!(
            "schema = \"simgap-model/1\"\nname = \"two\"\n[[mass]]\nname = \"{name}\"\nvalue = 1.0\n\
             [[mass]]\nname = \"free\"\nvalue = 1.0\n[[spring]]\nname = \"k\"\nbetween = [\"{name}\", \"ground\"]\n\
             stiffness = 1.0\n[[damper]]\nname = \"c\"\nbetween = [\"ground\", \"{name}\"]\ndamping = 1.0\n\
             [[output]]\nchannel = \"y\"\nkind = \"displacement\"\nat = \"{name}\"\n"
        );
        Model::from_toml(&text).unwrap_or_default()
    }

    #[test]
    fn verify_nodes_stand_in_the_order_of_their_distance_from_the_ground() {
        let model = model("table");
        let nodes = placed(&model);
        let told: Vec<(&str, usize)> = nodes.iter().map(|n| (n.name.as_str(), n.column)).collect();
        assert_eq!(told, [("ground", 0), ("table", 1), ("free", 2)]);
    }

    #[test]
    fn verify_a_beam_is_drawn_once() {
        let text = "schema = \"simgap-model/1\"\nname = \"leaf\"\n[[mass]]\nname = \"m\"\nvalue = 1.0\n\
             [[beam]]\nname = \"leaf\"\nbetween = [\"m\", \"ground\"]\nlength = 1.0\nwidth = 0.1\nthickness = 0.01\n\
             youngs_modulus = 2.1e11\ndensity = 7850.0\n\
             [[output]]\nchannel = \"y\"\nkind = \"displacement\"\nat = \"m\"\n";
        let svg = schematic_svg(&Model::from_toml(text).unwrap_or_default());
        assert_eq!(
            svg.matches("<title>leaf</title>").count(),
            2,
            "the picture and its beam"
        );
    }

    #[test]
    fn verify_names_are_escaped_and_every_part_is_drawn() {
        let svg = schematic_svg(&model("a<b"));
        assert!(svg.contains("a&lt;b") && !svg.contains("a<b"));
        for part in [
            "<title>k</title>",
            "<title>c</title>",
            "measured: y",
            "ground",
        ] {
            assert!(svg.contains(part), "{part}");
        }
    }
}
