//! The objective of a fit.

use crate::layout::Layout;
use crate::linearise::reach;
use crate::products::dot;
use crate::reach::Reach;
use crate::signals::Signals;
use crate::{FitOptions, Problem};

/// The objective (1) and the weights (3) of a fit (`fit.rs`).
pub(crate) struct Merit<'a> {
    pub(crate) problem: &'a Problem,
    effective_share: Vec<f64>,
    floor: Vec<f64>,
    /// Samples of all runs, and those of each channel that were filled.
    count: f64,
    filled: Vec<f64>,
}

/// [`Fit::misfit`](crate::Fit::misfit) of a model that leaves these mean squares of the channels (squares of their units), under other
/// options than it was fitted with.
#[must_use]
pub fn misfit(problem: &Problem, variance: &[f64], options: &FitOptions) -> f64 {
    Merit::new(problem, options).misfit(variance)
}

impl<'a> Merit<'a> {
    pub(crate) fn new(problem: &'a Problem, weights: &FitOptions) -> Merit<'a> {
        let std = problem.output_std();
        Merit {
            problem,
            effective_share: weights.effective_share.clone(),
            floor: std
                .iter()
                .zip(&weights.floor)
                .map(|(s, floor)| (floor * s).powi(2).max(f64::MIN_POSITIVE))
                .collect(),
            count: problem.runs.iter().map(|run| run.len as f64).sum(),
            filled: (0..std.len()).map(|c| problem.filled_count(c)).collect(),
        }
    }

    /// V_c, over the samples within reach.
    pub(crate) fn variance(&self, discrepancy: &[Signals], reach: &Reach) -> Vec<f64> {
        (0..self.floor.len())
            .map(|c| {
                let square = |run: &Signals| dot(&run[c], &run[c]);
                discrepancy.iter().map(square).sum::<f64>() / reach.count(c).max(1.0)
            })
            .collect()
    }

    /// J and V_c; J is infinite when a simulation ran away.
    pub(crate) fn of(
        &self,
        layout: &Layout,
        theta: &[f64],
        discrepancy: &[Signals],
    ) -> (f64, Vec<f64>) {
        let reach = reach(self.problem, layout, theta);
        let variance = self.variance(discrepancy, &reach);
        let value = self.misfit(&variance) + self.prior(layout, theta);
        (if value.is_nan() { f64::INFINITY } else { value }, variance)
    }

    /// The first sum of (1).
    fn misfit(&self, variance: &[f64]) -> f64 {
        let channels = variance.iter().zip(&self.floor);
        channels
            .zip(self.effective_share.iter().zip(&self.filled))
            .map(|((v, floor), (rho, filled))| 0.5 * rho * (self.count - filled) * (v + floor).ln())
            .sum()
    }

    /// The second sum of (1).
    pub(crate) fn prior(&self, layout: &Layout, theta: &[f64]) -> f64 {
        let entries = theta.iter().enumerate();
        entries
            .map(|(i, value)| layout.prior_at(i, *value)[0])
            .sum()
    }

    pub(crate) fn weights(&self, variance: &[f64]) -> Vec<f64> {
        let floor = self.floor.iter().zip(&self.effective_share);
        variance
            .iter()
            .zip(floor)
            .map(|(v, (floor, rho))| rho / (v + floor))
            .collect()
    }
}
