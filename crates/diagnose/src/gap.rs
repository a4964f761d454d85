//! How large the gap is on the check records.

use simgap_effects::Placed;
use simgap_estimate::{EstimateError, FitOptions, Problem, fit_initial_states, simulator_at};
use simgap_inference::noise_model::{InputNoise, noise_variance, stepped};
use simgap_simulate::Simulator;

use crate::diagnosis::{ChannelGap, Gap};

/// A gap that stands out of the noise by less than this share of its square is none: what is closed
/// of it, or is left, would be a ratio of roundings.
const TINY: f64 = 1e-6;

/// Predictions of the check runs by one model, and their nrmse.
pub(crate) struct Prediction {
    /// The model as it predicts each run; none for traces that come from elsewhere.
    pub(crate) simulators: Vec<Simulator>,
    /// For each run and channel, measured minus predicted; zero where the prediction says nothing.
    pub(crate) discrepancy: Vec<Vec<Vec<f64>>>,
    /// Initial state of each run.
    pub(crate) initial: Vec<Vec<f64>>,
    /// The effects that have values of each run's own.
    pub(crate) own: Vec<Placed>,
    /// For each channel, rms(discrepancy) / std(measured) over all runs.
    pub(crate) nrmse: Vec<f64>,
}

/// Predicts the check runs; only their initial states are estimated.
pub(crate) fn predict(
    check: &Problem,
    effects: &[Placed],
    weights: &FitOptions,
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
        own: fit.estimate.effects,
        nrmse,
    })
}

/// Root mean square over the channels.
pub(crate) fn total(nrmse: &[f64]) -> f64 {
    (nrmse.iter().map(|e| e * e).sum::<f64>() / nrmse.len().max(1) as f64).sqrt()
}

/// Share of what a model leaves, rms over the channels, that another would close if it were true: 1 − √(1 − d²/r²), where r
/// is what the first leaves above the noise and d how far apart the two predict.
pub(crate) fn closed_if_true(
    std: &[f64],
    (first, left): (&Prediction, f64),
    other: &Prediction,
) -> f64 {
    let apart = std.iter().enumerate().map(|(c, std)| {
        let runs = first.discrepancy.iter().zip(&other.discrepancy);
        let (mut sum, mut count) = (0.0, 0);
        for (one, other) in runs {
            let pairs = one[c].iter().zip(&other[c]);
            sum += pairs.map(|(one, other)| (one - other).powi(2)).sum::<f64>();
            count += one[c].len();
        }
        (sum / count.max(1) as f64).sqrt() / std
    });
    let apart = total(&apart.collect::<Vec<f64>>());
    let share = apart / left.max(f64::MIN_POSITIVE);
    1.0 - (1.0 - share * share).max(0.0).sqrt()
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

/// 1 − sqrt(max(corrected² − floor², 0) / max(nominal² − floor², tiny)).
pub(crate) fn closed(nominal: f64, corrected: f64, floor: f64) -> f64 {
    let left = corrected * corrected - floor * floor;
    let there = (nominal * nominal - floor * floor).max(TINY * nominal * nominal);
    match left > TINY * corrected * corrected {
        true => 1.0 - (left / there).sqrt(),
        false => 1.0,
    }
}

impl Gap {
    /// What [`Gap::closed`] is where nominal parameters are re-estimated and no effect is added.
    #[must_use]
    pub fn closed_by_parameters(&self) -> f64 {
        closed(self.nominal, self.recalibrated, self.noise_floor)
    }
}

/// The gap of the predictions by the model as given, with re-estimated parameters and corrected. `input_noise` is what the noise of the
/// inputs does.
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

#[cfg(test)]
mod tests {
    use super::*;

    /// What is left is the sum of two orthogonal parts of 0.3 and 0.4: a model that predicts the second leaves 0.3 of 0.5.
    #[test]
    fn verify_what_a_true_model_would_close() {
        let leaves = |channel: Vec<f64>| Prediction {
            own: vec![],
            simulators: vec![],
            nrmse: vec![(channel.iter().map(|d| d * d).sum::<f64>() / 4.0).sqrt() / 2.0],
            discrepancy: vec![vec![channel]],
            initial: vec![],
        };
        let first = leaves(vec![1.4, 0.2, -1.4, -0.2]);
        let other = leaves(vec![0.6, -0.6, -0.6, 0.6]);
        assert!((first.nrmse[0] - 0.5).abs() < 1e-12);
        assert!((other.nrmse[0] - 0.3).abs() < 1e-12);
        let without = (&first, total(&first.nrmse));
        assert!((closed_if_true(&[2.0], without, &other) - 0.4).abs() < 1e-12);
        assert!(closed_if_true(&[2.0], without, &first).abs() < 1e-12);
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
        assert_eq!(closed(0.5, 0.1 * (1.0 + f64::EPSILON), 0.1), 1.0);
        assert_eq!(closed(0.5, 0.5, 0.0), 0.0);
    }
}
