//! The signals of a drive: boxes below the machine (blocks, valves).
//!
//! Column d holds the boxes that are d boxes away from what comes from outside, the last column those next to the machine. An
//! arrow leads from a box to a box; what else goes into one and comes out of it is written below.

use simgap_model::{Drawing, Model};

use super::parts::{BOX, COLUMN, FIRST, ROW, arrow, boxed, driven, lines_below, measured_at};

/// Size of a box, pixels: their names are longer than those of masses.
const PART: [f64; 2] = [120.0, BOX[1]];

/// An element that is drawn as a box.
struct Part {
    name: String,
    /// What goes in, with its sign.
    signals: Vec<(&'static str, String)>,
    lines: Vec<String>,
    measured: Vec<String>,
    is_last: bool,
}

/// The boxes of a model.
fn parts(model: &Model) -> Vec<Part> {
    let drawings = model.drawings().into_iter();
    let boxes = drawings.filter_map(|(name, drawing)| match drawing {
        Drawing::Box {
            signals,
            lines,
            measured,
            is_last,
        } => Some(Part {
            name,
            signals,
            lines,
            measured,
            is_last,
        }),
        _ => None,
    });
    boxes.collect()
}

/// The picture of the boxes below a height, and its lower right corner; `None` where a model has none.
pub(super) fn drawn(model: &Model, top: f64) -> Option<(String, [f64; 2])> {
    let parts = parts(model);
    let columns = columns(&parts);
    let most = columns
        .iter()
        .map(Vec::len)
        .max()
        .filter(|most| *most > 0)?;
    let mut placed: Vec<(&Part, [f64; 2])> = vec![];
    for (column, parts) in columns.iter().enumerate() {
        for (row, &part) in parts.iter().enumerate() {
            let x = FIRST[0] + column as f64 * COLUMN;
            let y = top + BOX[1] + row as f64 * ROW;
            placed.push((part, [x, y]));
        }
    }
    let mut text = String::new();
    for (from, to) in arrows(&parts) {
        let find = |name: &str| placed.iter().find(|(part, _)| part.name == name);
        if let (Some((_, from)), Some((_, to))) = (find(from), find(to)) {
            text.push_str(&between(*from, *to));
        }
    }
    for (part, at) in &placed {
        text.push_str(&boxed(&part.name, *at, PART, false));
        text.push_str(&driven(model, &part.name, *at, PART));
        text.push_str(&lines_below(*at, &told(model, &parts, part)));
    }
    let right = FIRST[0] + (columns.len() - 1) as f64 * COLUMN + 130.0;
    Some((text, [right, top + BOX[1] + most as f64 * ROW - 20.0]))
}

/// Boxes column by column, those next to the machine last; no column is empty.
fn columns(parts: &[Part]) -> Vec<Vec<&Part>> {
    let (last, inner): (Vec<&Part>, Vec<&Part>) = parts.iter().partition(|part| part.is_last);
    let mut rank = vec![0; inner.len()];
    let place = |name: &String| inner.iter().position(|part| part.name == *name);
    // As many rounds as there are boxes: a loop goes on no longer.
    for _ in 0..inner.len() {
        for (i, part) in inner.iter().enumerate() {
            let sources = part.signals.iter().filter_map(|(_, name)| place(name));
            let next = sources.filter(|j| *j != i).map(|j| rank[j] + 1).max();
            rank[i] = next.unwrap_or(0).min(inner.len() - 1);
        }
    }
    let ranks = rank.iter().max().map_or(0, |most| most + 1);
    let of_rank = |wanted: usize| {
        let ranked = inner.iter().zip(&rank);
        let own = ranked.filter(move |(_, rank)| **rank == wanted);
        own.map(|(part, _)| *part).collect()
    };
    let mut columns: Vec<Vec<&Part>> = (0..ranks).map(of_rank).collect();
    columns.push(last);
    columns.retain(|parts| !parts.is_empty());
    columns
}

/// From which box to which box a signal goes; what comes from elsewhere leads from no box.
fn arrows(parts: &[Part]) -> Vec<(&str, &str)> {
    let (last, inner): (Vec<&Part>, Vec<&Part>) = parts.iter().partition(|part| part.is_last);
    let all = inner.into_iter().chain(last);
    all.flat_map(|part| {
        let signals = part.signals.iter();
        signals.map(|(_, source)| (source.as_str(), part.name.as_str()))
    })
    .collect()
}

fn between(from: [f64; 2], to: [f64; 2]) -> String {
    arrow(
        [from[0] + PART[0] / 2.0, from[1]],
        [to[0] - PART[0] / 2.0, to[1]],
    )
}

/// What is written below a box.
fn told(model: &Model, parts: &[Part], part: &Part) -> Vec<String> {
    let is_box = |name: &String| parts.iter().any(|other| other.name == *name);
    let outside = part.signals.iter().filter(|(_, name)| !is_box(name));
    let mut lines: Vec<String> = outside
        .map(|(sign, name)| format!("{sign} {name}"))
        .collect();
    lines.extend(part.lines.iter().cloned());
    let measured = part.measured.iter();
    lines.extend(measured.flat_map(|name| measured_at(model, name)));
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
        let boxes = parts(&model);
        let names = |parts: Vec<&Part>| parts.into_iter().map(|p| p.name.clone()).collect();
        let found: Vec<Vec<String>> = columns(&boxes).into_iter().map(names).collect();
        assert_eq!(found, wanted);
        let parts = wanted.concat();
        let arrows = arrows(&boxes).into_iter();
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
        model.elements.blocks[0].plus = vec!["controller left".into()];
        let boxes = parts(&model);
        let names = columns(&boxes).concat();
        assert_eq!(names.len(), 5);
    }

    #[test]
    fn verify_a_model_without_drives_has_no_such_rows() {
        assert!(drawn(&Model::default(), 0.0).is_none());
    }
}
