//! The signals of a drive: blocks, then valves, in rows of boxes below the machine.
//!
//! Column d holds the blocks that are d blocks away from what comes from outside, the last column the valves. An arrow leads from
//! a block to a block or a valve; what else goes into a block and comes out of it is written below.

use simgap_model::{Block, Model, Valve};

use super::parts::{BOX, COLUMN, FIRST, ROW, arrow, boxed, driven, lines_below, measured_at};

/// Size of a block or a valve, pixels: their names are longer than those of masses.
const PART: [f64; 2] = [120.0, BOX[1]];

/// A block or a valve and where it is drawn.
struct Part<'a> {
    name: &'a str,
    at: [f64; 2],
}

/// The picture of blocks and valves below a height, and its lower right corner; `None` where a model has neither.
pub(super) fn drawn(model: &Model, top: f64) -> Option<(String, [f64; 2])> {
    let columns = columns(model);
    let most = columns
        .iter()
        .map(Vec::len)
        .max()
        .filter(|most| *most > 0)?;
    let mut parts = vec![];
    for (column, names) in columns.iter().enumerate() {
        for (row, &name) in names.iter().enumerate() {
            let x = FIRST[0] + column as f64 * COLUMN;
            let y = top + BOX[1] + row as f64 * ROW;
            parts.push(Part { name, at: [x, y] });
        }
    }
    let mut text = String::new();
    for (from, to) in arrows(model) {
        let find = |name: &str| parts.iter().find(|part| part.name == name);
        if let (Some(from), Some(to)) = (find(from), find(to)) {
            text.push_str(&between(from.at, to.at));
        }
    }
    for part in &parts {
        text.push_str(&boxed(part.name, part.at, PART, false));
        text.push_str(&driven(model, part.name, part.at, PART));
        text.push_str(&lines_below(part.at, &told(model, part.name)));
    }
    let right = FIRST[0] + (columns.len() - 1) as f64 * COLUMN + 130.0;
    Some((text, [right, top + BOX[1] + most as f64 * ROW - 20.0]))
}

/// Blocks column by column, then the valves; no column is empty but where a model has no block.
fn columns(model: &Model) -> Vec<Vec<&str>> {
    let mut rank = vec![0; model.blocks.len()];
    let place = |name: &String| model.blocks.iter().position(|block| block.name == *name);
    // As many rounds as there are blocks: a loop goes on no longer.
    for _ in 0..model.blocks.len() {
        for (i, block) in model.blocks.iter().enumerate() {
            let sources = block.plus.iter().chain(&block.minus).filter_map(place);
            let next = sources.filter(|j| *j != i).map(|j| rank[j] + 1).max();
            rank[i] = next.unwrap_or(0).min(model.blocks.len() - 1);
        }
    }
    let last = rank.iter().max().map_or(0, |last| last + 1);
    let of_rank = |wanted: usize| {
        let blocks = model.blocks.iter().zip(&rank);
        let own = blocks.filter(move |(_, rank)| **rank == wanted);
        own.map(|(block, _)| block.name.as_str()).collect()
    };
    let mut columns: Vec<Vec<&str>> = (0..last).map(of_rank).collect();
    columns.retain(|names| !names.is_empty());
    if !model.valves.is_empty() {
        columns.push(
            model
                .valves
                .iter()
                .map(|valve| valve.name.as_str())
                .collect(),
        );
    }
    columns
}

/// What goes into a block, with its name.
fn sources(block: &Block) -> impl Iterator<Item = (&str, &str)> {
    let sources = block.plus.iter().chain(&block.minus);
    sources.map(|source| (source.as_str(), block.name.as_str()))
}

/// From which block to which block or valve a signal goes.
fn arrows(model: &Model) -> Vec<(&str, &str)> {
    let orders = model.valves.iter();
    let orders = orders.filter_map(|valve| Some((valve.from.as_deref()?, valve.name.as_str())));
    model
        .blocks
        .iter()
        .flat_map(sources)
        .chain(orders)
        .collect()
}

fn between(from: [f64; 2], to: [f64; 2]) -> String {
    arrow(
        [from[0] + PART[0] / 2.0, from[1]],
        [to[0] - PART[0] / 2.0, to[1]],
    )
}

