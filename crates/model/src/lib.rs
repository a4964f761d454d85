//! Lumped models: masses, springs and dampers to M, C, K; modes; frequency responses; the model file.
//!
//! A model is read from text ([`Model::from_toml`]); this crate touches no files. Effects are carried
//! as written ([`EffectEntry`]); the catalogue one floor up gives them meaning.

mod check;
mod dense;
mod error;
mod file;
mod frf;
mod matrices;
mod model;
mod modes;
mod parts;

pub use error::ModelError;
pub use file::SCHEMA;
pub use frf::{FrfKind, frequency_response};
pub use matrices::StructuralMatrices;
pub use model::{Model, Node, same_pair};
pub use modes::{DampedMode, UndampedModes, damped_modes, state_matrix, undamped_modes};
pub use parts::{
    Damper, EffectEntry, GROUND, Input, InputKind, Load, Location, Mass, Output, OutputKind,
    Pendulum, Spring,
};
