//! Output-error estimation: which parameter values make the simulation follow the records best,
//! how sure that is, and what a further effect would bring.
//!
//! A [`Problem`] is a nominal model with its runs; a [`Fit`] is what the data say about one set of
//! effects, with the nominal parameters held near their values and the initial states free.

mod fit;
mod initial;
mod layout;
mod linearise;
mod normal;
mod problem;
mod score;
mod site;

pub use fit::{Fit, Interval, fit};
pub use initial::{fit_initial_states, simulator_at};
pub use layout::{Candidate, Start};
pub use problem::{Problem, Weights};
pub use score::{Base, Score, linearise_at, score};

pub use simgap_simulate::SimulateError as EstimateError;
