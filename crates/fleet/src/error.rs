//! What stops a fleet, in one line.

use std::path::PathBuf;

use simgap_app::AppError;
use simgap_record::RecordError;
use simgap_report::chart::ChartError;
use thiserror::Error;

/// Why a fleet is not diagnosed. A single diagnosis that fails is none of these: it is a row of the table.
#[derive(Debug, Error)]
pub enum FleetError {
    /// The plan cannot be read.
    #[error("{}: {found}, needed is a plan (TOML, schema simgap-plan/1)", .path.display())]
    PlanFile {
        /// The file.
        path: PathBuf,
        /// What was found.
        found: String,
    },
    /// The plan is not valid.
    #[error("{}: {found}, needed is {needed}", .path.display())]
    Plan {
        /// The file.
        path: PathBuf,
        /// What was found.
        found: String,
        /// What is needed.
        needed: String,
    },
    /// A pattern of records is not valid.
    #[error("{}: records = \"{pattern}\": {found}, needed is {needed}", .path.display())]
    Pattern {
        /// The plan.
        path: PathBuf,
        /// The pattern.
        pattern: String,
        /// What was found.
        found: String,
        /// What is needed.
        needed: &'static str,
    },
    /// A folder of records cannot be listed.
    #[error("{}: cannot be listed ({found}), needed is a folder with records", .path.display())]
    Listing {
        /// The folder.
        path: PathBuf,
        /// What was found.
        found: String,
    },
    /// No record is where the plan says.
    #[error("{}: no record matches {patterns}, needed are records there", .path.display())]
    NoRecords {
        /// The plan.
        path: PathBuf,
        /// The patterns.
        patterns: String,
    },
    /// A unit of work cannot be understood.
    #[error(
        "a unit of work cannot be read ({found}), needed is one that this version of simgap made"
    )]
    Unit {
        /// What was found.
        found: String,
    },
    /// A file of the table cannot be read.
    #[error("{}: cannot be read as part of the table ({found}), needed is the file as it was written, or none", .path.display())]
    Table {
        /// The file.
        path: PathBuf,
        /// What was found.
        found: String,
    },
    /// Rows cannot be written as Parquet.
    #[error("rows of the table cannot be written as Parquet ({found})")]
    Encode {
        /// What was found.
        found: String,
    },
    /// The threads cannot be started.
    #[error("the threads could not be started ({found}), needed is a smaller --jobs")]
    Threads {
        /// What was found.
        found: String,
    },
    /// The work was ended before it was done.
    #[error("the fleet was ended before it was done; the same command goes on where it ended")]
    Cancelled,
    /// What stops any question.
    #[error(transparent)]
    App(#[from] AppError),
    /// A file cannot be written.
    #[error(transparent)]
    Record(#[from] RecordError),
    /// A picture cannot be drawn.
    #[error(transparent)]
    Chart(#[from] ChartError),
}
