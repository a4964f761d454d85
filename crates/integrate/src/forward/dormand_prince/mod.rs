//! The adaptive pair of Dormand and Prince with continuous output.

mod control;
mod tableau;

pub use control::AdaptiveTolerance;

use self::control::Controller;
use self::tableau::{ERROR_WEIGHTS, NODES, STAGE_WEIGHTS, STAGES};
use super::balance::{Balance, Instant};
use super::start::start_motion;
use crate::error::{IntegrateError, Result};
use crate::motion::{Motion, Solution};
use crate::problem::{Excitation, Problem, TimeGrid};

/// The explicit pair of orders 5 and 4 of Dormand and Prince with automatic steps.
///
/// With y = (x, ẋ) and ẏ = φ(y, t),
///
/// ```text
/// k_i = φ(y + h Σ_j a_ij k_j, t + c_i h)       y⁺ = y + h Σ b_i k_i
/// error = h Σ (b_i − b̂_i) k_i                  y(t + θh) = y + h Σ b_i(θ) k_i
/// ```
///
/// The step follows the error by proportional-integral control. A sampled force has a kink at each
/// sample: there the steps stop, so that none straddles a kink. Under a force given as a function the
/// steps are free and the samples of the grid are taken from the continuous extension, of order
/// four. [`TimeGrid::with_substeps`] has no influence.
///
/// # Errors
///
/// [`IntegrateError::Shape`], [`IntegrateError::Singular`] for the mass matrix,
/// [`IntegrateError::StepTooSmall`], [`IntegrateError::TooManySteps`].
///
/// ```
/// use faer::mat;
/// use simgap_integrate::{AdaptiveTolerance, Problem, TimeGrid, dormand_prince};
/// # use simgap_model::StructuralMatrices;
/// # let matrices = StructuralMatrices {
/// #     mass_matrix: mat![[1.0]], damping_matrix: mat![[0.0]], stiffness_matrix: mat![[1.0]],
/// # };
/// let problem = Problem::new(&matrices)?.with_initial_state(&[1.0], &[0.0])?;
/// let tolerance = AdaptiveTolerance::new(1e-9, 1e-12, 1e-12)?;
/// let solution = dormand_prince(&problem, &TimeGrid::new(0.0, 0.5, 21)?, tolerance)?;
/// assert!((solution.motion.displacement[(0, 20)] - 10.0_f64.cos()).abs() < 1e-7);
/// # Ok::<(), simgap_integrate::IntegrateError>(())
/// ```
///
/// References: Dormand and Prince 1980 (`dormand1980`); Hairer, Nørsett and Wanner 1993
/// (`hairer1993`), II.4 to II.6.
pub fn dormand_prince(
    problem: &Problem<'_>,
    grid: &TimeGrid,
    tolerance: AdaptiveTolerance,
) -> Result<Solution> {
    let mut balance = Balance::new(problem, grid)?;
    let (mut motion, start) = start_motion(&mut balance, grid);
    let mut run = Run::new(balance, grid, tolerance);
    run.state.extend_from_slice(&start.x);
    run.state.extend_from_slice(&start.v);
    run.stages[0][..start.v.len()].copy_from_slice(&start.v);
    run.stages[0][start.v.len()..].copy_from_slice(&start.a);
    let last = grid.sample_count - 1;
    if last > 0 {
        let mut step = run.first_step();
        // Position in units of the grid interval; samples up to `done` are written.
        let (mut position, mut done) = (0.0, 0);
        while done < last {
            let stop = if run.stops_at_samples {
                (done + 1) as f64
            } else {
                last as f64
            };
            (position, step) = run.take_step(position, stop, step)?;
            done = run.write_samples(&mut motion, done, position);
        }
    }
    Ok(Solution {
        motion,
        work: run.balance.work,
    })
}

/// One simulation under way. Time is counted in intervals of the grid, so that samples are met
/// exactly; slopes are per second.
struct Run<'g, 'p, 'a> {
    balance: Balance<'p, 'a>,
    grid: &'g TimeGrid,
    tolerance: AdaptiveTolerance,
    controller: Controller,
    stops_at_samples: bool,
    /// x then ẋ, at the end of the step last taken.
    state: Vec<f64>,
    /// The same at its start.
    before: Vec<f64>,
    trial: Vec<f64>,
    /// Acceleration at a sample between steps.
    sampled: Vec<f64>,
    stages: [Vec<f64>; STAGES],
    /// Start and length of the step last taken.
    begun: f64,
    length: f64,
}

impl<'g, 'p, 'a> Run<'g, 'p, 'a> {
    fn new(balance: Balance<'p, 'a>, grid: &'g TimeGrid, tolerance: AdaptiveTolerance) -> Self {
        let size = 2 * balance.problem.dof_count();
        Self {
            stops_at_samples: matches!(balance.problem.excitation(), Excitation::Sampled(_)),
            balance,
            grid,
            tolerance,
            controller: Controller::new(),
            state: Vec::with_capacity(size),
            before: vec![0.0; size],
            trial: vec![0.0; size],
            sampled: vec![0.0; size / 2],
            stages: std::array::from_fn(|_| vec![0.0; size]),
            begun: 0.0,
            length: 0.0,
        }
    }

    /// Slope of `trial` into stage i.
    fn evaluate(&mut self, i: usize, position: f64, interval: f64) {
        let n = self.state.len() / 2;
        let (x, v) = self.trial.split_at(n);
        let (slope_x, slope_v) = self.stages[i].split_at_mut(n);
        slope_x.copy_from_slice(v);
        let at = Instant::new(self.grid, interval as usize, position - interval);
        self.balance.acceleration(at, x, v, slope_v);
    }

