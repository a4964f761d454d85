//! What can go wrong between a model and a record.

use simgap_effects::EffectError;
use simgap_model::ModelError;
use simgap_record::RecordError;
use thiserror::Error;

use crate::plant::PlantError;

/// Why a simulation cannot be run.
#[derive(Debug, Error)]
pub enum SimulateError {
    /// The model cannot be propagated.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// The record does not fit the model.
    #[error(transparent)]
    Record(#[from] RecordError),
    /// An effect of the model file cannot be used.
    #[error(transparent)]
    Effect(#[from] EffectError),
    /// A simulator of the user's gives no prediction.
    #[error(transparent)]
    Plant(#[from] PlantError),
    /// Whoever asked no longer waits for the result.
    #[error("cancelled before it was done")]
    Cancelled,
}
