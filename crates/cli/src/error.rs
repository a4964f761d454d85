//! What the command line says when it stops.

use std::path::PathBuf;

use simgap_diagnose::DiagnoseError;
use simgap_diagnose::compare::CompareError;
use simgap_effects::EffectError;
use simgap_model::ModelError;
use simgap_record::RecordError;
use simgap_report::chart::ChartError;
use simgap_report::page::ReportError;
use simgap_simulate::SimulateError;
use thiserror::Error;

/// Why a command stops.
#[derive(Debug, Error)]
pub(crate) enum CliError {
    #[error("{}: {found}, needed is a model file", .path.display())]
    ModelFile { path: PathBuf, found: String },
    #[error("{}: {error}", .path.display())]
    Model { path: PathBuf, error: ModelError },
    #[error("{}: {error}", .path.display())]
    Effect { path: PathBuf, error: EffectError },
    #[error(transparent)]
    Record(#[from] RecordError),
    #[error("{}: {error}", .path.display())]
    Simulate {
        path: PathBuf,
        error: Box<SimulateError>,
    },
    #[error(transparent)]
    Diagnose(#[from] DiagnoseError),
    #[error(transparent)]
    Compare(#[from] CompareError),
    #[error(
        "--pair is \"{found}\", needed is the name of a measured and of a simulated column, such as --pair y=Pos_Mold"
    )]
    Pair { found: String },
    #[error(transparent)]
    Report(#[from] ReportError),
    #[error(
        "{} and {}: the predictions of both would be called \"{stem}\", needed is a different file name for each",
        .first.display(), .second.display()
    )]
    SameStem {
        first: PathBuf,
        second: PathBuf,
        stem: String,
    },
    #[error(
        "{}: repeats the training record {} ({found}), needed is a check record that nothing is fitted to",
        .check.display(), .train.display()
    )]
    CheckRepeats {
        check: PathBuf,
        train: PathBuf,
        found: String,
    },
    #[error(
        "{}: repeats the training record {} sample for sample, needed is each record once",
        .second.display(), .first.display()
    )]
    TrainTwice { first: PathBuf, second: PathBuf },
    #[error("{}: is a folder, needed is a file or nothing there", .path.display())]
    FolderInPlace { path: PathBuf },
    #[error("{}: is there already, needed is another --out, or --force to overwrite it", .path.display())]
    Exists { path: PathBuf },
    #[error("{}: is an input of this very command, needed is another file to write to", .path.display())]
    OverInput { path: PathBuf },
    #[error(
        "{option}unknown kind \"{found}\", nearest are: {near}; simgap effects lists all of them"
    )]
    UnknownKind {
        /// Empty where the kind is the argument itself.
        option: &'static str,
        found: String,
        near: String,
    },
    #[error("--tolerance is {found}, needed is a number of percent above 0 and up to 100")]
    Tolerance { found: f64 },
    #[error(transparent)]
    Chart(#[from] ChartError),
    #[error("--jobs is {found}, needed is 1 to {most}")]
    Jobs { found: usize, most: usize },
    #[error("the threads could not be started ({found}), needed is a smaller --jobs")]
    Threads { found: String },
    #[error("stdout: cannot be written ({found}), needed is a place where the answer can go")]
    Stdout { found: std::io::Error },
    #[error("the result could not be written as JSON ({found})")]
    Json { found: String },
    #[error(
        "{record}: the prediction of column \"{channel}\" grows beyond all bounds, needed is a model that stays finite"
    )]
    RunsAway { record: String, channel: String },
}