    /// Root mean square of a change relative to the tolerance at `state` and `trial`.
    fn norm(&self, change: impl Fn(usize) -> f64) -> f64 {
        let size = self.state.len();
        let mut sum = 0.0;
        for i in 0..size {
            let absolute = if i < size / 2 {
                self.tolerance.displacement
            } else {
                self.tolerance.velocity
            };
            let value = self.state[i].abs().max(self.trial[i].abs());
            sum += (change(i) / (absolute + self.tolerance.relative * value)).powi(2);
        }
        (sum / size as f64).sqrt()
    }

    /// A first guess from the size of y, ẏ and ÿ (Hairer, Nørsett and Wanner 1993, II.4).
    fn first_step(&mut self) -> f64 {
        let interval = self.grid.time_step_s;
        self.trial.copy_from_slice(&self.state);
        let size = self.norm(|i| self.state[i]);
        let slope = self.norm(|i| self.stages[0][i]);
        let tiny = 1e-5;
        let guess = if size < tiny || slope < tiny {
            1e-6 * interval
        } else {
            0.01 * size / slope
        };
        let guess = guess.min(interval);
        for i in 0..self.state.len() {
            self.trial[i] = self.state[i] + guess * self.stages[0][i];
        }
        self.evaluate(1, guess / interval, 0.0);
        self.trial.copy_from_slice(&self.state);
        let curvature = self.norm(|i| self.stages[1][i] - self.stages[0][i]) / guess;
        let largest = slope.max(curvature);
        let step = if largest <= 1e-15 {
            (1e-3 * guess).max(1e-6 * interval)
        } else {
            (0.01 / largest).powf(0.2)
        };
        step.min(100.0 * guess) / interval
    }

    /// Repeats until a step is accepted; returns the new position and the step to try next.
    fn take_step(&mut self, position: f64, stop: f64, proposed: f64) -> Result<(f64, f64)> {
        let end = (self.grid.sample_count - 1) as f64;
        let mut step = proposed;
        loop {
            let needed = 16.0 * f64::EPSILON * position.max(1.0);
            if step.is_nan() || step <= needed {
                return Err(IntegrateError::StepTooSmall {
                    time_s: self.time_s(position),
                    found_s: step * self.grid.time_step_s,
                    needed_s: needed * self.grid.time_step_s,
                });
            }
            let spent = self.balance.work.steps + self.balance.work.rejected_steps;
            if spent >= self.tolerance.step_limit {
                return Err(IntegrateError::TooManySteps {
                    time_s: self.time_s(position),
                    found: spent,
                    end_s: self.time_s(end),
                });
            }
            // What is left is taken whole, or in two halves rather than with a sliver at the end.
            let left = stop - position;
            let tried = match step {
                s if s >= left => left,
                s if 2.0 * s > left => 0.5 * left,
                s => s,
            };
            let error = self.try_step(position, tried);
            if error <= 1.0 {
                self.balance.work.steps += 1;
                let next = self.controller.after_accepted(tried, error);
                self.accept(position, tried);
                let reached = if tried == left {
                    stop
                } else {
                    position + tried
                };
                // A step cut short by a stop says little about what the next may be.
                return Ok((reached, if tried < step { next.max(step) } else { next }));
            }
            self.balance.work.rejected_steps += 1;
            step = self.controller.after_rejected(tried, error);
        }
    }

    /// All stages of one step; leaves the result in `trial` and returns its error.
    fn try_step(&mut self, position: f64, step: f64) -> f64 {
        // The interval whose straight line the force follows, for all stages of a step that stops
        // at samples; otherwise the force is a function and only the time counts.
        let interval = position.floor();
        let h = step * self.grid.time_step_s;
        for stage in 1..STAGES {
            for i in 0..self.state.len() {
                let mut slope = 0.0;
                for (j, weight) in STAGE_WEIGHTS[stage][..stage].iter().enumerate() {
                    slope += weight * self.stages[j][i];
                }
                self.trial[i] = self.state[i] + h * slope;
            }
            self.evaluate(stage, position + NODES[stage] * step, interval);
        }
        self.norm(|i| {
            let sum: f64 = (0..STAGES)
                .map(|j| ERROR_WEIGHTS[j] * self.stages[j][i])
                .sum();
            h * sum
        })
    }

    fn accept(&mut self, position: f64, step: f64) {
        (self.begun, self.length) = (position, step);
        self.before.copy_from_slice(&self.state);
        self.state.copy_from_slice(&self.trial);
    }

    /// Writes the samples that the step last taken has passed, then passes its last slope on.
    fn write_samples(&mut self, motion: &mut Motion, mut done: usize, reached: f64) -> usize {
        let n = self.state.len() / 2;
        while done + 1 < self.grid.sample_count && (done + 1) as f64 <= reached {
            done += 1;
            if done as f64 == reached {
                let (x, v) = self.state.split_at(n);
                motion.record(done, x, v, &self.stages[STAGES - 1][n..]);
                continue;
            }
            let weights = tableau::extension((done as f64 - self.begun) / self.length);
            let h = self.length * self.grid.time_step_s;
            for i in 0..2 * n {
                let slope: f64 = (0..STAGES).map(|j| weights[j] * self.stages[j][i]).sum();
                self.trial[i] = self.before[i] + h * slope;
            }
            let (x, v) = self.trial.split_at(n);
            let at = Instant::new(self.grid, done, 0.0);
            self.balance.acceleration(at, x, v, &mut self.sampled);
            motion.record(done, x, v, &self.sampled);
        }
        let (first, rest) = self.stages.split_at_mut(1);
        first[0].copy_from_slice(&rest[STAGES - 2]);
        done
    }

    fn time_s(&self, position: f64) -> f64 {
        self.grid.start_s + position * self.grid.time_step_s
    }
}
