//! What no set of effects is expected to explain: one object for each problem.
//!
//! ```text
//! V_c(S) + ε_c²,   ε_c² = (accuracy of the simulation)² + (noise of the inputs through the plant)²      (1)
//! ln L = −½ Σ_c n_c ∫ q_c(x) dx/x,   x up to V_c + ε_c²,   n_c = share_c · N          (2)
//! q_c(x) = ζ + (1 − ζ) min(1, (σ_c² + ε_c²)/x),   ζ = α/(α + Σ n_c)                    (3)
//! ```
//!
//! V_c is the squared discrepancy of a channel, n_c the number of its samples that are independent. ε_c comes from the
//! records and the nominal model ([`accuracy`], [`input_noise`]); what the steps of the march miss of the forces of a set
//! ([`accuracy_of_steps`]) counts beside it where it is asked whether the set leaves more than that. The share of independent samples is that of one
//! residual, and the same for all sets that are compared: first what re-estimated parameters leave, by the larger of the counts for a mean and
//! for a variance, so that the search climbs; then what the best
//! set leaves, by that for a variance, once; before larger sets where a single effect leaves nothing but noise. With it the model discrepancy has an amplitude that every set infers, V_c itself, and a colour
//! that none of them chooses. Coloured noise of a sensor has its share of independent samples alike. Where noise of the
//! inputs is integrated by the plant, residuals are whitened before they are squared ([`whitening`]).
//!
//! Where the search ends with a set that leaves more than noise, the noise σ_c of the sensors in what the least set leaves is told from the
//! discrepancy ([`noise_variance`]). Noise counts by its samples; what a lumped model misses of a machine beyond it is no sample of anything, and
//! counts as α observations at the most. Until then ζ = 1: the search climbs, and judges nothing.
//!
//! Reference: \[Miller2019\], the coarsened likelihood.

mod accuracy;
mod input_noise;
mod range_ends;
mod sensor;
mod whitening;

pub use accuracy::{accuracy, accuracy_of_steps};
pub use input_noise::{InputNoise, input_noise};
pub(crate) use range_ends::log_likelihood_at_range_ends;
pub use sensor::{noise_variance, rounding_variance, stepped, stored_rounding_variance};
pub use whitening::whitening;

use simgap_estimate::{Discrepancy, EstimateError, Fit, FitOptions, Problem};
use simgap_signal::SignalError;
use simgap_signal::correlation::{effective_sample_count, independent_sample_count};

/// How well noise is known: its mean square to a tenth. What is left within it is noise.
pub const NOISE_KNOWN: f64 = 1.1;
/// α of (3).
const DISCREPANCY: f64 = 50.0;
/// A fit of the search stops when a step gains less than this: sets are told apart by more.
const SEARCH_CONVERGED: f64 = 0.1;

/// What no set is expected to explain.
#[derive(Debug, Clone, PartialEq)]
pub struct NoiseModel {
    /// Independent samples per sample of each channel.
    pub effective_share: Vec<f64>,
    /// ε_c over the standard deviation of the channel.
    pub floor: Vec<f64>,
    /// Standard deviation of each channel.
    std: Vec<f64>,
    /// σ_c and α of (3), once they are known.
    discrepancy: Option<Discrepancy>,
}

impl NoiseModel {
    /// For the search in a problem, with the colour of what a fit of it with re-estimated parameters leaves.
    ///
    /// # Errors
    /// [`EstimateError`] when the model cannot be propagated.
    pub fn new(
        problem: &Problem,
        baseline: &Fit,
        residual: &Fit,
    ) -> Result<NoiseModel, EstimateError> {
        let options = FitOptions::white(problem.model.outputs.len());
        // A model that parts from the machine, a pendulum that turns over where the real one does not, is led away by any noise.
        let noise_through = |fit: &Fit| input_noise(problem, &fit.estimate.nominal, &options, &[]);
        let (given, estimated) = (noise_through(baseline)?, noise_through(residual)?);
        let both = given.iter().zip(&estimated);
        let driven = both.map(|(given, estimated)| given.beyond(0.0).min(estimated.beyond(0.0)));
        let of_simulation = accuracy(problem, baseline)?;
        let std = problem.output_std();
        let channels = of_simulation.iter().zip(driven).zip(&std);
        let floor = channels.map(|((accuracy, driven), std)| {
            let share = accuracy.hypot(driven.sqrt()) / std;
            if share.is_finite() {
                share.min(1.0)
            } else {
                1.0
            }
        });
        Ok(NoiseModel {
            effective_share: shares(residual, std.len(), |left| {
                Ok(effective_sample_count(left)?.max(independent_sample_count(left)?))
            }),
            floor: floor.collect(),
            std,
            discrepancy: None,
        })
    }

