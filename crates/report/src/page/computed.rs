//! How the page was computed, so that it can be computed again.

use super::ReportInput;
use crate::markup::Html;

/// Version, files, seed and command.
pub(super) fn computed(html: &mut Html, input: &ReportInput<'_>) {
    let context = input.context;
    html.element("h2", &[], "How this was computed");
    let check = if context.check_records.is_empty() {
        "parts of these, held back".to_owned()
    } else {
        context.check_records.join(", ")
    };
    let rows = [
        ("Program", format!("simgap {}", context.program_version)),
        ("Model", context.model_file.clone()),
        ("Fitted to", context.train_records.join(", ")),
        ("Judged by", check),
        (
            "Seed",
            format!(
                "{}; nothing in a diagnosis is drawn at random",
                context.seed
            ),
        ),
        ("Schema", input.diagnosis.schema.to_owned()),
    ];
    html.within("dl", &[("class", "facts")], |html| {
        for (name, value) in rows.iter().filter(|(_, value)| !value.is_empty()) {
            html.element("dt", &[], name);
            html.element("dd", &[], value);
        }
    });
    if !context.command_line.is_empty() {
        html.element("p", &[], "In the folder of these files:");
        html.element("pre", &[], &context.command_line);
    }
    html.element(
        "p",
        &[("class", "soft")],
        "The same files and the same program give this page again, byte for byte. Beside it lie the predictions, the corrected model and, in the folder pictures, every picture as SVG with its data as CSV.",
    );
}
