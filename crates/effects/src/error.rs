//! What can be wrong with an effect in a model file.

use simgap_model::ModelError;
use thiserror::Error;

/// Why an effect is refused.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum EffectError {
    /// Not in the catalogue.
    #[error("[[effect]] \"{found}\": unknown kind, needed is one of: {known}")]
    UnknownKind {
        /// As written.
        found: String,
        /// Kinds of the catalogue.
        known: String,
    },
    /// A parameter is missing.
    #[error("[[effect]] \"{kind}\": parameter {parameter} is missing")]
    MissingParameter {
        /// The effect.
        kind: String,
        /// The parameter.
        parameter: &'static str,
    },
    /// A parameter the effect does not have.
    #[error("[[effect]] \"{kind}\": unknown parameter {found}, needed is one of: {known}")]
    UnknownParameter {
        /// The effect.
        kind: String,
        /// As written.
        found: String,
        /// Its parameters.
        known: String,
    },
    /// A parameter outside its physical range.
    #[error("[[effect]] \"{kind}\": {parameter} is {found}, needed is {lower} to {upper}")]
    OutOfRange {
        /// The effect.
        kind: String,
        /// The parameter.
        parameter: &'static str,
        /// As written.
        found: f64,
        /// Smallest value.
        lower: f64,
        /// Largest value.
        upper: f64,
    },
    /// The place does not go with the effect.
    #[error("[[effect]] \"{kind}\": it sits {found}, needed is {needed}")]
    WrongPlace {
        /// The effect.
        kind: String,
        /// As written.
        found: String,
        /// What is needed.
        needed: String,
    },
    /// A law of the model file that cannot be an effect.
    #[error("[[law]] \"{law}\": {found}, needed is {needed}")]
    Law {
        /// The law.
        law: String,
        /// What was found.
        found: String,
        /// What is needed.
        needed: &'static str,
    },
    /// The place is not in the model.
    #[error(transparent)]
    Model(#[from] ModelError),
}
