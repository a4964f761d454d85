//! The balance of forces at one instant, shared by all methods.

use super::lu::Lu;
use crate::error::Result;
use crate::motion::Work;
use crate::problem::{Excitation, Problem, TimeGrid};

/// A place on the time grid: `fraction` of the way from one sample to the next.
#[derive(Debug, Clone, Copy)]
pub(super) struct Instant {
    pub(super) sample: usize,
    pub(super) fraction: f64,
    pub(super) time_s: f64,
}

impl Instant {
    pub(super) fn new(grid: &TimeGrid, sample: usize, fraction: f64) -> Self {
        Self {
            sample,
            fraction,
            time_s: grid.start_s + grid.time_step_s * (sample as f64 + fraction),
        }
    }

    /// `offset` of a step after the start of step `step`, counted in integration steps.
    pub(super) fn in_step(grid: &TimeGrid, step: usize, offset: f64) -> Self {
        let (sample, substep) = (step / grid.substeps, step % grid.substeps);
        Self::new(
            grid,
            sample,
            (substep as f64 + offset) / grid.substeps as f64,
        )
    }
}

/// Evaluates forces without allocating; owns the factored mass matrix.
pub(super) struct Balance<'p, 'a> {
    pub(super) problem: &'p Problem<'a>,
    pub(super) work: Work,
    mass_factor: Lu,
    restoring: Vec<f64>,
    /// Sampled force, sample after sample; empty unless the excitation is sampled.
    samples: Vec<f64>,
}

impl<'p, 'a> Balance<'p, 'a> {
    /// Checks the grid against the problem and factors the mass matrix.
    pub(super) fn new(problem: &'p Problem<'a>, grid: &TimeGrid) -> Result<Self> {
        problem.check_grid(grid)?;
        let n = problem.dof_count();
        let mut mass_factor = Lu::with_size(n);
        mass_factor.factor(problem.mass(), "the mass matrix", grid.start_s)?;
        Ok(Self {
            problem,
            work: Work {
                factorisations: 1,
                ..Work::default()
            },
            mass_factor,
            restoring: vec![0.0; n],
            samples: flat_samples(problem.excitation()),
        })
    }

    /// f(t) − C ẋ − K x − g(x, ẋ, t).
    pub(super) fn unbalanced(&mut self, at: Instant, x: &[f64], v: &[f64], out: &mut [f64]) {
        self.work.right_hand_sides += 1;
        self.excite(at, out);
        let n = x.len();
        let rows = self.problem.damping().chunks_exact(n);
        for ((force, c), k) in out
            .iter_mut()
            .zip(rows)
            .zip(self.problem.stiffness().chunks_exact(n))
        {
            for j in 0..n {
                *force -= c[j] * v[j] + k[j] * x[j];
            }
        }
        if let Some(nonlinear) = self.problem.nonlinear_force() {
            self.restoring.fill(0.0);
            nonlinear.force(at.time_s, x, v, &mut self.restoring);
            for (force, g) in out.iter_mut().zip(&self.restoring) {
                *force -= g;
            }
        }
    }

    /// ẍ = M⁻¹ (f − C ẋ − K x − g).
    pub(super) fn acceleration(&mut self, at: Instant, x: &[f64], v: &[f64], out: &mut [f64]) {
        self.unbalanced(at, x, v, out);
        self.mass_factor.solve(out);
    }

    /// Largest Σ |f| + |C||ẋ| + |K||x| + |g| + |M||a| over the degrees of freedom, N: the size
    /// against which a residual is small. To be called right after [`Balance::unbalanced`], whose
    /// g it reuses.
    pub(super) fn size(
        &self,
        at: Instant,
        x: &[f64],
        v: &[f64],
        a: &[f64],
        scratch: &mut [f64],
    ) -> f64 {
        let n = x.len();
        self.excite(at, scratch);
        let problem = self.problem;
        let mut largest = 0.0_f64;
        for i in 0..n {
            let mut sum = scratch[i].abs();
            if problem.nonlinear_force().is_some() {
                sum += self.restoring[i].abs();
            }
            for j in 0..n {
                let entry = i * n + j;
                sum += (problem.mass()[entry] * a[j]).abs()
                    + (problem.damping()[entry] * v[j]).abs()
                    + (problem.stiffness()[entry] * x[j]).abs();
            }
            largest = largest.max(sum);
        }
        largest
    }

    /// f(t); between samples on a straight line.
    fn excite(&self, at: Instant, out: &mut [f64]) {
        match self.problem.excitation() {
            Excitation::None => out.fill(0.0),
            Excitation::Function(function) => function(at.time_s, out),
            Excitation::Sampled(_) => {
                let n = out.len();
                let from = n * at.sample;
                let left = &self.samples[from..from + n];
                // Past the last sample there is no line to go along; rounding may ask for it.
                let right = self.samples.get(from + n..from + 2 * n).unwrap_or(left);
                for ((force, a), b) in out.iter_mut().zip(left).zip(right) {
                    *force = a + at.fraction * (b - a);
                }
            }
        }
    }
}

/// A sampled force as one slice, sample after sample.
fn flat_samples(excitation: Excitation<'_>) -> Vec<f64> {
    let Excitation::Sampled(samples) = excitation else {
        return Vec::new();
    };
    let mut flat = Vec::with_capacity(samples.nrows() * samples.ncols());
    for column in samples.col_iter() {
        flat.extend(column.iter());
    }
    flat
}
