//! The first screen, what is left over, and where it lies.

use simgap_diagnose::{Diagnosis, Status};
use simgap_model::Location;

use super::ReportError;
use super::pictures::Pictured;
use crate::chart::{Bar, BarChart, Role};
use crate::markup::Html;
use crate::number::{percent, range, ratio};
use crate::wording::{particulars, place, sentence};

/// Bars shown of one kind; the rest is summed up in words.
const MOST_BARS: usize = 8;
/// Further charts of records shown; a page stays small.
const MOST_RECORDS: usize = 24;

/// Verdict, figures, and the telling stretch.
pub(super) fn first_screen(
    html: &mut Html,
    diagnosis: &Diagnosis,
    pictures: &[Pictured<'_>],
    unit_at: &dyn Fn(&Location) -> String,
) -> Result<(), ReportError> {
    for line in particulars(diagnosis, unit_at) {
        html.element("p", &[("class", "lead")], &line);
    }
    tiles(html, diagnosis);
    let Some(worst) = pictures.first() else {
        html.element(
            "p",
            &[("class", "soft")],
            "There is no check record to show.",
        );
        return Ok(());
    };
    html.within("div", &[("class", "pair")], |html| {
        let zoom = worst.worst_s();
        let name = worst.name();
        if zoom.is_some() {
            let title = format!("{name}, where the model is worst");
            picture(html, &worst.motion(&title, zoom)?);
        }
        picture(html, &worst.motion(&format!("{name}, whole record"), None)?);
        Ok(())
    })
}

fn tiles(html: &mut Html, diagnosis: &Diagnosis) {
    let gap = &diagnosis.gap;
    let effects = &diagnosis.verdict.effects;
    let last = match diagnosis.verdict.status {
        Status::Effect => "with the named effects",
        _ => "final model",
    };
    html.within("div", &[("class", "tiles")], |html| {
        html.within("div", &[("class", "tile")], |html| {
            html.element("div", &[("class", "name")], "Gap between model and machine");
            html.within("div", &[("class", "figure steps")], |html| {
                let mut steps = vec![
                    (gap.nominal, "model as given"),
                    (gap.recalibrated, "re-estimated"),
                    (gap.corrected, last),
                ];
                // With nothing named the final model is the re-estimated one.
                if effects.is_empty() && ratio(gap.corrected) == ratio(gap.recalibrated) {
                    steps.pop();
                }
                for (i, (value, name)) in steps.into_iter().enumerate() {
                    if i > 0 {
                        html.element("span", &[("class", "arrow")], "→");
                    }
                    html.within("span", &[], |html| {
                        html.text(&ratio(value));
                        html.element("small", &[], name);
                    });
                }
            });
            let note = "rms of measured minus predicted, relative to the spread of the signal";
            html.element("div", &[("class", "note")], note);
        });
        tile(
            html,
            "Noise floor",
            &ratio(gap.noise_floor),
            "what the noise of the sensors alone would leave",
        );
        let (closed, note) = match diagnosis.verdict.status {
            Status::None => ("–".to_owned(), "there is nothing above the noise to close"),
            _ => (percent(gap.closed), "of the gap above the noise floor"),
        };
        tile(html, "Closed", &closed, note);
    });
}

fn tile(html: &mut Html, name: &str, figure: &str, note: &str) {
    html.within("div", &[("class", "tile")], |html| {
        html.element("div", &[("class", "name")], name);
        html.element("div", &[("class", "figure")], figure);
        html.element("div", &[("class", "note")], note);
    });
}

fn picture(html: &mut Html, svg: &str) {
    html.within("figure", &[], |html| html.raw(svg));
}

/// Discrepancy before and after, over time and over frequency.
pub(super) fn left_over(html: &mut Html, pictures: &[Pictured<'_>]) -> Result<(), ReportError> {
    let Some(worst) = pictures.first() else {
        return Ok(());
    };
    html.element("h2", &[], "What is left over");
    html.element(
        "p",
        &[],
        "Measured minus predicted, before and after. A complete model leaves only noise: no shape over time, a level spectrum.",
    );
    html.within("div", &[("class", "pair")], |html| {
        let name = worst.name();
        picture(html, &worst.left_over(&format!("Discrepancy of {name}"))?);
        match worst.spectrum(&format!("Its spectrum, {name}"))? {
            Some(svg) => picture(html, &svg),
            None => html.element(
                "p",
                &[("class", "soft")],
                "The record is too short or too broken for a spectrum.",
            ),
        }
        Ok(())
    })
}

/// Shares over channels, places, bands, times, states and records.
pub(super) fn whereabouts(html: &mut Html, diagnosis: &Diagnosis) -> Result<(), ReportError> {
    html.element("h2", &[], "Where the gap of the model as given lies");
    let at = &diagnosis.r#where;
    let bar = |label: String, share: f64| Bar::share(label, share, Role::Nominal);
    let states = at.states.iter().map(|s| Bar {
        mark: Some(s.occupancy),
        ..bar(s.label.clone(), s.share)
    });
    let groups: [(&str, &str, Vec<Bar>); 6] = [
        (
            "Places of the model",
            "How much of the discrepancy the best effect at each place explains, relative to the other places.",
            at.locations
                .iter()
                .map(|l| bar(l.at.to_string(), l.share))
                .collect(),
        ),
        (
            "Channels",
            "Share of the squared discrepancy, each channel relative to its own spread.",
            at.channels
                .iter()
                .map(|c| bar(c.channel.clone(), c.share))
                .collect(),
        ),
        (
            "Frequencies",
            "Share of the squared discrepancy.",
            at.bands
                .iter()
                .map(|b| bar(band_label(b.from_hz, b.to_hz, &b.label), b.share))
                .collect(),
        ),
        (
            "Regions of motion",
            "Share of the squared discrepancy; the tick is the share of the time spent there. A bar far beyond its tick marks the region.",
            states.collect(),
        ),
        (
            "Times",
            "Share of the squared discrepancy of all records.",
            at.times
                .iter()
                .map(|t| bar(time_label(&t.record, t.from_s, t.to_s), t.share))
                .collect(),
        ),
        (
            "Records",
            "Share of the squared discrepancy.",
            at.records
                .iter()
                .map(|r| bar(r.record.clone(), r.share))
                .collect(),
        ),
    ];
    if groups.iter().all(|(_, _, bars)| bars.is_empty()) {
        html.element("p", &[], "The discrepancy was not broken down.");
        return Ok(());
    }
    html.within("div", &[("class", "pair")], |html| {
        for (title, caption, bars) in groups {
            if bars.is_empty() {
                continue;
            }
            let (bars, left_out) = largest(bars);
            let mut chart = BarChart::shares(title, bars);
            chart.width_px = super::pictures::SIZE.width_px;
            let svg = chart.to_svg()?;
            html.within("figure", &[], |html| {
                html.raw(&svg);
                let more = match left_out {
                    0 => String::new(),
                    n => format!(" {n} smaller ones are not shown."),
                };
                html.element("figcaption", &[], &(caption.to_owned() + &more));
            });
        }
        Ok(())
    })
}

/// The largest bars in the order they came, and how many were dropped.
fn largest(bars: Vec<Bar>) -> (Vec<Bar>, usize) {
    let left_out = bars.len().saturating_sub(MOST_BARS);
    let mut order: Vec<usize> = (0..bars.len()).collect();
    order.sort_by(|&a, &b| bars[b].value.total_cmp(&bars[a].value));
    order.truncate(MOST_BARS);
    order.sort_unstable();
    (
        order.into_iter().map(|i| bars[i].clone()).collect(),
        left_out,
    )
}

fn band_label(from_hz: f64, to_hz: f64, label: &str) -> String {
    let range = range(from_hz, to_hz, "Hz");
    if label.is_empty() {
        range
    } else {
        format!("{label} ({range})")
    }
}

fn time_label(record: &str, from_s: f64, to_s: f64) -> String {
    format!("{record}, {}", range(from_s, to_s, "s"))
}

/// Every other channel and record, folded away.
pub(super) fn further_records(
    html: &mut Html,
    pictures: &[Pictured<'_>],
) -> Result<(), ReportError> {
    let further = pictures.get(1..).unwrap_or_default();
    if further.is_empty() {
        return Ok(());
    }
    html.element("h2", &[], "The other channels and check records");
    html.within("details", &[], |html| {
        let title = match further.len().min(MOST_RECORDS) {
            1 => "Show the other one".to_owned(),
            n => format!("Show the other {n}"),
        };
        html.element("summary", &[], &title);
        html.within("div", &[("class", "pair")], |html| {
            for one in further.iter().take(MOST_RECORDS) {
                let zoom = one.worst_s();
                let part = if zoom.is_some() {
                    "where the model is worst"
                } else {
                    "whole record"
                };
                picture(html, &one.motion(&format!("{}, {part}", one.name()), zoom)?);
            }
            Ok::<(), ReportError>(())
        })?;
        if further.len() > MOST_RECORDS {
            let rest = format!(
                "{} more are not shown; all are in the predictions.",
                further.len() - MOST_RECORDS
            );
            html.element("p", &[], &rest);
        }
        Ok(())
    })
}

/// "on mass m" with a capital, for the head of a block.
pub(super) fn place_sentence(name: &str, at: &Location) -> String {
    let text = sentence(&format!("{} {}", crate::wording::kind(name), place(at)));
    text.trim_end_matches('.').to_owned()
}
