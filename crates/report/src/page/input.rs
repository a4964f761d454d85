//! What a page tells of.

use simgap_diagnose::{CheckSeries, Diagnosis, PlaceMotion};
use simgap_effects::{Effect, find, find_of};
use simgap_model::Model;

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
    /// Seed of the run; nothing in a diagnosis is random, and the page says so.
    pub seed: u64,
}

/// All that a page can tell of.
#[derive(Debug, Clone, Copy)]
pub struct ReportInput<'a> {
    /// The answer.
    pub diagnosis: &'a Diagnosis,
    /// The check records with their predictions.
    pub series: &'a [CheckSeries],
    /// The motion across the members along the check records, for the force that the model lacks.
    pub motions: &'a [PlaceMotion],
    /// The model as given, to set the corrected one beside it.
    pub nominal: Option<&'a Model>,
    /// The corrected model.
    pub corrected: Option<&'a Model>,
    /// Where the page comes from.
    pub context: &'a ReportContext,
}

impl ReportInput<'_> {
    /// The effect of a kind: of the catalogue, or a law of the model if there is one.
    pub(super) fn effect(&self, kind: &str) -> Option<&'static dyn Effect> {
        let model = self.nominal.or(self.corrected);
        model.map_or_else(|| find(kind), |model| find_of(model, kind))
    }
}
