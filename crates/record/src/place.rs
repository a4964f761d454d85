//! Where in a record a value stands.

use std::fmt;

/// Where in a record a value stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Place {
    /// Line of a file, counted from 1.
    Line(u64),
    /// Row of a record without lines, counted from 0.
    Row(usize),
    /// Byte of a file, counted from 0.
    Byte(u64),
    /// Names of a record made in memory.
    Names,
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Place::Line(line) => write!(f, "line {line}"),
            Place::Row(row) => write!(f, "row {row}"),
            Place::Byte(byte) => write!(f, "byte {byte}"),
            Place::Names => f.write_str("names"),
        }
    }
}

/// The flag for a missing value in a file of text.
pub(crate) fn mending(at: Place, found: &str) -> &'static str {
    match at {
        Place::Line(_) if crate::logger::is_missing(found) => "; --mend takes it as missing",
        _ => "",
    }
}
