//! Why a campaign cannot be run.

use simgap_blind::BlindError;
use thiserror::Error;

/// Why a campaign cannot be run.
#[derive(Debug, Error)]
pub enum BlindCheckError {
    /// A case cannot be generated, or the truths are not those that were sealed.
    #[error(transparent)]
    Case(#[from] BlindError),
    /// A model is no text.
    #[error(transparent)]
    Model(#[from] simgap_model::ModelError),
    /// A record cannot be written.
    #[error(transparent)]
    Record(#[from] simgap_record::RecordError),
    /// The threads cannot be started.
    #[error("cannot start the threads: {0}")]
    Threads(#[from] rayon::ThreadPoolBuildError),
    /// The program does not know where it is.
    #[error("cannot find the program that is to be started for each case: {0}")]
    Program(#[source] std::io::Error),
    /// A file or folder cannot be written or read.
    #[error("{path}: {source}")]
    File {
        /// Which.
        path: String,
        /// Why not.
        source: std::io::Error,
    },
    /// A file of a case is not what it was when the truths were sealed.
    #[error("{path}: SHA-256 is {found}, needed is {needed} as sealed")]
    Changed {
        /// Which.
        path: String,
        /// Of the file.
        found: String,
        /// As sealed.
        needed: String,
    },
}
