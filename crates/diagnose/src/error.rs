//! What can be wrong with a request.

use simgap_record::RecordError;
use simgap_simulate::SimulateError;
use thiserror::Error;

/// Why a diagnosis cannot be made.
#[derive(Debug, Error)]
pub enum DiagnoseError {
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
    /// A record too short to learn from.
    #[error("{record}: {found} rows to learn from, needed is {needed} or more")]
    TooShort {
        /// Record.
        record: String,
        /// Rows left to learn from.
        found: usize,
        /// Fewest.
        needed: usize,
    },
    /// A measured output that never changes has no scale to compare with.
    #[error("{record}: column \"{channel}\" never changes, needed is a measured motion or force")]
    FlatOutput {
        /// Record.
        record: String,
        /// Column.
        channel: String,
    },
}
