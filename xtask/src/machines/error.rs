//! Why no machine was asked about.

use crate::asked::AskedError;

/// Why no machine was asked about.
#[derive(Debug, thiserror::Error)]
pub enum MachinesError {
    /// A file cannot be read or written, or the program not be asked.
    #[error(transparent)]
    Asked(#[from] AskedError),
    /// A model file that cannot be read.
    #[error("{path}: {source}")]
    Model {
        /// The file.
        path: String,
        /// Why.
        source: simgap_model::ModelError,
    },
    /// A record in which an output is missing, or has no numbers.
    #[error("{path}, line {line}: column \"{channel}\" holds no number")]
    NoNumber {
        /// The file.
        path: String,
        /// The line, from 1.
        line: usize,
        /// The output.
        channel: String,
    },
    /// Other kinds are named than those that are written down.
    #[error("{0}")]
    Differ(String),
    /// No threads.
    #[error(transparent)]
    Threads(#[from] rayon::ThreadPoolBuildError),
}
