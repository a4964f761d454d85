//! The picture of a model that stands for a simulator: a box, its signals and its ports.

use simgap_model::{Model, OutputKind};

use crate::chart::NEUTRAL_COLOURS;
use crate::markup::escape;

const BOX: [f64; 2] = [220.0, 60.0];
const LEFT: f64 = 130.0;
const TOP: f64 = 30.0;
const ROW: f64 = 24.0;

/// The body of the picture and its size; `None` for a model of members and masses.
pub(super) fn drawn(model: &Model) -> Option<(String, [f64; 2])> {
    let is_signal = |kind: OutputKind| kind == OutputKind::Signal;
    if !model.outputs.iter().any(|output| is_signal(output.kind)) {
        return None;
    }
    let inputs: Vec<&str> = model.inputs.iter().map(|i| i.channel.as_str()).collect();
    let outputs: Vec<&str> = model.outputs.iter().map(|o| o.channel.as_str()).collect();
    let ports: Vec<&str> = model.ports.iter().map(|port| port.name.as_str()).collect();
    let rows = inputs.len().max(outputs.len()).max(2) as f64;
    let height = BOX[1].max(rows * ROW + 12.0);
    let (right, below) = (LEFT + BOX[0], TOP + height);
    let mut body = format!(
        "<rect x=\"{LEFT}\" y=\"{TOP}\" width=\"{}\" height=\"{height}\" rx=\"4\"/>{}",
        BOX[0],
        label(
            LEFT + BOX[0] / 2.0,
            TOP + height / 2.0 + 4.0,
            "middle",
            &model.name
        )
    );
    let mut signals = |names: &[&str], from: f64, text_at: f64, anchor: &str| {
        for (k, name) in names.iter().enumerate() {
            let y = TOP + (k as f64 + 0.5) * height / names.len() as f64;
            body.push_str(&arrow([from, y], [from + 40.0, y]));
            body.push_str(&label(text_at, y + 4.0, anchor, name));
        }
    };
    signals(&inputs, LEFT - 40.0, LEFT - 46.0, "end");
    signals(&outputs, right, right + 46.0, "start");
    for (k, name) in ports.iter().enumerate() {
        let x = LEFT + (k as f64 + 0.5) * BOX[0] / ports.len() as f64;
        body.push_str(&arrow([x, below + 34.0], [x, below]));
        body.push_str(&label(
            x,
            below + 50.0,
            "middle",
            &format!("force at {name}"),
        ));
    }
    let bottom = below + if ports.is_empty() { 30.0 } else { 70.0 };
    Some((body, [right + 150.0, bottom]))
}

fn arrow([x, y]: [f64; 2], to: [f64; 2]) -> String {
    let along = [to[0] - x, to[1] - y];
    let length = along[0].hypot(along[1]);
    let [u, v] = along.map(|part| 6.0 * part / length);
    let barb = |side: f64| {
        format!(
            "M{} {}L{} {}",
            to[0],
            to[1],
            to[0] - u - side * 0.5 * v,
            to[1] - v + side * 0.5 * u
        )
    };
    format!(
        "<path d=\"M{x} {y}L{} {}{}{}\"/>",
        to[0],
        to[1],
        barb(1.0),
        barb(-1.0)
    )
}

fn label(x: f64, y: f64, anchor: &str, text: &str) -> String {
    format!(
        "<text x=\"{x}\" y=\"{y}\" text-anchor=\"{anchor}\" fill=\"{}\" stroke=\"none\">{}</text>",
        NEUTRAL_COLOURS[0].light,
        escape(text)
    )
}
