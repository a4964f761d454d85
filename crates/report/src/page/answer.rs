//! The first screen, and measured against predicted.

use simgap_diagnose::{Diagnosis, Status};
use simgap_model::Location;

use super::ReportError;
use super::picture::{Picture, PictureFile};
use super::pictures::Pictured;
use crate::chart::{Bar, BarChart, Role};
use crate::markup::Html;
use crate::number::{percent, ratio};
use crate::wording::{particulars, place, sentence};

/// Further charts of records shown; a page stays small.
const MOST_RECORDS: usize = 24;

/// What the headline leaves out, and how the gap shrinks.
pub(super) fn first_screen(
    html: &mut Html,
    files: &mut Vec<PictureFile>,
    diagnosis: &Diagnosis,
) -> Result<(), ReportError> {
    let waterfall = waterfall(diagnosis)?;
    html.within("div", &[("class", "pair first stack")], |html| {
        html.within("div", &[], |html| {
            for line in particulars(diagnosis) {
                html.element("p", &[("class", "lead")], &line);
            }
            figures(html, diagnosis);
        });
        waterfall.show(html, files);
    });
    Ok(())
}

fn figures(html: &mut Html, diagnosis: &Diagnosis) {
    let gap = &diagnosis.gap;
    let mut tiles = vec![("Gap of the model as given", ratio(gap.nominal))];
    if diagnosis.verdict.status == Status::None {
        tiles.push(("Gap that the noise alone leaves", ratio(gap.noise_floor)));
    } else {
        tiles.push(("Gap of the final model", ratio(gap.corrected)));
        tiles.push(("Closed above the noise", percent(gap.closed)));
    }
    html.within("div", &[("class", "tiles")], |html| {
        for (name, figure) in tiles {
            html.within("div", &[("class", "tile")], |html| {
                html.element("div", &[("class", "figure")], &figure);
                html.element("div", &[("class", "name")], name);
            });
        }
    });
}

/// From the model as given over the re-estimated and the corrected one to the noise.
fn waterfall(diagnosis: &Diagnosis) -> Result<Picture, ReportError> {
    let gap = &diagnosis.gap;
    let named = diagnosis.verdict.status == Status::Effect;
    let mut steps = vec![
        ("model as given", gap.nominal, Role::Nominal),
        ("re-estimated", gap.recalibrated, Role::Recalibrated),
    ];
    // With no effect named the final model is the re-estimated one, or the model as given.
    let kept = diagnosis.verdict.status == Status::None;
    if named || !kept && ratio(gap.corrected) != ratio(gap.recalibrated) {
        let label = if named {
            "with named effects"
        } else {
            "final model"
        };
        steps.push((label, gap.corrected, Role::Corrected));
    }
    steps.push(("noise floor", gap.noise_floor, Role::Reference));
    let mut before = None;
    let bars = steps
        .into_iter()
        .map(|(label, value, role)| {
            let bar = Bar {
                text: ratio(value),
                before,
                ..Bar::share(label, value, role)
            };
            before = Some(value);
            bar
        })
        .collect();
    let mut chart = BarChart::shares(
        "How the gap shrinks on data that nothing was fitted to",
        bars,
    );
    let largest = [
        gap.nominal,
        gap.recalibrated,
        gap.corrected,
        gap.noise_floor,
    ];
    let largest = largest.into_iter().filter(|v| v.is_finite());
    chart.full = Some(largest.fold(0.0, f64::max)).filter(|full| *full > 0.0);
    chart.percent = false;
    chart.limit = Some(gap.noise_floor);
    chart.axis_label = "gap: rms of the discrepancy over spread of the signal [1]".to_owned();
    let note = "Hollow: what each step takes away. Dashed: what the noise of the sensors alone would leave.";
    Ok(Picture::bars("gap", chart)?.with_note(note))
}

/// Measured, as given and corrected over time.
pub(super) fn motion(
    html: &mut Html,
    files: &mut Vec<PictureFile>,
    pictures: &[Pictured<'_>],
) -> Result<(), ReportError> {
    html.element("h2", &[], "Measured and predicted");
    let Some(worst) = pictures.first() else {
        let none = "There is no check record to show.";
        html.element("p", &[("class", "soft")], none);
        return Ok(());
    };
    let name = worst.name();
    let zoom = worst.worst_s();
    html.within("div", &[("class", "pair")], |html| {
        let whole = worst.motion(&format!("{name}: measured and predicted"), None)?;
        let hint = "Drag across a stretch to enlarge it, double-click to see all of it again.";
        whole.with_hint(hint).wide().show(html, files);
        if zoom.is_some() {
            let title = format!("{name}: where the model as given is worst");
            worst.motion(&title, zoom)?.show(html, files);
        }
        let title = format!("{name}: what each model leaves unexplained");
        worst
            .left_over(&title)?
            .with_note("A complete model leaves nothing but noise.")
            .show(html, files);
        Ok::<(), ReportError>(())
    })?;
    further_records(html, files, pictures)
}

/// Every other channel and record, folded away.
fn further_records(
    html: &mut Html,
    files: &mut Vec<PictureFile>,
    pictures: &[Pictured<'_>],
) -> Result<(), ReportError> {
    let further = pictures.get(1..).unwrap_or_default();
    if further.is_empty() {
        return Ok(());
    }
    html.within("details", &[], |html| {
        let title = match further.len().min(MOST_RECORDS) {
            1 => "The other channel or check record".to_owned(),
            n => format!("The other {n} channels and check records"),
        };
        html.element("summary", &[], &title);
        html.within("div", &[("class", "pair")], |html| {
            for one in further.iter().take(MOST_RECORDS) {
                let zoom = one.worst_s();
                let part = if zoom.is_some() {
                    "where the model as given is worst"
                } else {
                    "measured and predicted"
                };
                let title = format!("{}: {part}", one.name());
                one.motion(&title, zoom)?.show(html, files);
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
