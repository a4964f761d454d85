//! Named effects, what cannot be told apart, candidates, channels, notes.

use simgap_diagnose::{CandidateResult, Diagnosis, NamedEffect, Status};
use simgap_model::Location;

use super::answer::place_sentence;
use crate::markup::Html;
use crate::number::{percent, ratio};
use crate::unit::estimate;
use crate::wording::{kind, place, sentence};

/// Candidates shown at once; the rest is folded away.
const FIRST_CANDIDATES: usize = 10;

/// A table with its head; columns from `numbers_from` on are numbers.
fn table(html: &mut Html, head: &[&str], numbers_from: usize, rows: &[(bool, Vec<String>)]) {
    let class = |column: usize| -> &[(&str, &str)] {
        if column >= numbers_from {
            &[("class", "n")]
        } else {
            &[]
        }
    };
    html.within("div", &[("class", "scroll")], |html| {
        html.within("table", &[], |html| {
            html.within("thead", &[], |html| {
                html.within("tr", &[], |html| {
                    for (i, name) in head.iter().enumerate() {
                        html.element("th", class(i), name);
                    }
                });
            });
            html.within("tbody", &[], |html| {
                for (marked, cells) in rows {
                    let attributes: &[(&str, &str)] =
                        if *marked { &[("class", "named")] } else { &[] };
                    html.within("tr", attributes, |html| {
                        for (i, cell) in cells.iter().enumerate() {
                            html.element("td", class(i), cell);
                        }
                    });
                }
            });
        });
    });
}

fn list(html: &mut Html, lines: &[String]) {
    html.within("ul", &[], |html| {
        for line in lines {
            html.element("li", &[], &sentence(line));
        }
    });
}

/// Each named effect with its parameters and the evidence for it.
pub(super) fn effects(
    html: &mut Html,
    diagnosis: &Diagnosis,
    unit_at: &dyn Fn(&Location) -> String,
) {
    let verdict = &diagnosis.verdict;
    if verdict.effects.is_empty() {
        return;
    }
    let title = match verdict.status {
        Status::Parameters => "What is off in the model",
        Status::Effect => "What is missing in the model",
        Status::None | Status::Unknown => "What came nearest",
    };
    html.element("h2", &[], title);
    for effect in &verdict.effects {
        let head = format!(
            "{}, probability {}",
            place_sentence(&effect.kind, &effect.at),
            percent(effect.probability)
        );
        html.element("h3", &[], &head);
        parameters(html, effect, &unit_at(&effect.at));
        if !effect.evidence.is_empty() {
            html.element("p", &[], "Why it is named:");
            list(html, &effect.evidence);
        }
    }
}

fn parameters(html: &mut Html, effect: &NamedEffect, unit: &str) {
    if effect.parameters.is_empty() {
        return;
    }
    let rows: Vec<(bool, Vec<String>)> = effect
        .parameters
        .iter()
        .map(|p| {
            let e = estimate(p, unit);
            (false, vec![e.words, p.name.clone(), e.value, e.interval])
        })
        .collect();
    let head = [
        "Parameter",
        "Name in the model file",
        "Estimate",
        "95 % interval",
    ];
    table(html, &head, 2, &rows);
}

/// What the data cannot tell apart, and the experiment that would.
pub(super) fn ambiguity(html: &mut Html, diagnosis: &Diagnosis) {
    let effects = &diagnosis.verdict.effects;
    let ambiguous = effects.iter().any(|e| !e.indistinguishable.is_empty());
    if effects.is_empty() && diagnosis.next_experiment.is_none() {
        return;
    }
    let title = if effects.is_empty() {
        "What to measure next"
    } else {
        "What these data cannot tell apart"
    };
    html.element("h2", &[], title);
    if !ambiguous && !effects.is_empty() {
        html.element(
            "p",
            &[],
            "Nothing: no other effect of the catalogue explains the records as well.",
        );
    }
    for effect in effects.iter().filter(|e| !e.indistinguishable.is_empty()) {
        let head = format!(
            "In place of {} {} it could also be:",
            kind(&effect.kind),
            place(&effect.at)
        );
        html.element("p", &[], &head);
        let rivals: Vec<String> = effect
            .indistinguishable
            .iter()
            .map(|r| format!("{} {}: {}", kind(&r.kind), place(&r.at), r.because))
            .collect();
        list(html, &rivals);
    }
    if let Some(experiment) = &diagnosis.next_experiment {
        html.within("div", &[("class", "box")], |html| {
            html.within("p", &[], |html| html.element("b", &[], "Next experiment"));
            html.element("p", &[], &sentence(experiment));
        });
    }
}

/// Every single effect that was tried, best first.
pub(super) fn candidates(html: &mut Html, diagnosis: &Diagnosis) {
    if diagnosis.candidates.is_empty() {
        return;
    }
    html.element("h2", &[], "What was tried");
    html.element(
        "p",
        &[],
        "Each effect alone, added to the re-estimated model. The gap is on the check records, which nothing was fitted to. Named effects are bold.",
    );
    let row = |c: &CandidateResult| {
        let named = diagnosis
            .verdict
            .effects
            .iter()
            .any(|e| e.kind == c.kind && e.at == c.at);
        let text = sentence(&kind(&c.kind)).trim_end_matches('.').to_owned();
        (
            named,
            vec![
                text,
                place(&c.at),
                ratio(c.held_back_gap),
                percent(c.probability),
            ],
        )
    };
    let rows: Vec<(bool, Vec<String>)> = diagnosis.candidates.iter().map(row).collect();
    let head = ["Effect", "Where", "Gap", "Probability"];
    let (first, rest) = rows.split_at(rows.len().min(FIRST_CANDIDATES));
    table(html, &head, 2, first);
    if !rest.is_empty() {
        html.within("details", &[], |html| {
            html.element("summary", &[], &format!("{} more", rest.len()));
            table(html, &head, 2, rest);
        });
    }
}

/// The gap channel by channel.
pub(super) fn channels(html: &mut Html, diagnosis: &Diagnosis) {
    if diagnosis.gap.channels.is_empty() {
        return;
    }
    html.element("h2", &[], "The gap channel by channel");
    let rows: Vec<(bool, Vec<String>)> = diagnosis
        .gap
        .channels
        .iter()
        .map(|c| {
            let figures = [c.nominal, c.recalibrated, c.corrected, c.noise_floor].map(ratio);
            (
                false,
                [c.channel.clone()].into_iter().chain(figures).collect(),
            )
        })
        .collect();
    let head = [
        "Channel",
        "As given",
        "Re-estimated",
        "Corrected",
        "Noise floor",
    ];
    table(html, &head, 1, &rows);
}

/// What a reader must know about the data.
pub(super) fn notes(html: &mut Html, diagnosis: &Diagnosis) {
    if diagnosis.notes.is_empty() {
        return;
    }
    html.element("h2", &[], "Notes on the data");
    list(html, &diagnosis.notes);
}
