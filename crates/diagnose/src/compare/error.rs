//! What keeps two records from being compared.

use simgap_record::RecordError;
use thiserror::Error;

use crate::DiagnoseError;

/// Why two records cannot be compared.
#[derive(Debug, Error)]
pub enum CompareError {
    /// No column of one is in the other.
    #[error(
        "{measured} and {simulated}: no column of the same name (one has {has}, the other {other}), \
         needed is one, or a pair of names"
    )]
    NothingInCommon {
        /// Measured record.
        measured: String,
        /// Simulated record.
        simulated: String,
        /// Columns of the measured record.
        has: String,
        /// Columns of the simulated record.
        other: String,
    },
    /// Two columns that measure different things.
    #[error(
        "column \"{channel}\" is in [{unit}] in {measured} and in [{other}] in {simulated}, needed \
         are units of the same quantity"
    )]
    Units {
        /// Column.
        channel: String,
        /// Measured record.
        measured: String,
        /// Unit there.
        unit: String,
        /// Simulated record.
        simulated: String,
        /// Unit there.
        other: String,
    },
    /// Two columns to be compared of which one is twice in the list.
    #[error("column \"{channel}\" of {record} is named twice, needed is one use of each column")]
    UsedTwice {
        /// Column.
        channel: String,
        /// Record.
        record: String,
    },
    /// No stretch of time that both cover.
    #[error(
        "{measured} runs from {from_s} s to {to_s} s and {simulated} from {other_from_s} s to \
         {other_to_s} s, needed is a common stretch of {needed} samples or more, or clocks set to \
         the same start"
    )]
    NoCommonTime {
        /// Measured record.
        measured: String,
        /// s.
        from_s: f64,
        /// s.
        to_s: f64,
        /// Simulated record.
        simulated: String,
        /// s.
        other_from_s: f64,
        /// s.
        other_to_s: f64,
        /// Fewest samples.
        needed: usize,
    },
    /// Nothing that moves is left.
    #[error(
        "{measured}: none of the columns to compare changes, needed is a measured motion or force"
    )]
    AllFlat {
        /// Measured record.
        measured: String,
    },
    /// A record does not hold what was asked for.
    #[error(transparent)]
    Record(#[from] RecordError),
    /// The judgement fails.
    #[error(transparent)]
    Diagnose(#[from] DiagnoseError),
}
