//! Time integration, forward and inverse: Park, Newmark, generalized-alpha, Runge-Kutta, exact propagation.
//!
//! - Forces to motion: a [`Problem`], a [`TimeGrid`], a [`Method`]; [`simulate`] brings them together.
//! - [`inverse`]: measured displacement to velocity and acceleration.
//!
//! ```
//! use faer::mat;
//! use simgap_integrate::{Method, Problem, TimeGrid, simulate};
//! use simgap_model::StructuralMatrices;
//!
//! // 1 kg on 100 N/m, released 10 mm from rest: x = 0.01 cos(10 t).
//! let matrices = StructuralMatrices {
//!     mass_matrix: mat![[1.0]],
//!     damping_matrix: mat![[0.0]],
//!     stiffness_matrix: mat![[100.0]],
//! };
//! let problem = Problem::new(&matrices)?.with_initial_state(&[0.01], &[0.0])?;
//! let solution = simulate(&problem, &TimeGrid::new(0.0, 1e-3, 1001)?, Method::RungeKutta4)?;
//! assert!((solution.motion.displacement[(0, 1000)] - 0.01 * 10.0_f64.cos()).abs() < 1e-8);
//! # Ok::<(), simgap_integrate::IntegrateError>(())
//! ```

#[cfg(feature = "ndarray")]
mod arrays;
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
