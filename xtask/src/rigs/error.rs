//! Why no score is made.

use crate::asked::AskedError;

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
    /// A file cannot be read or written, or the program not be asked.
    #[error(transparent)]
    Asked(#[from] AskedError),
    /// No threads.
    #[error(transparent)]
    Threads(#[from] rayon::ThreadPoolBuildError),
}
