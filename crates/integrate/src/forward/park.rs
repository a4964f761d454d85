//! Park's stiffly stable method.

use super::balance::{Balance, Instant};
use super::generalized_alpha::{Newmark, Stepper};
use super::implicit::{Coefficients, Implicit, Predictor};
use super::start::{check_finite_motion, start_motion};
use crate::error::Result;
use crate::inverse::PARK_WEIGHTS;
use crate::motion::{Motion, Solution};
use crate::problem::{Problem, TimeGrid};

/// Steps by the trapezoidal rule before the three-step formula has its past.
const START_STEPS: usize = 2;

/// Park's stiffly stable three-step method, of order two.
///
/// ```text
/// v_n = (10 x_n − 15 x_(n−1) + 6 x_(n−2) − x_(n−3)) / (6h)                          (1)
/// a_n = (10 v_n − 15 v_(n−1) + 6 v_(n−2) − v_(n−3)) / (6h)                          (2)
/// M a_n + C v_n + K x_n + g(x_n, v_n, t_n) = f(t_n)                                 (3)
/// ```
///
/// Stable for every step; what the step does not resolve dies out (spectral radius towards 0 as
/// ω h grows), while slow motion keeps its amplitude: the numerical damping ratio is (ω h)⁵/12 and
/// the period is lengthened by (ω h)²/6, to leading order.
///
/// Start: two steps of Newmark's trapezoidal rule give x and v at the first three instants.
///
/// # Errors
///
/// As [`newmark`](crate::newmark).
///
/// ```
/// use faer::mat;
/// use simgap_integrate::{Problem, TimeGrid, park};
/// # use simgap_model::StructuralMatrices;
/// # let matrices = StructuralMatrices {
/// #     mass_matrix: mat![[1.0]], damping_matrix: mat![[0.4]], stiffness_matrix: mat![[1.0]],
/// # };
/// let push = |_t: f64, force: &mut [f64]| force[0] = 3.0;
/// let problem = Problem::new(&matrices)?
///     .with_excitation(simgap_integrate::Excitation::Function(&push))?;
/// let solution = park(&problem, &TimeGrid::new(0.0, 0.05, 2000)?)?;
/// assert!((solution.motion.displacement[(0, 1999)] - 3.0).abs() < 1e-6);
/// # Ok::<(), simgap_integrate::IntegrateError>(())
/// ```
///
/// Reference: Park 1975 (`park1975`).
pub fn park(problem: &Problem<'_>, grid: &TimeGrid) -> Result<Solution> {
    let n = problem.dof_count();
    let mut balance = Balance::new(problem, grid)?;
    let (mut motion, mut state) = start_motion(&mut balance, grid);
    let total = grid.substeps * (grid.sample_count - 1);
    let mut past = Past::new(n);
    let mut starter = Stepper::new(&mut balance, grid, Newmark::TRAPEZOIDAL.into())?;
    for step in 0..total.min(START_STEPS) {
        past.push(&state);
        starter.advance(&mut balance, grid, step, &mut state)?;
        finish_step(&mut motion, &mut balance, grid, step, &state)?;
    }
    if total <= START_STEPS {
        return Ok(Solution {
            motion,
            work: balance.work,
        });
    }
    // The unknown is a_n, and (2) and (1) are solved for v_n and x_n: no difference of nearly equal
    // displacements is ever divided by h, and rounding stays that of the values themselves.
    let h = grid.time_step_s / grid.substeps as f64;
    let reach = h / PARK_WEIGHTS[0];
    let coefficients = Coefficients {
        displacement: reach * reach,
        velocity: reach,
        acceleration: 1.0,
    };
    let mut implicit = Implicit::new(&mut balance, coefficients, grid.start_s)?;
    let mut predictor = Predictor::zeros(n);
    for step in START_STEPS..total {
        past.push(&state);
        for i in 0..n {
            predictor.v[i] = -weigh(&past.v, i) / PARK_WEIGHTS[0];
            predictor.x[i] = reach * predictor.v[i] - weigh(&past.x, i) / PARK_WEIGHTS[0];
        }
        let at = Instant::in_step(grid, step, 1.0);
        implicit.solve(&mut balance, at, &predictor, &mut state.a)?;
        for i in 0..n {
            state.v[i] = predictor.v[i] + reach * state.a[i];
            state.x[i] = predictor.x[i] + reach * reach * state.a[i];
        }
        finish_step(&mut motion, &mut balance, grid, step, &state)?;
    }
    Ok(Solution {
        motion,
        work: balance.work,
    })
}

fn finish_step(
    motion: &mut Motion,
    balance: &mut Balance<'_, '_>,
    grid: &TimeGrid,
    step: usize,
    state: &Predictor,
) -> Result<()> {
    balance.work.steps += 1;
    if (step + 1).is_multiple_of(grid.substeps) {
        let sample = (step + 1) / grid.substeps;
        check_finite_motion(grid, sample, state)?;
        motion.record(sample, &state.x, &state.v, &state.a);
    }
    Ok(())
}

/// Displacement and velocity one, two and three steps back.
struct Past {
    x: [Vec<f64>; 3],
    v: [Vec<f64>; 3],
}

impl Past {
    fn new(n: usize) -> Self {
        let empty = || [vec![0.0; n], vec![0.0; n], vec![0.0; n]];
        Self {
            x: empty(),
            v: empty(),
        }
    }

    /// The newest comes first, the oldest is overwritten.
    fn push(&mut self, state: &Predictor) {
        self.x.rotate_right(1);
        self.v.rotate_right(1);
        self.x[0].copy_from_slice(&state.x);
        self.v[0].copy_from_slice(&state.v);
    }
}

/// The past part of Equations (1) and (2), times h.
fn weigh(past: &[Vec<f64>; 3], i: usize) -> f64 {
    PARK_WEIGHTS[1] * past[0][i] + PARK_WEIGHTS[2] * past[1][i] + PARK_WEIGHTS[3] * past[2][i]
}
