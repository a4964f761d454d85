//! What can be wrong with a fixture of the paper.

use thiserror::Error;

/// Why a table of the paper could not be read.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum TableError {
    /// The text is not TOML of the expected layout.
    #[error("{file}: not a table of the paper: {reason}")]
    Layout {
        /// Fixture file.
        file: String,
        /// What the TOML reader says.
        reason: String,
    },
    /// The schema line names another layout.
    #[error("{file}: found schema \"{found}\", need \"{needed}\"")]
    Schema {
        /// Fixture file.
        file: String,
        /// Schema found.
        found: String,
        /// Schema needed.
        needed: &'static str,
    },
    /// A number that should be there is not.
    #[error("{file}: no value for {place}")]
    Missing {
        /// Fixture file.
        file: String,
        /// What was looked for.
        place: String,
    },
    /// A number is there twice.
    #[error("{file}: {place} is given more than once")]
    Duplicate {
        /// Fixture file.
        file: String,
        /// What was looked for.
        place: String,
    },
    /// The printed string is not a number.
    #[error("{place}: found \"{printed}\", need a number")]
    NotANumber {
        /// Where it stands.
        place: String,
        /// The printed string.
        printed: String,
    },
    /// The unit is not one the paper uses.
    #[error("{place}: unknown unit \"{unit}\"")]
    Unit {
        /// Where it stands.
        place: String,
        /// The unit found.
        unit: String,
    },
    /// The cell claims to belong to another table.
    #[error("{file}: {place} says table {found}, need {needed}")]
    WrongTable {
        /// Fixture file.
        file: String,
        /// Which cell.
        place: String,
        /// Table number found.
        found: u8,
        /// Table number needed.
        needed: u8,
    },
    /// The text of a fixture changed.
    #[error("{file}: checksum {found:#018x}, need {needed:#018x}: a published number was changed")]
    Checksum {
        /// Fixture file.
        file: &'static str,
        /// Checksum found.
        found: u64,
        /// Checksum committed.
        needed: u64,
    },
}
