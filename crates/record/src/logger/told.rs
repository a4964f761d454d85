//! What the readers of known layouts share: cells, and what is told of them.

use super::cells::{is_missing, number, split};
use crate::error::RecordError;
use crate::faults::TextFault;
use crate::note::Note;
use crate::words::shortened;

/// What a reader of such a layout is told.
pub(super) fn told(notes: &mut Vec<Note>, text: &str) {
    notes.push(Note::Source {
        text: text.to_owned(),
    });
}

/// The number in a cell, or the refusal that names the line.
pub(super) fn value(
    file: &str,
    line: usize,
    column: &str,
    cell: &str,
    decimal_comma: bool,
) -> Result<f64, RecordError> {
    let cell = cell.trim();
    if is_missing(cell) {
        return Ok(f64::NAN);
    }
    number(cell, decimal_comma).ok_or_else(|| RecordError::NotANumber {
        file: file.to_owned(),
        line: line as u64 + 1,
        column: shortened(column),
        found: shortened(cell),
    })
}

/// The value after a key in the first cells of some lines.
pub(super) fn keyed(lines: &[&str], separator: char, key: &str) -> Option<(usize, String)> {
    lines.iter().enumerate().find_map(|(k, line)| {
        let cells = split(line, separator)?;
        let found = cells.first()?.trim_end_matches(':').trim();
        let value = cells.get(1)?;
        found
            .eq_ignore_ascii_case(key)
            .then(|| (k, value.clone().into_owned()))
    })
}

pub(super) fn lacks(
    file: &str,
    line: usize,
    found: String,
    needed: &'static str,
    program: &'static str,
) -> RecordError {
    RecordError::Text {
        file: file.to_owned(),
        fault: TextFault::Program {
            line: line as u64 + 1,
            found,
            needed,
            program,
        },
    }
}
