//! What the command line says when it stops.

use std::path::PathBuf;

use simgap_diagnose::DiagnoseError;
use simgap_model::ModelError;
use simgap_record::RecordError;
use simgap_report::page::ReportError;
use simgap_simulate::SimulateError;
use thiserror::Error;

/// Why a command stops.
#[derive(Debug, Error)]
pub(crate) enum CliError {
    #[error("{}: cannot be read ({found}), needed is a model file", .path.display())]
    ModelFile { path: PathBuf, found: String },
    #[error("{}: {error}", .path.display())]
    Model { path: PathBuf, error: ModelError },
    #[error(transparent)]
    Record(#[from] RecordError),
    #[error("{}: {error}", .path.display())]
    Simulate { path: PathBuf, error: SimulateError },
    #[error(transparent)]
    Diagnose(#[from] DiagnoseError),
    #[error(transparent)]
    Report(#[from] ReportError),
    #[error(
        "two check records are both called \"{stem}\", needed is a different file name for each"
    )]
    SameStem { stem: String },
    #[error("--jobs is {found}, needed is 1 or more")]
    Jobs { found: usize },
    #[error("the threads could not be started ({found}), needed is a smaller --jobs")]
    Threads { found: String },
    #[error("the result could not be written as JSON ({found})")]
    Json { found: String },
    #[error(
        "{record}: the prediction grows beyond all bounds, needed is a model that stays finite"
    )]
    RunsAway { record: String },
}
