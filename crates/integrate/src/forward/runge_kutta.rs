//! The classical Runge-Kutta method.

use super::balance::{Balance, Instant};
use super::start::{check_finite_motion, start_motion};
use crate::error::Result;
use crate::motion::Solution;
use crate::problem::{Problem, TimeGrid};

/// The classical Runge-Kutta method of order four, explicit.
///
/// With y = (x, ẋ) and ẏ = φ(y, t),
///
/// ```text
/// k₁ = φ(y_n, t_n)                     k₂ = φ(y_n + h k₁/2, t_n + h/2)
/// k₃ = φ(y_n + h k₂/2, t_n + h/2)      k₄ = φ(y_n + h k₃, t_n + h)
/// y_(n+1) = y_n + h (k₁ + 2 k₂ + 2 k₃ + k₄)/6
/// ```
///
/// Stable for ω h ≤ √8 without damping. The acceleration reported satisfies the equation of motion.
///
/// # Errors
///
/// [`IntegrateError::Shape`](crate::IntegrateError::Shape) when the sampled force does not fit the
/// grid, [`IntegrateError::Singular`](crate::IntegrateError::Singular) for the mass matrix,
/// [`IntegrateError::Unstable`](crate::IntegrateError::Unstable).
///
/// ```
/// use faer::mat;
/// use simgap_integrate::{Problem, TimeGrid, runge_kutta};
/// # use simgap_model::StructuralMatrices;
/// # let matrices = StructuralMatrices {
/// #     mass_matrix: mat![[1.0]], damping_matrix: mat![[0.0]], stiffness_matrix: mat![[0.0]],
/// # };
/// let hardening = |_t: f64, x: &[f64], _v: &[f64], force: &mut [f64]| force[0] = x[0].powi(3);
/// let problem = Problem::new(&matrices)?
///     .with_initial_state(&[1.0], &[0.0])?
///     .with_nonlinear_force(&hardening);
/// let solution = runge_kutta(&problem, &TimeGrid::new(0.0, 0.01, 1001)?)?;
/// let (x, v) = (solution.motion.displacement[(0, 1000)], solution.motion.velocity[(0, 1000)]);
/// assert!((v * v / 2.0 + x.powi(4) / 4.0 - 0.25).abs() < 1e-9);
/// # Ok::<(), simgap_integrate::IntegrateError>(())
/// ```
///
/// Reference: Hairer, Nørsett and Wanner 1993 (`hairer1993`), II.1.
pub fn runge_kutta(problem: &Problem<'_>, grid: &TimeGrid) -> Result<Solution> {
    let n = problem.dof_count();
    let h = grid.time_step_s / grid.substeps as f64;
    let mut balance = Balance::new(problem, grid)?;
    let (mut motion, mut state) = start_motion(&mut balance, grid);
    let (mut x, mut v, mut a) = (vec![0.0; n], vec![0.0; n], vec![0.0; n]);
    let (mut sum_v, mut sum_a) = (vec![0.0; n], vec![0.0; n]);
    for step in 0..grid.substeps * (grid.sample_count - 1) {
        // k₁ = (v_n, a_n) is known from the end of the step before.
        v.copy_from_slice(&state.v);
        a.copy_from_slice(&state.a);
        sum_v.copy_from_slice(&v);
        sum_a.copy_from_slice(&a);
        for (offset, weight) in [(0.5, 2.0), (0.5, 2.0), (1.0, 1.0)] {
            for i in 0..n {
                x[i] = state.x[i] + offset * h * v[i];
                v[i] = state.v[i] + offset * h * a[i];
            }
            balance.acceleration(Instant::in_step(grid, step, offset), &x, &v, &mut a);
            for i in 0..n {
                sum_v[i] += weight * v[i];
                sum_a[i] += weight * a[i];
            }
        }
        for i in 0..n {
            state.x[i] += h / 6.0 * sum_v[i];
            state.v[i] += h / 6.0 * sum_a[i];
        }
        let end = Instant::in_step(grid, step, 1.0);
        balance.acceleration(end, &state.x, &state.v, &mut state.a);
        balance.work.steps += 1;
        if (step + 1).is_multiple_of(grid.substeps) {
            let sample = (step + 1) / grid.substeps;
            check_finite_motion(grid, sample, &state)?;
            motion.record(sample, &state.x, &state.v, &state.a);
        }
    }
    Ok(Solution {
        motion,
        work: balance.work,
    })
}
