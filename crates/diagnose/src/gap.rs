//! How large the gap is on the check records.

use simgap_effects::{Action, Placed};
use simgap_estimate::{EstimateError, Problem, Weights, fit_initial_states, simulator_at};
use simgap_model::Location;
use simgap_signal::noise::white_noise_std;
use simgap_simulate::Simulator;

use crate::diagnosis::{ChannelGap, Gap};
use crate::input_noise::InputNoise;

/// A nominal gap that stands out of the noise by less than this share of its square is none: what
/// is closed of it would be a ratio of roundings.
const TINY: f64 = 1e-6;

/// Predictions of the check runs by one model, and their nrmse.
pub(crate) struct Prediction {
    /// The model as it predicts each run; none for traces that come from elsewhere.
    pub(crate) simulators: Vec<Simulator>,
    /// For each run and channel, measured minus predicted; zero where the prediction says nothing.
    pub(crate) discrepancy: Vec<Vec<Vec<f64>>>,
    /// Initial state of each run.
    pub(crate) initial: Vec<Vec<f64>>,
    /// For each channel, rms(discrepancy) / std(measured) over all runs.
    pub(crate) nrmse: Vec<f64>,
}

/// Predicts the check runs; only their initial states are estimated.
pub(crate) fn predict(
    check: &Problem,
    effects: &[Placed],
    weights: &Weights,
) -> Result<Prediction, EstimateError> {
    let fit = fit_initial_states(check, effects, weights)?;
    let std = check.output_std();
    let nrmse = fit
        .variance
        .iter()
        .zip(&std)
        .map(|(v, s)| v.sqrt() / s)
        .collect();
    let mut with_effects = check.with_runs(vec![]);
    with_effects.given.extend(effects.iter().cloned());
    let simulators = (0..check.runs.len())
        .map(|run| simulator_at(&with_effects, &fit, run))
        .collect::<Result<_, _>>()?;
    Ok(Prediction {
        simulators,
        discrepancy: fit.discrepancy,
        initial: fit.estimate.initial,
        nrmse,
    })
}

/// Root mean square over the channels.
pub(crate) fn total(nrmse: &[f64]) -> f64 {
    (nrmse.iter().map(|e| e * e).sum::<f64>() / nrmse.len().max(1) as f64).sqrt()
}

/// White measurement noise of each channel over std(measured), from what is left after correction;
/// never more than all of what is left.
pub(crate) fn noise_floor(check: &Problem, effects: &[Placed], corrected: &Prediction) -> Vec<f64> {
    let std = check.output_std();
    noise_variance(&corrected.discrepancy, &stepped(check, effects))
        .into_iter()
        .enumerate()
        .map(|(c, variance)| (variance.sqrt() / std[c]).min(corrected.nrmse[c]))
        .collect()
}

/// Which channels effects store in steps.
pub(crate) fn stepped(problem: &Problem, effects: &[Placed]) -> Vec<bool> {
    let at = |channel: &str| {
        effects.iter().any(|placed| {
            placed.at == Location::Channel(channel.to_string())
                && matches!(placed.action(), Action::Sampling(map) if map.is_stepped())
        })
    };
    let outputs = problem.model.outputs.iter();
    outputs.map(|output| at(&output.channel)).collect()
}

/// Variance of the white noise in each channel of discrepancies, over all runs.
///
/// Where values are stored in steps, noise moves some of them by a step and most not at all: there
/// the robust estimate would be zero. Samples that are clipped, lost or struck hold no noise and say nothing of that of
/// the others.
pub(crate) fn noise_variance(discrepancy: &[Vec<Vec<f64>>], stepped: &[bool]) -> Vec<f64> {
    (0..stepped.len())
        .map(|c| {
            let (mut square, mut count) = (0.0, 0.0);
            for run in discrepancy {
                count += run[c].len() as f64;
                let noisy = match stepped[c] {
                    true => run[c].clone(),
                    false => holding_noise(&run[c]),
                };
                let sigma = match white_noise_std(&noisy) {
                    Ok(noise) if !stepped[c] => noise.std,
                    _ => short_noise(&noisy),
                };
                square += sigma * sigma * noisy.len() as f64;
            }
            square / f64::max(count, 1.0)
        })
        .collect()
}

