//! The state that a march begins with, and whether a state is still one.

use super::balance::{Balance, Instant};
use super::implicit::Predictor;
use crate::error::{IntegrateError, Result};
use crate::motion::Motion;
use crate::problem::TimeGrid;

/// The motion with its first sample, and the state there; the acceleration is that of equilibrium.
pub(super) fn start_motion(balance: &mut Balance<'_, '_>, grid: &TimeGrid) -> (Motion, Predictor) {
    let problem = balance.problem;
    let mut state = Predictor::zeros(problem.dof_count());
    state.x.copy_from_slice(problem.initial_displacement());
    state.v.copy_from_slice(problem.initial_velocity());
    balance.acceleration(Instant::new(grid, 0, 0.0), &state.x, &state.v, &mut state.a);
    let mut motion = Motion::zeros(problem.dof_count(), grid);
    motion.record(0, &state.x, &state.v, &state.a);
    (motion, state)
}

/// Refuses a state that has left the range of numbers.
pub(super) fn check_finite_motion(grid: &TimeGrid, sample: usize, state: &Predictor) -> Result<()> {
    let sum: f64 = state.x.iter().chain(&state.v).chain(&state.a).sum();
    if sum.is_finite() {
        return Ok(());
    }
    Err(IntegrateError::Unstable {
        time_s: grid.time_s(sample),
        time_step_s: grid.time_step_s / grid.substeps as f64,
    })
}
