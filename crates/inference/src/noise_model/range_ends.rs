//! What is left of a channel while its sensor is at an end of its range.
//!
//! ```text
//! y = min(max(h + δ, low), high) + e                                                (1)
//! ln p = −½ n (q − 1 − ln q),   q = max(1, 1/n Σ min(r²/σ², (y − h)²/V))                 (2)
//! ```
//!
//! Of the machine such a sensor shows nothing: neither what the model says of it, h, nor what the model misses, δ. So what is left there,
//! r, is noise of the sensor and the converter alone, and (2) says how much less likely it is with the variance σ² of that noise than with one of
//! its own. The n samples are those of which h is beyond the range, and further from y than δ makes likely, with V the mean
//! square of what is left of the channel. What a discrepancy in its tail brings back within the range counts by that, the second of (2).
//! σ² is told from r where h is furthest away ([`noise_variance`]), to a tenth, and is no less than what the converter rounds off.
//!
//! Where the machine stands against a stop, its displacement is cut off as well, but goes on following the force a little.

use simgap_effects::{Action, Placed};
use simgap_estimate::{EstimateError, Fit, Problem};
use simgap_model::Location;
use simgap_signal::median;

use super::{NOISE_KNOWN, noise_variance, stored_rounding_variance};
use crate::candidate_model::INDISTINGUISHABLE;

/// Samples at an end of a range from which the noise of a sensor is told.
const FEWEST: usize = 8;

/// ln p of (2), over all channels with an effect that gives their sensor a range; zero without one.
///
/// # Errors
/// [`EstimateError`] when the model cannot be propagated.
pub(crate) fn log_likelihood_at_range_ends(
    problem: &Problem,
    fit: &Fit,
) -> Result<f64, EstimateError> {
    let mut log = 0.0;
    for placed in &fit.estimate.effects {
        if let Location::Channel(name) = &placed.at
            && let Action::Sampling(map) = placed.action()
            && let Some(range) = map.range()
            && let Some(channel) = problem.model.output_index(name)
        {
            let samples = without(problem, fit, placed, channel)?;
            let rounding = stored_rounding_variance(problem)[channel];
            log += log_likelihood(&samples, range, rounding);
        }
    }
    Ok(log)
}

/// y and h of every sample of a channel, h without the effect that gives its sensor a range.
fn without(
    problem: &Problem,
    fit: &Fit,
    limit: &Placed,
    channel: usize,
) -> Result<Vec<[f64; 2]>, EstimateError> {
    let is_other = |placed: &&Placed| !std::ptr::eq(*placed, limit);
    let others: Vec<Placed> = fit.estimate.placed().filter(is_other).cloned().collect();
    let mut samples = vec![];
    for (r, (run, initial)) in problem.runs.iter().zip(&fit.estimate.initial).enumerate() {
        let Some(measured) = run.measured.get(channel).and_then(Option::as_deref) else {
            continue;
        };
        let predicted = problem.simulator(&others, r)?.predict(run, initial)?;
        let pairs = measured.iter().zip(&predicted[channel]).enumerate();
        let mut filled = run.filled(channel).peekable();
        let seen = pairs.filter(|(n, _)| filled.next_if_eq(n).is_none());
        samples.extend(seen.map(|(_, (y, h))| [*y, *h]));
    }
    Ok(samples)
}

/// (2) of samples y and h of a channel whose sensor has this range, and is rounded with this variance.
fn log_likelihood(samples: &[[f64; 2]], [low, high]: [f64; 2], rounding: f64) -> f64 {
    let squares = samples
        .iter()
        .map(|[y, h]| (y - h.clamp(low, high)).powi(2));
    let variance = squares.sum::<f64>() / samples.len() as f64;
    // Of each sample at an end: r, and (y − h)²/V.
    let mut at_ends: Vec<[f64; 2]> = vec![];
    for [side, end] in [[-1.0, low], [1.0, high]] {
        let beyond = samples.iter().filter(|[_, h]| side * (h - end) > 0.0);
        let beyond = beyond.map(|[y, h]| [*y, (y - h).powi(2) / variance]);
        let beyond: Vec<[f64; 2]> = beyond
            .filter(|[_, apart]| *apart > 2.0 * INDISTINGUISHABLE)
            .collect();
        let level = median(&mut furthest(&beyond));
        at_ends.extend(beyond.iter().map(|[y, apart]| [y - level, *apart]));
    }
    if at_ends.len() < FEWEST {
        return 0.0;
    }
    let count = at_ends.len() as f64;
    let noise = noise_variance(&[vec![furthest(&at_ends)]], &[rounding > 0.0])[0];
    // Numbers have an end.
    let noise = (NOISE_KNOWN * noise)
        .max(rounding)
        .max(f64::EPSILON * variance);
    let excess = at_ends.iter().map(|[r, apart]| (r * r / noise).min(*apart));
    let excess = (excess.sum::<f64>() / count).max(1.0);
    -0.5 * count * (excess - 1.0 - excess.ln())
}

/// The first value of each pair whose second is no less than the median.
fn furthest(pairs: &[[f64; 2]]) -> Vec<f64> {
    let mut apart: Vec<f64> = pairs.iter().map(|[_, apart]| *apart).collect();
    let half = median(&mut apart);
    let furthest = pairs.iter().filter(|[_, apart]| *apart >= half);
    furthest.map(|[value, _]| *value).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::noise_model::sensor::tests::white;

    const RANGE: [f64; 2] = [-0.6, 0.7];

    /// A swing that a range cuts off, with a model that is 3 % too large and late, and what the sensor adds.
    fn samples(added: impl Fn(usize, f64) -> f64) -> Vec<[f64; 2]> {
        let of_sample = |n: usize| {
            let motion = (0.01 * n as f64).sin();
            let model = 1.03 * (0.01 * n as f64 - 0.02).sin();
            let [low, high] = RANGE;
            [added(n, motion.clamp(low, high)), model]
        };
        (0..6000).map(of_sample).collect()
    }

    #[test]
    fn verify_noise_behind_a_range_costs_nothing() {
        for colour in [0.0, 0.5, 0.9] {
            let mut noise = white(6000);
            for n in 1..noise.len() {
                noise[n] += colour * noise[n - 1];
            }
            let noisy = samples(|n, delivered| delivered + 2e-3 * noise[n]);
            let found = log_likelihood(&noisy, RANGE, 0.0);
            assert!(found > -INDISTINGUISHABLE, "{found} at {colour}");
        }
    }

    #[test]
    fn verify_what_is_cut_off_to_the_last_bit_costs_nothing() {
        let exact = samples(|_, delivered| delivered);
        assert_eq!(log_likelihood(&exact, RANGE, 0.0), 0.0);
        let step = 1e-3;
        let rounded = samples(|_, delivered| (delivered / step).round() * step);
        assert_eq!(log_likelihood(&rounded, RANGE, step * step / 12.0), 0.0);
    }

    #[test]
    fn verify_what_goes_on_moving_was_not_cut_off() {
        let noise = white(6000);
        // A stop that gives way a little, by a few times the noise.
        let pressed = samples(|n, delivered| {
            let beyond = (0.01 * n as f64).sin() - delivered;
            delivered + 0.03 * beyond + 1e-3 * noise[n]
        });
        let found = log_likelihood(&pressed, RANGE, 0.0);
        assert!(found < -100.0, "{found}");
    }

    #[test]
    fn a_range_beyond_reach_says_nothing() {
        let moved = samples(|n, delivered| delivered + 0.1 * (n as f64).sin());
        assert_eq!(log_likelihood(&moved, [-2.0, f64::INFINITY], 0.0), 0.0);
    }
}
