//! A diagnosis as one self-contained HTML page.
//!
//! The page needs no network: style, pictures and scripts are part of it. It reads on a dark and on
//! a light screen, on a narrow one, on paper, and without its scripts, which only add zoom and a
//! cursor to the drawings.

mod answer;
mod computed;
mod error;
mod force;
mod frame;
mod guide;
mod input;
mod picture;
mod pictures;
mod script;
mod sense;
mod stretch;
mod style;
mod tables;
mod values;
mod whereabouts;
mod which;

use simgap_diagnose::{CheckSeries, Diagnosis};

use crate::markup::Html;
use crate::wording::headline;
pub use error::ReportError;
pub use frame::{page_of, table_of};
pub use input::{ReportContext, ReportInput};
pub use picture::PictureFile;
use pictures::{Pictured, pictured};

/// A page, and its pictures as files of their own.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Report {
    /// The page.
    pub html: String,
    /// Its pictures, in the order of the page.
    pub pictures: Vec<PictureFile>,
}

/// The page and its pictures.
///
/// Values that are not finite are left out of the pictures. Without check records the page has no
/// pictures of the motion, without models no table of their parameters.
///
/// # Errors
///
/// [`ReportError::LengthMismatch`] if a channel of `series` has not one value for each time stamp.
pub fn report(input: &ReportInput<'_>) -> Result<Report, ReportError> {
    check_lengths(input.series)?;
    let shown = pictured(input);
    let mut html = Html::default();
    let mut pictures = Vec::new();
    html.raw("<!DOCTYPE html>\n");
    html.within("html", &[("lang", "en")], |html| {
        html.within("head", &[], |html| head(html, &input.diagnosis.model));
        html.within("body", &[], |html| {
            body(html, &mut pictures, input, &shown)?;
            script::write(html);
            Ok::<(), ReportError>(())
        })
    })?;
    Ok(Report {
        html: html.finish(),
        pictures,
    })
}

/// The page alone, of a diagnosis and its check records: [`report`] without models.
///
/// # Errors
///
/// As [`report`].
///
/// # Examples
///
/// ```
/// use simgap_diagnose::{Diagnosis, Gap, Verdict, Where};
/// use simgap_report::page::{ReportContext, report_html};
/// let diagnosis = Diagnosis {
///     schema: "simgap-diagnosis/1",
///     model: "table".into(),
///     gap: Gap {
///         metric: "nrmse",
///         nominal: 0.021,
///         recalibrated: 0.021,
///         corrected: 0.021,
///         noise_floor: 0.020, input_noise: 0.0,
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
///     verdict: Verdict::default(),
///     stopped_early: false,
///     turning: vec![],
///     candidates: vec![],
///     next_experiment: None,
///     notes: vec![],
/// };
/// let page = report_html(&diagnosis, &[], &ReportContext::default())?;
/// assert!(page.contains("The gap of 0.0210 is measurement noise; nothing to add"));
/// # Ok::<(), simgap_report::page::ReportError>(())
/// ```
pub fn report_html(
    diagnosis: &Diagnosis,
    series: &[CheckSeries],
    context: &ReportContext,
) -> Result<String, ReportError> {
    let input = ReportInput {
        diagnosis,
        series,
        motions: &[],
        nominal: None,
        corrected: None,
        context,
    };
    report(&input).map(|report| report.html)
}

fn head(html: &mut Html, model: &str) {
    html.void("meta", &[("charset", "utf-8")]);
    let policy = ("http-equiv", "Content-Security-Policy");
    html.void("meta", &[policy, ("content", script::POLICY)]);
    let viewport = "width=device-width,initial-scale=1";
    html.void("meta", &[("name", "viewport"), ("content", viewport)]);
    let scheme = ("name", "color-scheme");
    html.void("meta", &[scheme, ("content", "light dark")]);
    html.element("title", &[], &format!("{model}: simgap diagnosis"));
    html.within("style", &[], |html| {
        html.raw(script::style());
        html.raw(&style::style_sheet());
    });
}

/// The page in the order a reader asks: what is it, how does it look, where is it, which is it,
/// what are the values, are the data sound, what next, how was it computed.
fn body(
    html: &mut Html,
    files: &mut Vec<PictureFile>,
    input: &ReportInput<'_>,
    pictures: &[Pictured<'_>],
) -> Result<(), ReportError> {
    let ReportInput {
        diagnosis, context, ..
    } = *input;
    html.within("header", &[], |html| {
        provenance(html, diagnosis, context);
        html.element("h1", &[], &headline(diagnosis));
    });
    html.within("main", &[], |html| {
        answer::first_screen(html, files, diagnosis)?;
        answer::motion(html, files, pictures)?;
        tables::channels(html, diagnosis);
        whereabouts::whereabouts(html, files, diagnosis, pictures)?;
        force::missing(html, files, input)?;
        which::which(html, files, diagnosis)?;
        values::values(html, input);
        tables::quality(html, diagnosis);
        tables::next_experiment(html, diagnosis);
        computed::computed(html, input);
        guide::how_to_read(html);
        Ok(())
    })
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
