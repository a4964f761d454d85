//! What stops a question, in the words that the command prints.

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

/// Why a question is not answered.
#[derive(Debug, Error)]
pub enum AppError {
    /// A model file cannot be read.
    #[error("{}: {found}, needed is a model file", .path.display())]
    ModelFile {
        /// The file.
        path: PathBuf,
        /// What was found.
        found: String,
    },
    /// A model is not valid.
    #[error("{}: {error}", .path.display())]
    Model {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        error: ModelError,
    },
    /// An effect or a law of a model file cannot be used.
    #[error("{}: {error}", .path.display())]
    Effect {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        error: EffectError,
    },
    /// A record cannot be read or used.
    #[error(transparent)]
    Record(#[from] RecordError),
    /// A simulation is not possible.
    #[error("{}: {error}", .path.display())]
    Simulate {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        error: Box<SimulateError>,
    },
    /// A diagnosis is not possible.
    #[error(transparent)]
    Diagnose(#[from] DiagnoseError),
    /// A comparison is not possible.
    #[error(transparent)]
    Compare(#[from] CompareError),
    /// Two columns are not paired as `measured=simulated`.
    #[error(
        "--pair is \"{found}\", needed is the name of a measured and of a simulated column, such as --pair y=Pos_Mold"
    )]
    Pair {
        /// What was found.
        found: String,
    },
    /// The page cannot be made.
    #[error(transparent)]
    Report(#[from] ReportError),
    /// Two records whose predictions would be written to one file.
    #[error(
        "{} and {}: the predictions of both would be called \"{stem}\", needed is a different file name for each",
        .first.display(), .second.display()
    )]
    SameStem {
        /// The first record.
        first: PathBuf,
        /// The second record.
        second: PathBuf,
        /// The name of both.
        stem: String,
    },
    /// A check record that is fitted to.
    #[error(
        "{}: repeats the training record {} ({found}), needed is a check record that nothing is fitted to",
        .check.display(), .train.display()
    )]
    CheckRepeats {
        /// The check record.
        check: PathBuf,
        /// The training record.
        train: PathBuf,
        /// What was found.
        found: String,
    },
    /// A training record given twice.
    #[error(
        "{}: repeats the training record {} sample for sample, needed is each record once",
        .second.display(), .first.display()
    )]
    TrainTwice {
        /// The first record.
        first: PathBuf,
        /// The second record.
        second: PathBuf,
    },
    /// A folder stands where a file goes.
    #[error("{}: is a folder, needed is a file or nothing there", .path.display())]
    FolderInPlace {
        /// The file.
        path: PathBuf,
    },
    /// A result would replace an input.
    #[error("{}: is an input of this very command, needed is another file to write to", .path.display())]
    OverInput {
        /// The file.
        path: PathBuf,
    },
    /// A kind that the catalogue has not.
    #[error(
        "{option}unknown kind \"{found}\", nearest are: {near}; simgap effects lists all of them"
    )]
    UnknownKind {
        /// Empty where the kind is the argument itself.
        option: &'static str,
        /// What was found.
        found: String,
        /// Kinds that look like it.
        near: String,
    },
    /// A picture cannot be drawn.
    #[error(transparent)]
    Chart(#[from] ChartError),
    /// A result cannot be written as JSON.
    #[error("the result could not be written as JSON ({found})")]
    Json {
        /// What was found.
        found: String,
    },
    /// A prediction that no file can hold.
    #[error(
        "{record}: the prediction of column \"{channel}\" grows beyond all bounds, needed is a model that stays finite"
    )]
    RunsAway {
        /// The record.
        record: String,
        /// The output channel.
        channel: String,
    },
}
