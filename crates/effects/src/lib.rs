//! The catalogue of unmodelled effects: one file per effect, physical and measurement.
//!
//! An effect says what it is called, where it can sit, which parameters it has and what it does;
//! fit, report, documentation, tests and withheld cases follow from that. To add one, write its
//! file and add its line to the list in `catalogue.rs`.

mod catalogue;
mod effect;
mod error;
mod free;
mod kinds;
mod place;
mod signal_map;

pub use catalogue::{catalogue, find};
pub use effect::{
    Action, Clock, Effect, Family, LINES, LawOfModel, ModelChange, Parameter, SiteKind, SiteScale,
};
pub use error::EffectError;
pub use free::free_laws;
pub use place::{Placed, sites};
pub use signal_map::{Sampled, SignalMap};
