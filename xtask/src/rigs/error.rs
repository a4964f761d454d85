//! Why no score is made.

use std::io;
use std::path::Path;

/// Why no score was made.
#[derive(Debug, thiserror::Error)]
pub enum RigsError {
    /// A role that does not exist.
    #[error("role {0}: needed is single, pair, clean, parameters, foreign or slip")]
    Role(String),
    /// A kind that is not drawn.
    #[error("kind {0}: needed is an effect of the catalogue or a foreign law of the rigs")]
    Kind(String),
    /// A case cannot be drawn.
    #[error(transparent)]
    Rig(#[from] simgap_rigs::RigError),
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
    /// No threads.
    #[error(transparent)]
    Threads(#[from] rayon::ThreadPoolBuildError),
}

/// An error at a file.
pub(super) fn at(path: &Path) -> impl FnOnce(io::Error) -> RigsError + '_ {
    move |source| RigsError::File {
        path: path.display().to_string(),
        source,
    }
}
