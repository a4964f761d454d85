//! Why no answers are compared.

use crate::asked::AskedError;

/// Why no answers are compared.
#[derive(Debug, thiserror::Error)]
pub enum StabilityError {
    /// A case cannot be drawn.
    #[error(transparent)]
    Case(#[from] simgap_blind::BlindError),
    /// A model is no text.
    #[error(transparent)]
    Model(#[from] simgap_model::ModelError),
    /// A record cannot be written.
    #[error(transparent)]
    Record(#[from] simgap_record::RecordError),
    /// A file cannot be read or written, or the program not be asked.
    #[error(transparent)]
    Asked(#[from] AskedError),
    /// No threads.
    #[error(transparent)]
    Threads(#[from] rayon::ThreadPoolBuildError),
}
