//! A diagnosis as one self-contained HTML page.
//!
//! The page needs no script and no network: style and pictures are part of it. It reads on a
//! dark and on a light screen, on a narrow one and on paper.

mod answer;
mod guide;
mod pictures;
mod stretch;
mod style;
mod tables;

use simgap_diagnose::{CheckSeries, Diagnosis};
use simgap_model::Location;

use crate::chart::ChartError;
use crate::markup::Html;
use crate::wording::headline;
use pictures::{Pictured, pictured};

/// What a page says about where it comes from.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct ReportContext {
    /// Version of the program.
    pub program_version: String,
    /// File name of the model.
    pub model_file: String,
    /// File names of the records the effects were found on.
    pub train_records: Vec<String>,
    /// File names of the records the gap is measured on; empty if parts of the training records
    /// were held back.
    pub check_records: Vec<String>,
    /// The command that makes the page again.
    pub command_line: String,
}

/// Why a page cannot be made.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReportError {
    /// The lists of a check record do not go together.
    #[error(
        "channel `{channel}` of check record `{record}` has {found} {what} values for {needed} times, equally many are needed"
    )]
    LengthMismatch {
        /// File name of the record.
        record: String,
        /// Output channel.
        channel: String,
        /// `measured`, `nominal` or `corrected`.
        what: &'static str,
        /// Values found.
        found: usize,
        /// Time stamps.
        needed: usize,
    },
    /// A picture failed.
    #[error("the page cannot be drawn: {0}")]
    Chart(#[from] ChartError),
}

/// The page.
///
/// `series` are the check records with their predictions; values that are not finite are left out
/// of the pictures. Without any the page has no pictures of the motion.
///
/// # Errors
///
/// [`ReportError::LengthMismatch`] if a channel of `series` has not one value for each time stamp.
///
/// # Examples
///
/// ```
/// use simgap_diagnose::{Diagnosis, Gap, Remains, Status, Verdict, Where};
/// use simgap_report::page::{ReportContext, report_html};
/// let diagnosis = Diagnosis {
///     schema: "simgap-diagnosis/1",
///     model: "table".into(),
///     gap: Gap {
///         metric: "nrmse",
///         nominal: 0.021,
///         recalibrated: 0.021,
///         corrected: 0.021,
///         noise_floor: 0.020,
///         closed: 0.0,
///         channels: vec![],
///     },
///     r#where: Where {
///         channels: vec![],
///         locations: vec![],
///         bands: vec![],
///         times: vec![],
///         states: vec![],
///         records: vec![],
///     },
///     verdict: Verdict { status: Status::None, effects: vec![], description: vec![] },
///     remainder: Remains::default(),
///     candidates: vec![],
///     next_experiment: None,
///     notes: vec![],
/// };
/// let page = report_html(&diagnosis, &[], &ReportContext::default())?;
/// assert!(page.contains("The gap is measurement noise; nothing to add."));
/// # Ok::<(), simgap_report::page::ReportError>(())
/// ```
pub fn report_html(
    diagnosis: &Diagnosis,
    series: &[CheckSeries],
    context: &ReportContext,
) -> Result<String, ReportError> {
    check_lengths(series)?;
    let pictures = pictured(diagnosis, series);
    let mut html = Html::default();
    html.raw("<!DOCTYPE html>\n");
    html.within("html", &[("lang", "en")], |html| {
        html.within("head", &[], |html| {
            html.void("meta", &[("charset", "utf-8")]);
            let viewport = "width=device-width,initial-scale=1";
            html.void("meta", &[("name", "viewport"), ("content", viewport)]);
            html.void(
                "meta",
                &[("name", "color-scheme"), ("content", "light dark")],
            );
            html.element(
                "title",
                &[],
                &format!("{}: simgap diagnosis", diagnosis.model),
            );
            html.within("style", &[], |html| html.raw(&style::style_sheet()));
        });
        html.within("body", &[], |html| {
            body(html, diagnosis, &pictures, context)
        })
    })?;
    Ok(html.finish())
}

fn body(
    html: &mut Html,
    diagnosis: &Diagnosis,
    pictures: &[Pictured<'_>],
    context: &ReportContext,
) -> Result<(), ReportError> {
    html.within("header", &[], |html| {
        provenance(html, diagnosis, context);
        html.element("h1", &[], &headline(diagnosis));
    });
    html.within("main", &[], |html| {
        let unit_at = |at: &Location| unit_at(pictures, at);
        answer::first_screen(html, diagnosis, pictures, &unit_at)?;
        answer::left_over(html, pictures)?;
        answer::whereabouts(html, diagnosis)?;
        tables::effects(html, diagnosis, &unit_at);
        tables::ambiguity(html, diagnosis);
        tables::candidates(html, diagnosis);
        tables::channels(html, diagnosis);
        answer::further_records(html, pictures)?;
        tables::notes(html, diagnosis);
        guide::how_to_read(html);
        Ok::<(), ReportError>(())
    })?;
    html.within("footer", &[], |html| {
        if !context.command_line.is_empty() {
            html.element("p", &[], "This page was made by");
            html.element("pre", &[], &context.command_line);
        }
        let version = format!(
            "simgap {}. Schema {}.",
            context.program_version, diagnosis.schema
        );
        html.element("p", &[], &version);
    });
    Ok(())
}

fn provenance(html: &mut Html, diagnosis: &Diagnosis, context: &ReportContext) {
    html.within("p", &[("class", "meta")], |html| {
        html.text("simgap diagnosis of ");
        html.element("b", &[], &diagnosis.model);
        if !context.model_file.is_empty() {
            html.text(&format!(" ({})", context.model_file));
        }
        if !context.train_records.is_empty() {
            html.text(&format!(
                " · fitted to {}",
                context.train_records.join(", ")
            ));
        }
        if context.check_records.is_empty() {
            html.text(" · gap measured on held-back parts of the records");
        } else {
            html.text(&format!(
                " · gap measured on {}",
                context.check_records.join(", ")
            ));
        }
    });
}

/// The unit of the channel at that place; empty for places that are no output.
fn unit_at(pictures: &[Pictured<'_>], at: &Location) -> String {
    let Location::Channel(name) = at else {
        return String::new();
    };
    let found = pictures.iter().find(|p| &p.channel.channel == name);
    found.map_or(String::new(), |p| p.channel.unit.to_owned())
}

fn check_lengths(series: &[CheckSeries]) -> Result<(), ReportError> {
    for record in series {
        let needed = record.time_s.len();
        for c in &record.channels {
            let lists = [
                ("measured", &c.measured),
                ("nominal", &c.nominal),
                ("corrected", &c.corrected),
            ];
            if let Some((what, list)) = lists.into_iter().find(|(_, list)| list.len() != needed) {
                return Err(ReportError::LengthMismatch {
                    record: record.record.clone(),
                    channel: c.channel.clone(),
                    what,
                    found: list.len(),
                    needed,
                });
            }
        }
    }
    Ok(())
}
