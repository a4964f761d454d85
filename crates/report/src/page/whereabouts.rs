//! Where the gap lies: over frequency, time, channels, places and states of motion.

use simgap_diagnose::{Diagnosis, Status, TimeShare};

use super::ReportError;
use super::picture::{Picture, PictureFile};
use super::pictures::Pictured;
use crate::chart::{Bar, BarChart, Role};
use crate::markup::Html;
use crate::number::range;

/// Bars shown of one kind; the rest is summed up in words.
const MOST_BARS: usize = 8;

/// One list of shares, ready to be drawn.
struct Group {
    slug: &'static str,
    title: &'static str,
    note: &'static str,
    axis: &'static str,
    bars: Vec<Bar>,
}

/// The pictures of where the gap lies.
pub(super) fn whereabouts(
    html: &mut Html,
    files: &mut Vec<PictureFile>,
    diagnosis: &Diagnosis,
    pictures: &[Pictured<'_>],
) -> Result<(), ReportError> {
    html.element("h2", &[], "Where the gap of the model as given lies");
    if diagnosis.verdict.status == Status::None {
        let noise =
            "The gap is noise, so this shows where the noise lies, not what the model lacks.";
        html.element("p", &[], noise);
    }
    let groups = groups(diagnosis);
    if groups.iter().all(|g| g.bars.is_empty()) {
        html.element("p", &[], "The discrepancy was not broken down.");
    }
    html.within("div", &[("class", "pair")], |html| {
        if let Some(worst) = pictures.first() {
            let name = worst.name();
            match worst.spectrum(&format!("{name}: spectrum of the discrepancy"))? {
                Some(picture) => {
                    let shaded = match worst.bands().len() {
                        0 => "",
                        _ => "Shaded: the bands that hold most of it. ",
                    };
                    let note = format!("{shaded}A complete model leaves a level line.");
                    picture.with_note(note).show(html, files);
                }
                None => html.element(
                    "p",
                    &[("class", "soft")],
                    "The record is too short or too broken for a spectrum.",
                ),
            }
            if let Some(strip) =
                worst.strip(&format!("{name}: size of the discrepancy over time"))?
            {
                strip.show(html, files);
            }
        }
        for group in groups.into_iter().filter(|g| !g.bars.is_empty()) {
            let (bars, left_out) = largest(group.bars);
            let mut chart = BarChart::shares(group.title, bars);
            chart.axis_label = group.axis.to_owned();
            let more = match left_out {
                0 => String::new(),
                n => format!(" {n} smaller ones are not shown."),
            };
            let note = (group.note.to_owned() + &more).trim().to_owned();
            Picture::bars(group.slug, chart)?
                .with_note(note)
                .show(html, files);
        }
        Ok(())
    })
}

fn groups(diagnosis: &Diagnosis) -> [Group; 6] {
    const SQUARED: &str = "share of the squared discrepancy [%]";
    let at = &diagnosis.r#where;
    let bar = |label: String, share: f64| Bar::share(label, share, Role::Nominal);
    let group = |slug, title, note, axis, bars| Group {
        slug,
        title,
        note,
        axis,
        bars,
    };
    // Of one record the strip above tells more.
    let times: Vec<Bar> = if at.records.len() > 1 {
        let label = |t: &TimeShare| format!("{}, {}", t.record, range(t.from_s, t.to_s, "s"));
        at.times.iter().map(|t| bar(label(t), t.share)).collect()
    } else {
        vec![]
    };
    [
        group(
            "share-places",
            "Share of each place of the model",
            "How much of the discrepancy the best effects at each place explain, by their probability.",
            "share of what is explained [%]",
            at.locations
                .iter()
                .map(|l| bar(l.at.to_string(), l.share))
                .collect(),
        ),
        group(
            "share-channels",
            "Share of each channel",
            "Each channel relative to its own spread.",
            SQUARED,
            at.channels
                .iter()
                .map(|c| bar(c.channel.clone(), c.share))
                .collect(),
        ),
        group(
            "share-bands",
            "Share of each frequency band",
            "",
            SQUARED,
            crate::bands::told(&at.bands)
                .iter()
                .map(|b| bar(b.name(), b.share))
                .collect(),
        ),
        group(
            "share-states",
            "Share of each region of motion",
            "Tick: share of the time spent there. A bar far beyond its tick marks the region.",
            SQUARED,
            at.states
                .iter()
                .map(|s| Bar {
                    mark: Some(s.occupancy),
                    ..bar(s.label.clone(), s.share)
                })
                .collect(),
        ),
        group(
            "share-times",
            "Share of the worst stretches of time",
            "Of all records together, which are cut into twenty stretches each.",
            SQUARED,
            times,
        ),
        group(
            "share-records",
            "Share of each record",
            "",
            SQUARED,
            if at.records.len() > 1 {
                at.records
                    .iter()
                    .map(|r| bar(r.record.clone(), r.share))
                    .collect()
            } else {
                vec![]
            },
        ),
    ]
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
