//! What can be wrong with a request.

use simgap_record::RecordError;
use simgap_simulate::SimulateError;
use thiserror::Error;

/// Why a diagnosis cannot be made.
#[derive(Debug, Error)]
pub enum DiagnoseError {
    /// A simulator is to be judged by parts of the records it learns from.
    #[error(
        "a simulator begins every run in a state of its own, so that no part of a record can be held back: needed is a check record \
         beside the records to learn from"
    )]
    NoCheckRecord,
    /// A record or the model does not allow a simulation.
    #[error(transparent)]
    Simulate(#[from] SimulateError),
    /// A record cannot be split.
    #[error(transparent)]
    Record(#[from] RecordError),
    /// A kind to withhold that is not in the catalogue.
    #[error("--withhold \"{found}\": unknown kind, needed is one of: {known}")]
    UnknownKind {
        /// As asked for.
        found: String,
        /// Kinds of the catalogue.
        known: String,
    },
    /// No record to learn from.
    #[error("no training record was given, needed is at least one")]
    NoRecord,
    /// A record too short to learn from or to judge by.
    #[error("{record}: {found} rows to {purpose}, needed is {needed} or more")]
    TooShort {
        /// Record.
        record: String,
        /// Rows there are.
        found: usize,
        /// Fewest.
        needed: usize,
        /// `learn from` or `judge by`.
        purpose: &'static str,
    },
    /// A channel in one unit here and in another there.
    #[error(
        "{record}: column \"{channel}\" is in {found}, and in {known}: needed is one unit for all records"
    )]
    OtherUnit {
        /// Record.
        record: String,
        /// Column.
        channel: String,
        /// Its unit.
        found: String,
        /// The unit of the first record, and which that is.
        known: String,
    },
    /// A measured output that never changes has no scale to compare with.
    #[error(
        "{record}: column \"{channel}\" never changes{part}, needed is a measured motion or force"
    )]
    FlatOutput {
        /// Record.
        record: String,
        /// Column.
        channel: String,
        /// Where, if not in the whole record: ` in the held-back last third`.
        part: &'static str,
    },
}
