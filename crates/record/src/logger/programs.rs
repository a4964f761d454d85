//! Text of programs and instruments whose layout is known by its first lines and is no plain table.

use super::{lvm, scopes, twincat};
use crate::error::RecordError;
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
