//! Spectra, peaks, windows, order tracking, FRF estimators and agreement metrics.
//!
//! Everything takes slices of `f64` in SI units and gives back small structs. Nothing here knows
//! what a record, a model or an effect is.
//!
//! # Scaling, once and for all
//!
//! ```text
//! amplitude:  x(t) = A cos(2π f t + φ), f on a bin     ->  amplitude A, phase φ at the first sample
//! density:    Σ density · Δf = mean square of the record   (one-sided, unit²/Hz)
//! ```

mod check;
pub mod error;
pub mod metrics;
pub mod peaks;
mod real_fft;
pub mod spectrum;
pub mod trend;
pub mod window;

pub use error::SignalError;
pub use rustfft::num_complex::Complex64;
pub use trend::Trend;
pub use window::Window;
