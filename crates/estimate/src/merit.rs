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
    channels: Vec<Channel>,
    /// ζ of (3).
    exponent: f64,
}

/// How one channel counts.
struct Channel {
    /// ρ_c.
    effective_share: f64,
    /// ρ_c N_c.
    independent: f64,
    /// ε_c².
    floor: f64,
    /// σ_c² + ε_c².
    noise: f64,
}

/// [`Fit::misfit`](crate::Fit::misfit) of a model that leaves these mean squares of the channels (squares of their units), under other
/// options than it was fitted with.
#[must_use]
pub fn misfit(problem: &Problem, variance: &[f64], options: &FitOptions) -> f64 {
    Merit::new(problem, options).misfit(variance)
}

impl<'a> Merit<'a> {
    pub(crate) fn new(problem: &'a Problem, weights: &FitOptions) -> Merit<'a> {
        let count: f64 = problem.runs.iter().map(|run| run.len as f64).sum();
        let discrepancy = weights.discrepancy.as_ref();
        let channel = |(c, std): (usize, f64)| {
            let floor = (weights.floor[c] * std).powi(2).max(f64::MIN_POSITIVE);
            let noise = discrepancy.map_or(f64::INFINITY, |of| (of.noise[c] * std).powi(2));
            Channel {
                effective_share: weights.effective_share[c],
                independent: weights.effective_share[c] * (count - problem.filled_count(c)),
                floor,
                noise,
            }
        };
        let channels: Vec<Channel> = problem
            .output_std()
            .into_iter()
            .enumerate()
            .map(channel)
            .collect();
        let exponent = discrepancy.map_or(1.0, |of| {
            of.observations / (of.observations + independent(&channels))
        });
        Merit {
            problem,
            channels,
            exponent,
        }
    }

    /// V_c, over the samples within reach.
    pub(crate) fn variance(&self, discrepancy: &[Signals], reach: &Reach) -> Vec<f64> {
        (0..self.channels.len())
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
        let channels = self.channels.iter().zip(variance);
        channels
            .map(|(channel, v)| 0.5 * channel.independent * channel.log_size(*v, self.exponent))
            .sum()
    }

    /// Independent observations that what is left counts as.
    pub(crate) fn observations(&self, variance: &[f64]) -> f64 {
        let channels = self.channels.iter().zip(variance);
        channels
            .map(|(channel, v)| channel.independent * channel.share(*v, self.exponent))
            .sum()
    }

    /// The same as a share of all independent samples.
    pub(crate) fn share(&self, variance: &[f64]) -> f64 {
        self.observations(variance) / independent(&self.channels).max(f64::MIN_POSITIVE)
    }

    /// The second sum of (1).
    pub(crate) fn prior(&self, layout: &Layout, theta: &[f64]) -> f64 {
        let entries = theta.iter().enumerate();
        entries
            .map(|(i, value)| layout.prior_at(i, *value)[0])
            .sum()
    }

    pub(crate) fn weights(&self, variance: &[f64]) -> Vec<f64> {
        let channels = self.channels.iter().zip(variance);
        channels
            .map(|(channel, v)| {
                channel.effective_share * channel.share(*v, self.exponent) / (v + channel.floor)
            })
            .collect()
    }
}

/// Independent samples of all channels.
fn independent(channels: &[Channel]) -> f64 {
    channels.iter().map(|channel| channel.independent).sum()
}

impl Channel {
    /// q of (3).
    fn share(&self, variance: f64, exponent: f64) -> f64 {
        let of_noise = (self.noise / (variance + self.floor)).min(1.0);
        exponent + (1.0 - exponent) * of_noise
    }

    /// The integral of q over ln(V + ε²).
    fn log_size(&self, variance: f64, exponent: f64) -> f64 {
        let all = variance + self.floor;
        if all <= self.noise {
            return all.ln();
        }
        let of_noise = 1.0 - self.noise / all;
        self.noise.ln() + exponent * (all / self.noise).ln() + (1.0 - exponent) * of_noise
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CHANNEL: Channel = Channel {
        effective_share: 1.0,
        independent: 1000.0,
        floor: 0.1,
        noise: 1.1,
    };

    #[test]
    fn verify_the_weights_are_the_slope_of_the_objective() {
        let step = 1e-6;
        for exponent in [0.05, 0.5, 1.0] {
            for variance in [0.3, 0.999, 1.001, 2.0, 40.0] {
                let [before, after] =
                    [-step, step].map(|by| CHANNEL.log_size(variance + by, exponent));
                let slope = (after - before) / (2.0 * step);
                let expected = CHANNEL.share(variance, exponent) / (variance + CHANNEL.floor);
                assert!(
                    (slope / expected - 1.0).abs() < 1e-7,
                    "{exponent}, {variance}"
                );
            }
        }
    }

    #[test]
    fn verify_noise_counts_in_full_and_what_is_beyond_it_by_the_exponent() {
        assert_eq!(CHANNEL.log_size(0.5, 0.05), 0.6_f64.ln());
        // From far above noise to twice of that.
        let [near, far] = [1e6, 2e6].map(|variance| CHANNEL.log_size(variance, 0.05));
        assert!((far - near - 0.05 * 2_f64.ln()).abs() < 1e-6);
        // All samples count alike where no discrepancy is told from noise.
        let all = Channel {
            noise: f64::INFINITY,
            ..CHANNEL
        };
        assert_eq!(all.log_size(1e6, 1.0), (1e6_f64 + 0.1).ln());
        assert_eq!(all.share(1e6, 1.0), 1.0);
    }
}
