//! Why the program could not be asked.

use std::io;
use std::path::Path;

/// Why the program could not be asked.
#[derive(Debug, thiserror::Error)]
pub enum AskedError {
    /// A file cannot be read or written.
    #[error("{path}: {source}")]
    File {
        /// The file.
        path: String,
        /// Why.
        source: io::Error,
    },
    /// A truth or an answer that cannot be read.
    #[error("{path}: {source}")]
    Json {
        /// The file.
        path: String,
        /// Why.
        source: serde_json::Error,
    },
}

/// An error at a file.
pub(crate) fn at(path: &Path) -> impl FnOnce(io::Error) -> AskedError + '_ {
    move |source| AskedError::File {
        path: path.display().to_string(),
        source,
    }
}

/// An error in a file of JSON.
pub(crate) fn json(path: &Path) -> impl FnOnce(serde_json::Error) -> AskedError + '_ {
    move |source| AskedError::Json {
        path: path.display().to_string(),
        source,
    }
}
