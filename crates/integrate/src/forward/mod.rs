//! From forces to motion.

mod amplification;
mod balance;
mod dormand_prince;
mod generalized_alpha;
mod implicit;
mod lu;
mod park;
mod runge_kutta;
mod start;

pub use amplification::{
    Dissipation, amplification_matrix, numerical_dissipation, spectral_radius,
};
pub use dormand_prince::{AdaptiveTolerance, dormand_prince};
pub use generalized_alpha::{GeneralizedAlpha, Newmark, generalized_alpha, newmark};
pub use park::park;
pub use runge_kutta::runge_kutta;

use crate::error::Result;
use crate::motion::Solution;
use crate::problem::{Problem, TimeGrid};

/// A method of integration with its parameters.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Method {
    /// [`park`].
    Park,
    /// [`newmark`].
    Newmark(Newmark),
    /// [`generalized_alpha`].
    GeneralizedAlpha(GeneralizedAlpha),
    /// [`runge_kutta`].
    RungeKutta4,
    /// [`dormand_prince`].
    DormandPrince(AdaptiveTolerance),
}

/// Simulates a problem on a time grid by the method named.
///
/// # Errors
///
/// Those of the method.
///
/// ```
/// use faer::mat;
/// use simgap_integrate::{Method, Problem, TimeGrid, simulate};
/// # use simgap_model::StructuralMatrices;
/// # let matrices = StructuralMatrices {
/// #     mass_matrix: mat![[1.0]], damping_matrix: mat![[0.0]], stiffness_matrix: mat![[1.0]],
/// # };
/// let problem = Problem::new(&matrices)?.with_initial_state(&[0.0], &[1.0])?;
/// let solution = simulate(&problem, &TimeGrid::new(0.0, 0.01, 101)?, Method::Park)?;
/// assert!((solution.motion.displacement[(0, 100)] - 1.0_f64.sin()).abs() < 1e-4);
/// # Ok::<(), simgap_integrate::IntegrateError>(())
/// ```
pub fn simulate(problem: &Problem<'_>, grid: &TimeGrid, method: Method) -> Result<Solution> {
    match method {
        Method::Park => park(problem, grid),
        Method::Newmark(parameters) => newmark(problem, grid, parameters),
        Method::GeneralizedAlpha(parameters) => generalized_alpha(problem, grid, parameters),
        Method::RungeKutta4 => runge_kutta(problem, grid),
        Method::DormandPrince(tolerance) => dormand_prince(problem, grid, tolerance),
    }
}