/// What is written below a block or a valve.
fn told(model: &Model, name: &str) -> Vec<String> {
    if let Some(block) = model.blocks.iter().find(|block| block.name == name) {
        return told_of_block(model, block);
    }
    let valve = model.valves.iter().find(|valve| valve.name == name);
    valve.map_or(vec![], |valve| told_of_valve(model, valve))
}

fn told_of_block(model: &Model, block: &Block) -> Vec<String> {
    let is_block = |name: &String| model.blocks.iter().any(|other| other.name == *name);
    let outside = |names: &[String], sign: &str| -> Vec<String> {
        let names = names.iter().filter(|name| !is_block(name));
        names.map(|name| format!("{sign} {name}")).collect()
    };
    let mut lines = outside(&block.plus, "+");
    lines.extend(outside(&block.minus, "\u{2212}"));
    lines.extend(block.force.iter().map(|node| format!("force on {node}")));
    lines
}

fn told_of_valve(model: &Model, valve: &Valve) -> Vec<String> {
    let mut lines = vec![format!("feeds {}", valve.cylinder)];
    lines.extend(measured_at(model, &valve.name));
    let cylinder = model.cylinders.iter().find(|c| c.name == valve.cylinder);
    for chamber in cylinder.into_iter().flat_map(|c| c.chambers()) {
        lines.extend(measured_at(model, &chamber));
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mold() -> Model {
        let side = |side: &str, offset: f64| {
            format!(
                "[[point]]\nname = \"{side}\"\nbody = \"mold\"\noffset = {offset:?}\n\
                 [[cylinder]]\nname = \"{side}\"\nbetween = [\"mold.{side}\", \"ground\"]\nareas = [0.02, 0.012]\n\
                 dead_volumes = [5e-4, 5e-4]\nstroke = 0.08\nbulk_modulus = 1.4e9\n\
                 [[valve]]\nname = \"servo {side}\"\ncylinder = \"{side}\"\nfrom = \"controller {side}\"\n\
                 rated_flow = 3.3e-3\nrated_drop = 3.5e6\nnatural_freq = 60.0\ndamping_ratio = 0.8\nsupply = 21e6\n\
                 [[block]]\nname = \"controller {side}\"\nnumerator = [60.0]\ndenominator = [1.0]\n\
                 plus = [\"reference\"]\nminus = [\"mold.{side}\"]\n\
                 [[output]]\nchannel = \"p1_{side}\"\nkind = \"pressure\"\nat = \"{side}.p1\"\n"
            )
        };
        let text = format!(
            "schema = \"simgap-model/1\"\nname = \"mold\"\n\
             [[body]]\nname = \"mold\"\nmass = 33000.0\ninertia = 19000.0\n\
             [[block]]\nname = \"reference\"\nnumerator = [1.0]\ndenominator = [1.0]\n\
             [[input]]\nchannel = \"r\"\nkind = \"set_point\"\nat = \"reference\"\n{}{}",
            side("left", -1.5),
            side("right", 1.5)
        );
        Model::from_toml(&text).unwrap_or_default()
    }

    #[test]
    fn verify_signals_go_from_left_to_right() {
        let model = mold();
        let wanted = [
            vec!["reference"],
            vec!["controller left", "controller right"],
            vec!["servo left", "servo right"],
        ];
        assert_eq!(columns(&model), wanted);
        let parts = wanted.concat();
        let arrows = arrows(&model).into_iter();
        // What is measured of the machine comes without an arrow.
        let between: Vec<_> = arrows.filter(|(from, _)| parts.contains(from)).collect();
        assert_eq!(between.len(), 4);
        let (text, _) = drawn(&model, 0.0).unwrap_or_default();
        for part in [
            "servo left",
            "feeds left",
            "measured: p1_left",
            "\u{2212} mold.left",
            "set point",
        ] {
            assert!(text.contains(part), "{part}");
        }
    }

    #[test]
    fn verify_a_loop_of_blocks_ends() {
        let mut model = mold();
        model.blocks[0].plus = vec!["controller left".into()];
        let names = columns(&model).concat();
        assert_eq!(names.len(), 5);
    }

    #[test]
    fn verify_a_model_without_drives_has_no_such_rows() {
        assert!(drawn(&Model::default(), 0.0).is_none());
    }
}
