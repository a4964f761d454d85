//! How to read the page: definitions with their formulas.

use crate::markup::Html;

const ENTRIES: [(&str, &str, &str); 8] = [
    (
        "Gap (nrmse)",
        "gap = rms(measured − predicted) / std(measured)",
        "Of one channel, over the check records. Over several channels: the root of the mean of their squares. 0 is a perfect prediction; 1 is no better than predicting the mean.",
    ),
    (
        "Check records",
        "",
        "Nothing is fitted to them except the state the machine starts from, and the phase of an effect with a clock of its own. They show how far the answer carries.",
    ),
    (
        "Model as given, re-estimated, corrected",
        "",
        "As given: the model file. Re-estimated: its masses, stiffnesses, dampings and gains fitted to the training records, nothing added. Corrected: with the named effects as well.",
    ),
    (
        "Noise floor",
        "",
        "The gap that a perfect model would still show, because the sensors add noise that no model predicts. It is estimated from the records.",
    ),
    (
        "Closed",
        "closed = 1 − √( (corrected² − floor²) / (as given² − floor²) )",
        "How much of the gap above the noise floor is gone. Differences below zero count as zero.",
    ),
    (
        "Probability",
        "",
        "That this effect and not a rival of the catalogue is part of the cause, given these records. It is not the chance of something outside the catalogue.",
    ),
    (
        "Log evidence",
        "",
        "How well a set of effects explains the training records, less a price for every value that is fitted: the logarithm of how likely they are. 5 higher means odds of 150 to 1.",
    ),
    (
        "95 % interval",
        "",
        "The range of values that the records allow. Where a parameter leaves no trace in them, the interval has no end.",
    ),
];

/// The definitions.
pub(super) fn how_to_read(html: &mut Html) {
    html.element("h2", &[], "How to read this page");
    html.within("dl", &[], |html| {
        for (term, formula, text) in ENTRIES {
            html.element("dt", &[], term);
            html.within("dd", &[], |html| {
                if !formula.is_empty() {
                    html.element("code", &[], formula);
                    html.void("br", &[]);
                }
                html.text(text);
            });
        }
    });
}
