//! The picture of a model that stands for a simulator: a box, its signals and its ports.

use simgap_model::Model;

use super::parts::{anchored, arrow, boxed, label};

/// Size of the box but for its height, and the least height.
const WIDTH: f64 = 220.0;
const LEAST_HEIGHT: f64 = 60.0;
const LEFT: f64 = 130.0;
const TOP: f64 = 30.0;
/// Height of a signal, and length of its arrow.
const ROW: f64 = 24.0;
const ARROW: f64 = 40.0;

/// The body of the picture and its lower right corner; `None` for a model of members and masses.
pub(super) fn drawn(model: &Model) -> Option<(String, [f64; 2])> {
    if !model.is_external() {
        return None;
    }
    let rows = model.inputs.len().max(model.outputs.len()) as f64;
    let height = LEAST_HEIGHT.max(rows * ROW + 12.0);
    let (right, below) = (LEFT + WIDTH, TOP + height);
    let middle = [LEFT + WIDTH / 2.0, TOP + height / 2.0];
    let mut body = boxed(&model.name, middle, [WIDTH, height], false);
    // The k-th of some signals on a side.
    let at = |k: usize, count: usize| TOP + (k as f64 + 0.5) * height / count as f64;
    for (k, input) in model.inputs.iter().enumerate() {
        let y = at(k, model.inputs.len());
        body.push_str(&arrow([LEFT - ARROW, y], [LEFT, y]));
        let beside = [LEFT - ARROW - 6.0, y + 4.0];
        body.push_str(&anchored(beside, "end", &input.channel));
    }
    for (k, output) in model.outputs.iter().enumerate() {
        let y = at(k, model.outputs.len());
        body.push_str(&arrow([right, y], [right + ARROW, y]));
        let beside = [right + ARROW + 6.0, y + 4.0];
        body.push_str(&anchored(beside, "start", &output.channel));
    }
    for (k, port) in model.ports.iter().enumerate() {
        let x = LEFT + (k as f64 + 0.5) * WIDTH / model.ports.len() as f64;
        body.push_str(&arrow([x, below + ARROW], [x, below]));
        let words = format!("force at {}", port.name);
        body.push_str(&label([x, below + ARROW + 16.0], &words));
    }
    let bottom = below
        + if model.ports.is_empty() {
            TOP
        } else {
            ARROW + TOP
        };
    Some((body, [right + LEFT + 20.0, bottom]))
}