/// The discrepancies that hold noise: those of clipped, lost or struck samples are zero, or repeat themselves.
fn holding_noise(discrepancy: &[f64]) -> Vec<f64> {
    let repeats = |n: usize, other: Option<usize>| {
        other.is_some_and(|other| discrepancy.get(other) == Some(&discrepancy[n]))
    };
    let holds_noise = |&n: &usize| {
        discrepancy[n] != 0.0 && !repeats(n, n.checked_sub(1)) && !repeats(n, Some(n + 1))
    };
    let held = (0..discrepancy.len()).filter(holds_noise);
    held.map(|n| discrepancy[n]).collect()
}

/// Noise of a run too short for the robust estimates, from its second differences, whose variance is
/// 6 σ² for white noise. What moves from sample to sample counts as noise here.
fn short_noise(values: &[f64]) -> f64 {
    let squares: Vec<f64> = values
        .windows(3)
        .map(|w| (w[0] - 2.0 * w[1] + w[2]).powi(2) / 6.0)
        .collect();
    (squares.iter().sum::<f64>() / squares.len().max(1) as f64).sqrt()
}

/// 1 − sqrt(max(corrected² − floor², 0) / max(nominal² − floor², tiny)).
pub(crate) fn closed(nominal: f64, corrected: f64, floor: f64) -> f64 {
    let left = (corrected * corrected - floor * floor).max(0.0);
    let there = (nominal * nominal - floor * floor).max(TINY * nominal * nominal);
    if left == 0.0 {
        1.0
    } else {
        1.0 - (left / there).sqrt()
    }
}

/// The gap of the predictions by the model as given, with re-estimated parameters and corrected. `input_noise` is
/// [what the noise of the inputs does](crate::input_noise).
pub(crate) fn gap(
    check: &Problem,
    nominal: &Prediction,
    recalibrated: &Prediction,
    (effects, corrected): (&[Placed], &Prediction),
    input_noise: &[InputNoise],
) -> Gap {
    let floor = noise_floor(check, effects, corrected);
    let std = check.output_std();
    let driven: Vec<f64> = input_noise
        .iter()
        .zip(std)
        .zip(&floor)
        .map(|((driven, std), floor)| driven.beyond((floor * std).powi(2)).sqrt() / std)
        .map(|rms| if rms.is_finite() { rms } else { 0.0 })
        .collect();
    let totals = [nominal, recalibrated, corrected].map(|p| total(&p.nrmse));
    let noise = total(&floor);
    Gap {
        metric: "nrmse",
        nominal: totals[0],
        recalibrated: totals[1],
        corrected: totals[2],
        noise_floor: noise,
        input_noise: total(&driven),
        closed: closed(totals[0], totals[2], noise),
        channels: check
            .model
            .outputs
            .iter()
            .enumerate()
            .map(|(c, output)| ChannelGap {
                channel: output.channel.clone(),
                nominal: nominal.nrmse[c],
                recalibrated: recalibrated.nrmse[c],
                corrected: corrected.nrmse[c],
                noise_floor: floor[c],
                input_noise: driven[c],
            })
            .collect(),
    }
}

impl Gap {
    /// The same gap over all noise there is, that of the inputs too, and over `unknown`, what they leave open between
    /// their samples: what a set is judged by.
    pub(crate) fn over_all_noise(&self, unknown: f64) -> Gap {
        let noise_floor = self.noise_floor.hypot(self.input_noise).hypot(unknown);
        Gap {
            noise_floor,
            closed: closed(self.nominal, self.corrected, noise_floor),
            ..self.clone()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verify_clipped_samples_hold_no_noise() {
        let mut word = 7_u64;
        let mut unit = || {
            word = word
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (word >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
        };
        let noise: Vec<f64> = (0..8000).map(|_| 12_f64.sqrt() * unit()).collect();
        // Two thirds of the samples clipped, at a level that is not quite known.
        let clipped = (0..8000).map(|n| if n % 60 < 40 { 1e-3 } else { noise[n] });
        let run = vec![clipped.collect::<Vec<f64>>()];
        let of = |stepped: bool| noise_variance(std::slice::from_ref(&run), &[stepped])[0];
        assert!((3.0 * of(false) - 1.0).abs() < 0.2, "{}", of(false));
        assert!(of(true) > 0.0);
    }

    #[test]
    fn verify_closed_figures_of_the_contract() {
        let value = closed(0.412, 0.021, 0.018);
        assert!(
            (value
                - (1.0
                    - (0.021_f64.powi(2) - 0.018_f64.powi(2)).sqrt()
                        / (0.412_f64.powi(2) - 0.018_f64.powi(2)).sqrt()))
            .abs()
                < 1e-12
        );
        assert_eq!(closed(0.5, 0.1, 0.1), 1.0);
        assert_eq!(closed(0.5, 0.5, 0.0), 0.0);
    }
}
