//! Why the rules cannot be checked.

use std::path::PathBuf;

use thiserror::Error;

/// Why the rules could not be checked.
#[derive(Debug, Error)]
pub enum TidyError {
    /// Cargo could not be started.
    #[error("cargo metadata could not be started ({source})")]
    Start {
        /// What the system says.
        source: std::io::Error,
    },
    /// Cargo refused.
    #[error("cargo metadata failed: {found}")]
    Cargo {
        /// What it wrote.
        found: String,
    },
    /// Cargo wrote something else than expected.
    #[error("cargo metadata wrote what cannot be read ({source})")]
    Metadata {
        /// What the reader says.
        source: serde_json::Error,
    },
    /// A file.
    #[error("{path}: cannot be read ({source})", path = .path.display())]
    File {
        /// Which file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
}
