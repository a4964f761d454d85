//! Why a case cannot be generated.

use simgap_model::ModelError;
use simgap_mold::MoldError;
use simgap_record::RecordError;
use simgap_simulate::SimulateError;
use thiserror::Error;

/// Why a case cannot be generated.
#[derive(Debug, Error)]
pub enum BlindError {
    /// A plant is not a model.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// The mold of the paper is not a model.
    #[error(transparent)]
    Mold(#[from] MoldError),
    /// The truth cannot be simulated.
    #[error(transparent)]
    Simulate(#[from] SimulateError),
    /// The truth does not make a record.
    #[error(transparent)]
    Record(#[from] RecordError),
    /// A recipe names a kind that does not exist.
    #[error("recipe \"{found}\": unknown kind, needed is one of: {known}")]
    UnknownKind {
        /// As asked for.
        found: String,
        /// What there is.
        known: String,
    },
    /// A recipe names a kind that no plant which is drawn here has a place for.
    #[error(
        "recipe \"{found}\": a kind of the simulators of users, no drawn machine has a place for it; needed is one of: {drawn}"
    )]
    NoPlant {
        /// As asked for.
        found: String,
        /// What can be drawn.
        drawn: String,
    },
    /// No plant, place and size was found at which the effect matters and can be reproduced.
    #[error(
        "case {number}, recipe \"{recipe}\": none of {attempts} draws has an effect of the needed size"
    )]
    NoCase {
        /// Number of the case.
        number: usize,
        /// What was asked for.
        recipe: String,
        /// Draws tried.
        attempts: u64,
    },
    /// The truths cannot be written as text or read again.
    #[error("sealed truths: {0}")]
    Seal(#[source] serde_json::Error),
    /// The truths are not those whose digest was published.
    #[error("sealed truths: the digest is {found}, needed is the published {needed}")]
    BrokenSeal {
        /// Of the text.
        found: String,
        /// As published.
        needed: String,
    },
}
