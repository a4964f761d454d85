//! A file as bytes.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

use crate::RecordError;
use crate::limits::MAX_FILE_BYTES;

/// Bytes asked from the system at once.
pub(crate) const BUFFER_BYTES: usize = 1 << 17;

/// The file, opened, and its name without the folders.
pub(crate) fn opened(path: &Path, label: &str) -> Result<(File, String), RecordError> {
    let refused = |source: io::Error| match source.kind() {
        io::ErrorKind::NotFound => RecordError::NotFound {
            file: label.to_owned(),
        },
        _ => RecordError::Unreadable {
            file: label.to_owned(),
            source,
        },
    };
    let file = File::open(path).map_err(refused)?;
    if file.metadata().map_err(refused)?.is_dir() {
        return Err(RecordError::IsDirectory {
            file: label.to_owned(),
        });
    }
    let name = path
        .file_name()
        .map_or_else(|| label.to_owned(), |n| n.to_string_lossy().into_owned());
    Ok((file, name))
}

/// The bytes of a file that is held in memory whole.
pub(crate) fn all_bytes(file: impl Read, label: &str) -> Result<Vec<u8>, RecordError> {
    let mut bytes = Vec::new();
    file.take(MAX_FILE_BYTES + 1)
        .read_to_end(&mut bytes)
        .map_err(|source| RecordError::Unreadable {
            file: label.to_owned(),
            source,
        })?;
    if bytes.len() as u64 > MAX_FILE_BYTES {
        return Err(RecordError::TooLarge {
            file: label.to_owned(),
            most: MAX_FILE_BYTES,
        });
    }
    Ok(bytes)
}
