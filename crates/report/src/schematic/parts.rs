//! Boxes with names, and what is written beside them.

use simgap_model::Model;

use crate::chart::NEUTRAL_COLOURS;
use crate::markup::escape;

/// Distances between columns and rows, and the size of a node, pixels.
pub(super) const COLUMN: f64 = 190.0;
pub(super) const ROW: f64 = 130.0;
pub(super) const BOX: [f64; 2] = [88.0, 52.0];
/// The first column and the first row.
pub(super) const FIRST: [f64; 2] = [90.0, 80.0];
pub(super) fn label(at: [f64; 2], text: &str) -> String {
    anchored(at, "middle", text)
}

/// A text that starts, ends or has its middle at a place.
pub(super) fn anchored([x, y]: [f64; 2], anchor: &str, text: &str) -> String {
    format!(
        "<text x=\"{x}\" y=\"{y}\" text-anchor=\"{anchor}\" stroke=\"none\" fill=\"{}\">{}</text>",
        NEUTRAL_COLOURS[0].light,
        escape(text)
    )
}

/// An arrow from one place to another.
pub(super) fn arrow(a: [f64; 2], b: [f64; 2]) -> String {
    let [dx, dy] = [b[0] - a[0], b[1] - a[1]];
    let length = dx.hypot(dy).max(1.0);
    let (u, n) = ([dx / length, dy / length], [-dy / length, dx / length]);
    let barb = |side: f64| {
        let at = |k: usize| b[k] - 7.0 * u[k] + side * 4.0 * n[k];
        format!("{:.1} {:.1}", at(0), at(1))
    };
    format!(
        "<path d=\"M{:.1} {:.1}L{:.1} {:.1}M{}L{:.1} {:.1}L{}\"/>",
        a[0],
        a[1],
        b[0],
        b[1],
        barb(1.0),
        b[0],
        b[1],
        barb(-1.0)
    )
}

/// A box with a name.
pub(super) fn boxed(name: &str, [x, y]: [f64; 2], [w, h]: [f64; 2], is_base: bool) -> String {
    let dashes = if is_base {
        " stroke-dasharray=\"5 3\""
    } else {
        ""
    };
    format!(
        "<rect x=\"{}\" y=\"{}\" width=\"{w}\" height=\"{h}\" rx=\"3\" fill=\"{}\"{dashes}/>{}",
        x - w / 2.0,
        y - h / 2.0,
        if is_base { "#FFFFFF" } else { "#EAEEF2" },
        label([x, y + 4.0], name)
    )
}

/// What drives the part of a name, above its box.
pub(super) fn driven(model: &Model, name: &str, [x, y]: [f64; 2], [w, h]: [f64; 2]) -> String {
    let mut text = String::new();
    let drives = model.inputs.iter().filter(|input| input.at == name);
    for (k, input) in drives.enumerate() {
        let above = y - h / 2.0 - 10.0 - 15.0 * k as f64;
        let kind = input.kind.name().replace('_', " ");
        text.push_str(&format!(
            "<path d=\"M{} {above}h24m-6 -4l6 4l-6 4\"/>",
            x - w / 2.0
        ));
        let words = format!("{} ({kind})", input.channel);
        text.push_str(&format!(
            "<text x=\"{}\" y=\"{}\" stroke=\"none\" fill=\"{}\">{}</text>",
            x - w / 2.0 + 30.0,
            above + 4.0,
            NEUTRAL_COLOURS[0].light,
            escape(&words)
        ));
    }
    text
}

/// The channels that measure at a name.
pub(super) fn measured_at(model: &Model, name: &str) -> Vec<String> {
    let measured = model.outputs.iter().filter(|output| match &output.between {
        Some([a, _]) => a == name,
        None => output.at.as_deref() == Some(name),
    });
    let lines = measured.map(|output| format!("measured: {}", output.channel));
    lines.collect()
}

/// Lines below a box.
pub(super) fn lines_below([x, y]: [f64; 2], lines: &[String]) -> String {
    let places = lines.iter().enumerate().map(|(k, line)| {
        let below = y + BOX[1] / 2.0 + 15.0 + 14.0 * k as f64;
        label([x, below], line)
    });
    places.collect()
}
