//! Writing files whole or not at all.

use std::fmt::Write as _;
use std::fs;
use std::io;
use std::path::Path;

use crate::error::Place;
use crate::{Batch, RecordError};

/// Below this magnitude, and from [`EXPONENT_FROM`] on, numbers are written with an exponent.
const EXPONENT_BELOW: f64 = 1e-5;
/// See [`EXPONENT_BELOW`].
const EXPONENT_FROM: f64 = 1e16;

/// Writes columns as CSV, beside the target first and then renamed, so that a reader sees the old
/// file or the whole new one. Numbers have the fewest digits that read back as the same double.
///
/// ```
/// use simgap_record::{read_csv, write_csv_atomic};
///
/// let dir = tempfile::tempdir()?;
/// let path = dir.path().join("A.csv");
/// let time: Vec<f64> = (0..20).map(|k| f64::from(k) * 0.01).collect();
/// let y: Vec<f64> = time.iter().map(|t| 0.1 * t.sin()).collect();
/// write_csv_atomic(&path, &["t [s]".into(), "y [m]".into()], &[&time, &y])?;
/// assert_eq!(read_csv(&path)?.require("y")?.values, y);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
///
/// [`RecordError::HeaderCount`], [`RecordError::LengthMismatch`] or [`RecordError::NotFinite`]
/// for columns that would not make a readable file, [`RecordError::Unwritable`] when the system
/// refuses.
pub fn write_csv_atomic(
    path: &Path,
    headers: &[String],
    columns: &[&[f64]],
) -> Result<(), RecordError> {
    write_text_atomic(path, &checked_csv(path, headers, columns)?)
}

/// Columns as CSV, checked to make a readable file.
pub(crate) fn checked_csv(
    path: &Path,
    headers: &[String],
    columns: &[&[f64]],
) -> Result<String, RecordError> {
    let file = || path.display().to_string();
    if headers.len() != columns.len() {
        let (headers, columns) = (headers.len(), columns.len());
        return Err(RecordError::HeaderCount {
            file: file(),
            headers,
            columns,
        });
    }
    let needed = columns.first().map_or(0, |column| column.len());
    let named = || headers.iter().zip(columns);
    if let Some((header, column)) = named().find(|(_, column)| column.len() != needed) {
        let (column, found) = (header.clone(), column.len());
        return Err(RecordError::LengthMismatch {
            file: file(),
            column,
            found,
            needed,
        });
    }
    for (header, column) in named() {
        if let Some(row) = column.iter().position(|value| !value.is_finite()) {
            let (column, found) = (header.clone(), column[row].to_string());
            return Err(RecordError::NotFinite {
                file: file(),
                at: Place::Row(row),
                column,
                found,
            });
        }
    }
    Ok(csv_text(headers, columns))
}

fn csv_text(headers: &[String], columns: &[&[f64]]) -> String {
    let rows = columns.first().map_or(0, |column| column.len());
    let mut text = String::with_capacity(rows * columns.len() * 12 + 64);
    for (index, header) in headers.iter().enumerate() {
        if index > 0 {
            text.push(',');
        }
        push_cell(&mut text, header);
    }
    text.push('\n');
    for row in 0..rows {
        for (index, column) in columns.iter().enumerate() {
            if index > 0 {
                text.push(',');
            }
            push_number(&mut text, column[row]);
        }
        text.push('\n');
    }
    text
}

/// A header cell, quoted where it must be.
fn push_cell(text: &mut String, cell: &str) {
    if cell.contains([',', '"', '\n', '\r']) {
        text.push('"');
        text.push_str(&cell.replace('"', "\"\""));
        text.push('"');
    } else {
        text.push_str(cell);
    }
}

/// The fewest digits that read back as the same double.
fn push_number(text: &mut String, value: f64) {
    let magnitude = value.abs();
    let plain = magnitude == 0.0 || (EXPONENT_BELOW..EXPONENT_FROM).contains(&magnitude);
    // Writing to a String cannot fail.
    let _ = if plain {
        write!(text, "{value}")
    } else {
        write!(text, "{value:e}")
    };
}

/// Writes a text file, beside the target first and then renamed; see [`Batch`].
///
/// # Errors
///
/// [`RecordError::Unwritable`] when the place is no regular file, or when the system refuses; the
/// target is then as it was.
pub fn write_text_atomic(path: &Path, text: &str) -> Result<(), RecordError> {
    let mut batch = Batch::default();
    batch.add(path, text)?;
    batch.commit()
}

/// The folder that a file is in.
pub(crate) fn parent(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    }
}

/// A file beside the target that vanishes unless it is renamed.
pub(crate) fn new_file_in(dir: &Path) -> io::Result<tempfile::NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".simgap-").suffix(".part");
    #[cfg(unix)]
    {
        // A temporary file is private by default; a result is for everyone the umask allows.
        use std::os::unix::fs::PermissionsExt as _;
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    // Without the random name of the file beside: a message repeats itself to the letter.
    builder
        .tempfile_in(dir)
        .map_err(|refused| io::Error::from(refused.kind()))
}

/// Makes sure that files can be written to a directory; creates it and its parents if needed.
///
/// # Errors
///
/// [`RecordError::NotADirectory`] when the path is a file, [`RecordError::Unwritable`] when the
/// system refuses.
pub fn ensure_writable_dir(path: &Path) -> Result<(), RecordError> {
    let label = || path.display().to_string();
    if path.exists() && !path.is_dir() {
        return Err(RecordError::NotADirectory { path: label() });
    }
    let refused = |source| RecordError::Unwritable {
        path: label(),
        source,
    };
    fs::create_dir_all(path).map_err(refused)?;
    new_file_in(path).map_err(refused)?.close().map_err(refused)
}