    /// The same where the records of one problem are those of the other at another rate: as many independent samples among more or fewer.
    #[must_use]
    pub fn at_rate_of(&self, from: &Problem, to: &Problem) -> NoiseModel {
        let step_s = |problem: &Problem| problem.runs.first().map_or(1.0, |run| run.time_step_s);
        let steps = step_s(to) / step_s(from);
        let shares = self.effective_share.iter();
        NoiseModel {
            effective_share: shares.map(|share| (steps * share).min(1.0)).collect(),
            ..self.clone()
        }
    }

    /// The same with the colour of what another fit leaves.
    #[must_use]
    pub fn with_colour_of(&self, residual: &Fit) -> NoiseModel {
        NoiseModel {
            effective_share: share_of_variance(residual, &self.std),
            ..self.clone()
        }
    }

    /// The same where so much is noise, mean square of each channel, and what is left beyond it the discrepancy of (3).
    #[must_use]
    pub fn with_noise(&self, noise: &[f64]) -> NoiseModel {
        let channels = noise.iter().zip(&self.std);
        NoiseModel {
            discrepancy: Some(Discrepancy {
                observations: DISCREPANCY,
                noise: channels.map(|(noise, std)| noise.sqrt() / std).collect(),
            }),
            ..self.clone()
        }
    }

    /// Options of the fits of a search.
    #[must_use]
    pub fn search_options(&self) -> FitOptions {
        FitOptions {
            converged: SEARCH_CONVERGED,
            keep_nuisance: true,
            ..self.final_options()
        }
    }

    /// Options of a fit that is to be finished.
    #[must_use]
    pub fn final_options(&self) -> FitOptions {
        FitOptions {
            effective_share: self.effective_share.clone(),
            floor: self.floor.clone(),
            discrepancy: self.discrepancy.clone(),
            ..FitOptions::white(self.floor.len())
        }
    }
}

/// Share of independent samples in the variance of the discrepancy of each channel: its own or, if that is less, the mean over all channels, each by what it
/// leaves of its motion. What is left where most is would otherwise count for less than traces in a channel that is all but explained.
fn share_of_variance(fit: &Fit, std: &[f64]) -> Vec<f64> {
    let own = shares(fit, std.len(), independent_sample_count);
    let left = fit.variance.iter().zip(std);
    let left: Vec<f64> = left.map(|(left, std)| left / (std * std)).collect();
    let all: f64 = left.iter().sum();
    let weighted = own.iter().zip(&left).map(|(share, left)| share * left);
    let mean = weighted.sum::<f64>() / all;
    // Where nothing is left at all, or a channel does not move, each has its own.
    let most = if mean.is_finite() { mean } else { 1.0 };
    own.into_iter().map(|share| share.min(most)).collect()
}

/// Independent samples, as they are counted, per sample of the discrepancy of each channel.
fn shares(
    fit: &Fit,
    channels: usize,
    count_in: impl Fn(&[f64]) -> Result<f64, SignalError>,
) -> Vec<f64> {
    let of_channel = |c: usize| {
        let (mut independent, mut total) = (0.0, 0.0);
        for run in &fit.discrepancy {
            let count = run[c].len() as f64;
            independent += count_in(&run[c]).unwrap_or(count).min(count);
            total += count;
        }
        (independent / f64::max(total, 1.0)).clamp(1e-4, 1.0)
    };
    (0..channels).map(of_channel).collect()
}
