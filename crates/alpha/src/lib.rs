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
//!
//! ```
//! use simgap_alpha::{Oscillator, fit_fourier, unknown_force};
//! use simgap_integrate::inverse::Differentiator;
//!
//! // At rest, 3 N from a spring, 4 N applied and 20 N of weight: 19 N are missing.
//! let plant = Oscillator { mass_kg: 2.0, damping: 1.0, stiffness: 3.0, load: -20.0 };
//! let found = unknown_force(&plant, &[1.0; 90], &[4.0; 90], 0.01, Differentiator::Park)?;
//! let fit = fit_fourier(&found.unknown_force, 0.01, found.settling_samples, 2.0, 1)?;
//! assert!((fit.mean - 19.0).abs() < 1e-9);
//! # Ok::<(), simgap_alpha::AlphaError>(())
//! ```

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
