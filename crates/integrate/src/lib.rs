//! Time integration, forward and inverse: Park, Newmark, generalized-alpha, Runge-Kutta, exact propagation.
//!
//! - Forces to motion: a [`Problem`], a [`TimeGrid`], a [`Method`]; [`simulate`] brings them together.
//! - [`inverse`]: measured displacement to velocity and acceleration.

mod error;
pub mod exact;
mod forward;
pub mod inverse;
mod motion;
mod problem;

pub use error::{IntegrateError, Result};
pub use forward::{
    AdaptiveTolerance, Dissipation, GeneralizedAlpha, Method, Newmark, amplification_matrix,
    dormand_prince, generalized_alpha, newmark, numerical_dissipation, park, runge_kutta, simulate,
    spectral_radius,
};
pub use motion::{Motion, Solution, Work};
pub use problem::{Excitation, NonlinearForce, Problem, Tangent, TimeGrid};
