//! What the command line says when it stops.

use std::path::PathBuf;

use simgap_app::AppError;
use simgap_diagnose::DiagnoseError;
use simgap_diagnose::compare::CompareError;
use simgap_model::ModelError;
use simgap_record::RecordError;
use simgap_report::chart::ChartError;
use thiserror::Error;

/// Why a command stops.
#[derive(Debug, Error)]
pub(crate) enum CliError {
    /// What would stop the same question from anywhere else.
    #[error(transparent)]
    App(#[from] AppError),
    #[error("{}: {error}", .path.display())]
    Model { path: PathBuf, error: ModelError },
    #[error(transparent)]
    Record(#[from] RecordError),
    #[error(transparent)]
    Diagnose(#[from] DiagnoseError),
    #[error(transparent)]
    Fleet(#[from] simgap_fleet::FleetError),
    #[error(transparent)]
    Compare(#[from] CompareError),
    #[error(transparent)]
    Chart(#[from] ChartError),
    #[error("{}: is there already, needed is another --out, or --force to overwrite it", .path.display())]
    Exists { path: PathBuf },
    #[error("--tolerance is {found}, needed is a number of percent above 0 and up to 100")]
    Tolerance { found: f64 },
    #[error("--jobs is {found}, needed is 1 to {most}")]
    Jobs { found: usize, most: usize },
    #[error("the threads could not be started ({found}), needed is a smaller --jobs")]
    Threads { found: String },
    #[error("stdout: cannot be written ({found}), needed is a place where the answer can go")]
    Stdout { found: std::io::Error },
}
