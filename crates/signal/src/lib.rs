//! Spectra, peaks, windows, order tracking, FRF estimators and agreement metrics.
//!
//! Everything takes slices of `f64` in SI units and gives back small structs. Nothing here knows
//! what a record, a model or an effect is.
//!
//! | Question | Module |
//! |---|---|
//! | which window, and what does it cost | [`window`] |
//! | amplitude, phase and density of a whole record | [`spectrum`] |
//! | which lines stand out of the noise, where exactly, how surely | [`peaks`] |
//! | how large is the line at a frequency I know | [`lines`], [`orders`] |
//! | averaged power and cross spectra of long records | [`welch`] |
//! | frequency response, coherence and its random error | [`frf`] |
//! | how large is the white measurement noise | [`noise`] |
//! | how many independent samples is this residual worth | [`correlation`] |
//! | how well do two curves agree | [`metrics`] |
//!
//! # Scaling, once and for all
//!
//! ```text
//! amplitude:  x(t) = A cos(2π f t + φ), f on a bin     ->  amplitude A, phase φ at the first sample
//! density:    Σ density · Δf = mean square of the record   (one-sided, unit²/Hz)
//! ```
//!
//! # Example
//!
//! ```
//! use simgap_signal::{Trend, Window, spectrum::spectrum};
//!
//! // 0.3 at 12 Hz, on a bin of a record of one second.
//! let tone: Vec<f64> = (0..500)
//!     .map(|n| 0.3 * (std::f64::consts::TAU * 12.0 * f64::from(n) / 500.0).cos())
//!     .collect();
//! let found = spectrum(&tone, 500.0, Window::Hann, Trend::Mean)?;
//! assert!((found.amplitude[12] - 0.3).abs() < 1e-12);
//! # Ok::<(), simgap_signal::SignalError>(())
//! ```

#[cfg(feature = "ndarray")]
mod arrays;
mod check;
pub mod correlation;
pub mod error;
pub mod frf;
pub mod lines;
pub mod metrics;
pub mod noise;
pub mod orders;
pub mod peaks;
mod real_fft;
#[cfg(feature = "serde")]
mod serial;
pub mod spectrum;
pub mod trend;
pub mod welch;
pub mod window;

pub use check::median;
pub use error::SignalError;
pub use rustfft::num_complex::Complex64;
pub use trend::Trend;
pub use window::Window;
