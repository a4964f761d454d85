//! A measured trace compared with one of an outside simulator, without a model.

use std::path::Path;

use simgap_diagnose::Progress;
use simgap_diagnose::compare::{CompareRequest, Compared, compare};
use simgap_report::page::{ReportContext, report_html};

use crate::folder::Folder;
use crate::input::Input;
use crate::manifest::Results;
use crate::{AppError, json};

/// Files of a result: the data, the page, the traces.
pub const FILES: [&str; 3] = ["comparison.json", "comparison.html", "compared.csv"];

/// What is asked.
pub struct Question<'a> {
    /// The measured record.
    pub measured: &'a Input,
    /// The record of a simulator.
    pub simulated: &'a Input,
    /// Columns to compare where their names differ; columns of the same name where this is empty.
    pub pairs: &'a [(String, String)],
    /// Columns of both that drive the machine and are not compared.
    pub inputs: &'a [String],
    /// Both begin at the same moment, whatever their stamps say.
    pub align_start: bool,
}

impl Question<'_> {
    /// Does the work.
    ///
    /// # Errors
    /// [`AppError::Compare`] when the records cannot be compared.
    pub fn answer(&self, progress: Progress<'_>) -> Result<Compared, AppError> {
        let request = CompareRequest {
            measured: &self.measured.record,
            simulated: &self.simulated.record,
            pairs: self.pairs,
            inputs: self.inputs,
            align_start: self.align_start,
        };
        let mut compared = compare(&request, progress)?;
        for note in self.measured.notes.iter().chain(&self.simulated.notes) {
            compared.diagnosis.notes.push(note.clone());
            compared.comparison.notes.push(note.clone());
        }
        Ok(compared)
    }
}

/// Columns that are compared, from `measured=simulated` each.
///
/// # Errors
/// [`AppError::Pair`].
pub fn pairs(given: &[String]) -> Result<Vec<(String, String)>, AppError> {
    given
        .iter()
        .map(|pair| match pair.split_once('=') {
            Some((measured, simulated)) if !measured.is_empty() && !simulated.is_empty() => {
                Ok((measured.to_string(), simulated.to_string()))
            }
            _ => Err(AppError::Pair {
                found: pair.clone(),
            }),
        })
        .collect()
}

/// The page.
///
/// # Errors
/// [`AppError::Report`] when a picture cannot be drawn.
pub fn page(compared: &Compared) -> Result<String, AppError> {
    let comparison = &compared.comparison;
    let context = ReportContext {
        program_version: env!("CARGO_PKG_VERSION").to_string(),
        model_file: comparison.simulated.clone(),
        train_records: vec![comparison.measured.clone()],
        check_records: vec![],
        seed: 0,
        command_line: String::new(),
    };
    let series = std::slice::from_ref(&compared.series);
    Ok(report_html(&compared.diagnosis, series, &context)?)
}

/// Headers and columns of the traces: `t [s]`, then of each channel what was measured, what was simulated, and what was
/// simulated with the named faults of the measurement chain.
#[must_use]
pub fn trace_columns(compared: &Compared) -> (Vec<String>, Vec<&[f64]>) {
    let mut headers = vec!["t [s]".to_string()];
    let mut columns: Vec<&[f64]> = vec![&compared.series.time_s];
    for (channel, unit) in compared.series.channels.iter().zip(&compared.units) {
        for (name, values) in [
            ("measured", &channel.measured),
            ("simulated", &channel.nominal),
            ("corrected", &channel.corrected),
        ] {
            headers.push(format!("{} {name} [{unit}]", channel.channel));
            columns.push(values);
        }
    }
    (headers, columns)
}

/// Writes all files; everything is made before the first is written. Returns the text of `comparison.json`.
///
/// # Errors
/// [`AppError`] when the folder cannot be written to.
pub fn write(compared: &Compared, out: &Path) -> Result<String, AppError> {
    let text = json(&compared.comparison)?;
    let page = page(compared)?;
    let (headers, columns) = trace_columns(compared);
    let folder = Folder::make(out, &[], &FILES.map(|name| out.join(name)))?;
    let [data, html, csv] = FILES.map(Path::new);
    let mut results = Results::new(out, "compare");
    results.add_csv(csv, &headers, &columns)?;
    results.add(html, &page)?;
    results.add(data, &text)?;
    results.finish(folder)?;
    Ok(text)
}
