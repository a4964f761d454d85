//! Writing files whole or not at all.

use std::fs;
use std::path::Path;

use crate::csv_write::checked_csv;
use crate::new_file::new_file_in;
use crate::{Batch, RecordError};

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
