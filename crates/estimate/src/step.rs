//! One step of a fit.
//!
//! ```text
//! straight: θ + δ        multiplied: θ e^(δ/θ) for sizes and factors        (1)
//! ```
//!
//! A motion does not change where all forces and masses change in proportion. Along that curve, which is straight in the logarithms, the data
//! say nothing, and a straight step leaves it. Where the straight step of a damping gains nothing, the multiplied one is tried; both are
//! the same in the first order.

use simgap_simulate::LANES;

use crate::EstimateError;
use crate::layout::Layout;
use crate::linearise::{Linearised, Probe, discrepancies_of, probe};
use crate::merit::Merit;
use crate::normal::{damped_step, normal_equations};

/// How often λ is raised before a step is given up.
const MOST_DAMPINGS: usize = 8;

/// An accepted step.
pub(crate) struct Next {
    pub(crate) theta: Vec<f64>,
    pub(crate) objective: f64,
    pub(crate) probe: Probe,
    /// Whether sizes and factors were multiplied.
    pub(crate) is_multiplied: bool,
}

/// Where steps are searched.
pub(crate) struct Line<'a> {
    pub(crate) layout: &'a Layout,
    pub(crate) merit: &'a Merit<'a>,
}

impl Line<'_> {
    /// One accepted step of (4), or `None` when no damping finds an improvement. The first trial is mostly
    /// taken: the sensitivities that the next step wants are simulated along with it.
    pub(crate) fn step(
        &self,
        theta: &[f64],
        objective: f64,
        at: &Linearised,
        damping: &mut f64,
        along: impl Fn(usize, usize) -> bool,
    ) -> Option<Next> {
        let layout = self.layout;
        let (_, variance) = self.merit.of(layout, theta, &at.discrepancy);
        let weights = self.merit.weights(&variance);
        let (hessian, gradient) = normal_equations(layout, theta, at, &weights);
        let free: Vec<usize> = (0..layout.len())
            .filter(|&i| {
                let outward = (theta[i] <= layout.lower[i] && gradient[i] < 0.0)
                    || (theta[i] >= layout.upper[i] && gradient[i] > 0.0);
                !outward
            })
            .collect();
        // One trial is mostly enough; where it is not, further ones cost little side by side.
        let together = (LANES / self.merit.problem.runs.len().max(1)).max(1);
        // Without sizes a multiplied step is the straight one.
        let ways = 1 + usize::from(layout.is_size.contains(&true));
        let most = ways * MOST_DAMPINGS;
        let mut tried = 0;
        while tried < most {
            let count = if tried == 0 { 1 } else { together };
            let count = count.min(most - tried);
            let trials = (tried..tried + count).filter_map(|trial| {
                // Every damping along a line first, then along a curve.
                let damping = *damping * 10f64.powi((trial / ways) as i32);
                let step = damped_step(&hessian, &gradient, &free, damping)?;
                let is_multiplied = trial % ways == 1;
                let mut next = match is_multiplied {
                    false => moved(layout, theta, &step),
                    true => multiplied(layout, theta, &step),
                };
                layout.make_physical(&mut next);
                Some(Trial {
                    damping,
                    theta: next,
                    is_multiplied,
                })
            });
            let first = (tried == 0).then_some(&along);
            if let Some((used, next)) = self.first_better(objective, trials.collect(), first) {
                *damping = (used * 0.1).max(1e-9);
                return Some(next);
            }
            tried += count;
        }
        *damping *= 10f64.powi(MOST_DAMPINGS as i32);
        None
    }

    /// The first of several trials, in their order, that lowers the objective.
    fn first_better(
        &self,
        objective: f64,
        trials: Vec<Trial>,
        along: Option<&impl Fn(usize, usize) -> bool>,
    ) -> Option<(f64, Next)> {
        let (problem, layout) = (self.merit.problem, self.layout);
        let all: Vec<Result<Probe, EstimateError>> = match along {
            Some(along) => {
                let each = trials.iter();
                each.map(|trial| probe(problem, layout, &trial.theta, along))
                    .collect()
            }
            None => {
                let thetas: Vec<Vec<f64>> = trials.iter().map(|t| t.theta.clone()).collect();
                discrepancies_of(problem, layout, &thetas)
                    .into_iter()
                    .map(|signals| Ok(Probe::new(layout, signals?)))
                    .collect()
            }
        };
        for (trial, probe) in trials.into_iter().zip(all) {
            let Ok(probe) = probe else {
                continue;
            };
            let (value, _) = self.merit.of(layout, &trial.theta, &probe.discrepancy);
            if value < objective {
                let next = Next {
                    theta: trial.theta,
                    objective: value,
                    probe,
                    is_multiplied: trial.is_multiplied,
                };
                return Some((trial.damping, next));
            }
        }
        None
    }
}

/// A point that is tried.
struct Trial {
    damping: f64,
    theta: Vec<f64>,
    is_multiplied: bool,
}

/// A packed vector a step further, in units of the scales.
fn moved(layout: &Layout, theta: &[f64], step: &[f64]) -> Vec<f64> {
    let entries = theta.iter().zip(step).zip(&layout.scale);
    entries.map(|((x, step), scale)| x + step * scale).collect()
}

/// The same with sizes and factors multiplied.
fn multiplied(layout: &Layout, theta: &[f64], step: &[f64]) -> Vec<f64> {
    let mut next = moved(layout, theta, step);
    for ((next, x), is_size) in next.iter_mut().zip(theta).zip(&layout.is_size) {
        let ratio = (*next - x) / x;
        if *is_size && ratio.is_finite() {
            *next = x * ratio.exp();
        }
    }
    next
}
