//! Samples in which a channel stands at a limit.
//!
//! Where a channel is saturated, nothing of the machine comes through, so nothing comes through of what the model does not
//! hold either: there a set leaves noise of the sensor alone. With K of n samples at a limit, V_o the mean square of the
//! others, r what is left in the K and s² the noise of the sensor, a channel has
//!
//! ```text
//! −ln L = ½ ρ [ (n − K) ln(V_o + ε²) + K ln(s² + ε²) + Σ_K r² / (s² + ε²) − K ]        (1)
//! ```
//!
//! in the place of ½ ρ n ln(V + ε²). A flat top that moves with the load is no saturation.
//!
//! Reference: \[BendatPiersol2010\], signal clipping.

use simgap_effects::{Action, Placed, SignalMap};
use simgap_estimate::{EstimateError, Fit, FitOptions, Problem};
use simgap_model::Location;

use super::sensor::short_noise;

/// What (1) adds to the misfit of a fit, over all channels; zero where no channel has a limit.
///
/// # Errors
/// [`EstimateError`] when the model cannot be propagated.
pub(crate) fn saturation_misfit(
    problem: &Problem,
    fit: &Fit,
    options: &FitOptions,
) -> Result<f64, EstimateError> {
    let effects = &fit.estimate.effects;
    let limits: Vec<(usize, Box<dyn SignalMap>)> = effects
        .iter()
        .filter_map(|placed| limit(problem, placed))
        .collect();
    if limits.is_empty() {
        return Ok(0.0);
    }
    let placed = [effects.as_slice(), &fit.estimate.nominal].concat();
    let mut split: Vec<Split> = limits.iter().map(|_| Split::default()).collect();
    for (run, initial) in fit.estimate.initial.iter().enumerate() {
        let simulator = problem.simulator(&placed, run)?;
        let predicted = simulator.predict(&problem.runs[run], initial)?;
        for ((channel, map), split) in limits.iter().zip(&mut split) {
            // A filtered sample is made of some before it as well.
            let order = problem.whitening.order(*channel);
            let is_at_limit: Vec<bool> = predicted[*channel]
                .iter()
                .map(|value| map.is_limit(*value))
                .collect();
            split.add(&fit.discrepancy[run][*channel], &is_at_limit, order);
        }
    }
    let std = problem.output_std();
    let each = limits.iter().zip(&split).map(|((channel, _), split)| {
        let floor = (options.floor[*channel] * std[*channel]).powi(2);
        let share = options.effective_share[*channel];
        share * split.misfit(floor)
    });
    Ok(each.sum())
}

/// The channel that an effect sets a limit to, and the limit.
fn limit(problem: &Problem, placed: &Placed) -> Option<(usize, Box<dyn SignalMap>)> {
    let (Action::Sampling(map), Location::Channel(channel)) = (placed.action(), &placed.at) else {
        return None;
    };
    let is_limit = map.is_limit(f64::INFINITY) || map.is_limit(f64::NEG_INFINITY);
    let channel = problem.model.output_index(channel)?;
    is_limit.then_some((channel, map))
}

/// What a set leaves in a channel, run by run: in samples at a limit and in the others.
#[derive(Default)]
struct Split {
    limited: Vec<Vec<f64>>,
    others: Vec<Vec<f64>>,
}

impl Split {
    fn add(&mut self, discrepancy: &[f64], is_at_limit: &[bool], order: usize) {
        let (mut limited, mut others) = (vec![], vec![]);
        for (n, left) in discrepancy.iter().enumerate() {
            let seen = &is_at_limit[n.saturating_sub(order)..=n];
            let part = match seen.iter().all(|at| *at) {
                true => &mut limited,
                false => &mut others,
            };
            part.push(*left);
        }
        self.limited.push(limited);
        self.others.push(others);
    }

    /// (1) less ½ n ln(V + ε²), both over ρ.
    fn misfit(&self, floor: f64) -> f64 {
        let (limited, of_limited) = sums(&self.limited);
        let (others, of_others) = sums(&self.others);
        if limited == 0.0 {
            return 0.0;
        }
        let all = (of_limited + of_others) / (limited + others) + floor;
        let white_in = |part: &[Vec<f64>]| short_noise(part).powi(2);
        let noise = white_in(&self.limited)
            .max(white_in(&self.others))
            .max(f64::EPSILON * all);
        let open = of_others / others.max(1.0) + floor;
        let parted = others * open.ln() + limited * (noise.ln() - 1.0) + of_limited / noise;
        eprintln!(
            "K {limited} n {others} s2 {noise} lim {} oth {} floor {floor} sK {} so {}",
            of_limited / limited,
            of_others / others,
            white_in(&self.limited),
            white_in(&self.others)
        );
        0.5 * (parted - (limited + others) * all.ln())
    }
}

/// Number and squares of the samples of all runs.
fn sums(runs: &[Vec<f64>]) -> (f64, f64) {
    let all = runs.iter().flatten();
    all.fold((0.0, 0.0), |(count, squares), left| {
        (count + 1.0, squares + left * left)
    })
}
