//! Proposals of sets: where the next fits start. They may miss a set; they do not judge one.

mod add;
mod grow;
mod initial_states;
mod model_reduction;
mod multiple_shooting;
mod multistart;
mod recalibrated;
mod rescaled;
mod slips;
mod unite;

pub(crate) use add::{FINISHED, ROUGH_STEPS};
pub use recalibrated::RECALIBRATION_STD;
