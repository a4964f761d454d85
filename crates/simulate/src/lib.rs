//! A model with its effects driven by a record: predicted outputs.
//!
//! [`Run`] brings a record into the units of a model; [`Simulator`] holds the model with its
//! effects, ready to be marched through runs from any initial state; [`predict_all`] does many at once.

mod batch;
mod drive;
mod error;
mod outputs;
mod prepare;
mod run;
mod simulator;
mod step;

pub use batch::{Job, Prediction, predict_all};
pub use error::SimulateError;
pub use run::{Run, input_quantity, output_quantity, output_unit};
pub use simgap_integrate::exact::lanes::LANES;
pub use simulator::{MemberPath, Simulator};
pub use step::substeps_for;
