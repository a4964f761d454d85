//! Text of programs and instruments whose layout is known by its first lines and is no plain table.

use super::cells::{number, split};
use super::{lvm, scopes, twincat};
use crate::error::{RecordError, shortened};
use crate::faults::TextFault;
use crate::note::Note;
use crate::raw::Raw;

/// Lines that are looked at.
const LOOKED_AT: usize = 64;

/// Reads the text if it is of a layout known here.
pub(super) fn read(
    file: &str,
    text: &str,
    notes: &mut Vec<Note>,
) -> Result<Option<Raw>, RecordError> {
    let lines: Vec<&str> = super::text::lines(text).take(LOOKED_AT).collect();
    let Some(first) = lines.iter().find(|line| !line.trim().is_empty()) else {
        return Ok(None);
    };
    if lvm::is_lvm(first) {
        return lvm::read(file, text, notes).map(Some);
    }
    if scopes::is_tektronix(&lines) {
        return scopes::tektronix(file, text, notes).map(Some);
    }
    if let Some(header) = scopes::rigol_header(&lines) {
        return scopes::rigol(file, text, header, notes).map(Some);
    }
    if let Some(base) = scopes::rigol_inline(&lines) {
        return scopes::rigol_later(file, text, base, notes).map(Some);
    }
    if scopes::is_instek(text, &lines) {
        return scopes::instek(file, text, notes).map(Some);
    }
    if twincat::is_twincat(&lines) {
        return twincat::read(file, text, notes).map(Some);
    }
    Ok(None)
}

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
    if super::cells::is_missing(cell) {
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
