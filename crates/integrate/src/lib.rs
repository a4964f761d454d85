//! Time integration, forward and inverse: Park, Newmark, generalized-alpha, Runge-Kutta, exact propagation.
//!
//! - Forces to motion: a [`Problem`], a [`TimeGrid`], a [`Method`]; [`simulate`] brings them together.
//! - [`inverse`]: measured displacement to velocity and acceleration.

mod error;
mod forward;
pub mod inverse;
mod motion;
mod problem;

pub use error::{IntegrateError, Result};
pub use forward::{
    GeneralizedAlpha, Method, Newmark, generalized_alpha, newmark, park, runge_kutta, simulate,
};
pub use motion::{Motion, Solution, Work};
pub use problem::{Excitation, NonlinearForce, Problem, Tangent, TimeGrid};
