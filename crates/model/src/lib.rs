//! Lumped models: masses, bodies, beams, springs and dampers to M, C, K; modes; frequency responses; the model file.
//!
//! A model is read from text ([`Model::from_toml`]); this crate touches no files. Effects are carried
//! as written ([`EffectEntry`]); the catalogue one floor up gives them meaning.
//!
//! ```
//! use simgap_model::{Model, undamped_modes};
//!
//! let model = Model::from_toml(r#"
//! schema = "simgap-model/1"
//! name = "two blocks"
//! [[mass]]
//! name = "lower"
//! value = 1.0
//! [[mass]]
//! name = "upper"
//! value = 1.0
//! [[spring]]
//! name = "a"
//! between = ["lower", "ground"]
//! stiffness = 100.0
//! [[spring]]
//! name = "b"
//! between = ["upper", "lower"]
//! stiffness = 100.0
//! [[output]]
//! channel = "y"
//! kind = "displacement"
//! at = "upper"
//! "#)?;
//! let matrices = model.matrices()?;
//! assert_eq!(matrices.stiffness_matrix[(0, 0)], 200.0);
//! // ω² = 100 (3 ∓ √5) / 2
//! let modes = undamped_modes(&matrices)?;
//! let lowest = (50.0 * (3.0 - 5.0_f64.sqrt())).sqrt() / std::f64::consts::TAU;
//! assert!((modes.natural_freq_hz[0] - lowest).abs() < 1e-9);
//! # Ok::<(), simgap_model::ModelError>(())
//! ```

#[cfg(feature = "ndarray")]
mod arrays;
mod between_samples;
mod check;
mod coordinate;
mod dense;
mod drawing;
mod element;
mod elements;
mod error;
mod file;
mod frf;
mod input;
mod law;
mod matrices;
mod model;
mod modes;
mod node;
mod output;
mod parameter;
mod parts;
mod plant;
mod pole_kind;
mod refuse;
mod sensitivity;
pub mod serial;
mod travel;
mod two;
mod uncertainty;

pub use between_samples::BetweenSamples;
pub use coordinate::CoordinateKind;
pub use drawing::{Drawing, Glyph};
pub use elements::*;
pub use error::ModelError;
pub use file::SCHEMA;
pub use frf::{FrfKind, frequency_response};
pub use input::{Input, InputKind};
pub use law::{Expression, Function, Known, Law, LawParameter, Operation, Symbol};
pub use matrices::StructuralMatrices;
pub use model::{Model, same_pair};
pub use modes::{
    DampedMode, UndampedModes, damped_modes, damped_modes_of, state_matrix, undamped_modes,
};
pub use node::{BodyPoint, Node};
pub use output::{Form, Output, OutputKind, Reading};
pub use parameter::Parameter;
pub use parts::{
    DEFAULT_UNCERTAINTY, Damper, EffectEntry, GROUND, Load, Location, Mass, Pendulum, Spring,
};
pub use plant::{PlantParameter, PlantPort};
pub use pole_kind::{PoleKind, pole_kinds};
pub use sensitivity::{PoleSensitivity, pole_sensitivities, receptance_sensitivity};
pub use uncertainty::NominalQuantity;
