//! The paper's unknown force: inverse dynamics, Fourier part and beat part.
//!
//! - [`unknown_force`]: α = m a + c v + k y − F + m g of Eq. (3), from a record and a chosen
//!   differentiation formula.
//! - [`fit_fourier`] (Table 3) and [`fit_beat`], [`fit_folded_beat`] (Table 4): least squares with
//!   standard errors.
//! - [`force_gain`]: what a differentiation formula does to α, up to the Nyquist frequency.
//! - [`explain_lines`]: do the lines at f_s/2 − f follow from one fault of the converter?
//! - [`leads`]: what the printed numbers say about damping, weight and 2.499 Hz.
//!
//! Nothing here knows the paper's numbers; they come in as arguments.

mod beat;
mod error;
mod explain;
mod folded;
mod force;
mod fourier;
mod gain;
pub mod leads;
mod least_squares;

pub use beat::{BeatFit, BeatParameters, LinePair, fit_beat};
pub use error::AlphaError;
pub use explain::{ConverterFault, Explanation, ExplanationRow, ObservedLine, explain_lines};
pub use folded::fit_folded_beat;
pub use force::{Oscillator, UnknownForce, unknown_force, unknown_force_of_record};
pub use fourier::{FourierFit, fit_fourier};
pub use gain::{GainRow, RateFormula, force_gain, gain_table};
