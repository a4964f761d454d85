//! Tables and lists, and the short sections made of them.

use simgap_diagnose::{Diagnosis, Status};

use crate::markup::Html;
use crate::number::ratio;
use crate::wording::{plain, sentence};

/// A table with its head; columns from `numbers_from` on are numbers.
pub(super) fn table(
    html: &mut Html,
    head: &[&str],
    numbers_from: usize,
    rows: &[(bool, Vec<String>)],
) {
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
                            // On a phone the head is folded away and each cell says its own.
                            let name = if i > 0 { head.get(i) } else { None };
                            let name = name.map(|name| ("data-name", *name));
                            let all: Vec<_> = class(i).iter().copied().chain(name).collect();
                            html.element("td", &all, cell);
                        }
                    });
                }
            });
        });
    });
}

pub(super) fn list(html: &mut Html, lines: &[String]) {
    html.within("ul", &[], |html| {
        for line in lines {
            html.element("li", &[], &sentence(line));
        }
    });
}

/// The gap channel by channel.
pub(super) fn channels(html: &mut Html, diagnosis: &Diagnosis) {
    if diagnosis.gap.channels.is_empty() {
        return;
    }
    html.element("h3", &[], "The gap channel by channel");
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
    let last = match diagnosis.verdict.status {
        Status::Effect => "Corrected",
        Status::None | Status::Parameters | Status::Unknown => "Final model",
    };
    let head = ["Channel", "As given", "Re-estimated", last, "Noise floor"];
    table(html, &head, 1, &rows);
}

/// What a reader must know about the records.
pub(super) fn quality(html: &mut Html, diagnosis: &Diagnosis) {
    html.element("h2", &[], "Quality of the records");
    if diagnosis.notes.is_empty() {
        let clean = "The checks of the records found nothing worth a note.";
        html.element("p", &[], clean);
    } else {
        let notes: Vec<String> = diagnosis.notes.iter().map(|n| plain(n)).collect();
        list(html, &notes);
    }
}

/// What to measure next.
pub(super) fn next_experiment(html: &mut Html, diagnosis: &Diagnosis) {
    html.element("h2", &[], "Next experiment");
    match &diagnosis.next_experiment {
        Some(experiment) => html.within("div", &[("class", "box")], |html| {
            html.element("p", &[], &sentence(&plain(experiment)));
        }),
        None => html.element(
            "p",
            &[],
            "None is needed to decide between rivals. A record of other motion than these, kept as a check record, shows how far the answer carries.",
        ),
    }
}
