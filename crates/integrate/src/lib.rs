//! Time integration, forward and inverse: Park, Newmark, generalized-alpha, Runge-Kutta, exact propagation.
//!
//! - [`inverse`]: measured displacement to velocity and acceleration.

mod error;
pub mod inverse;

pub use error::{IntegrateError, Result};
