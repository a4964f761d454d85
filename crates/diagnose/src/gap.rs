//! How large the gap is on the check records.

use simgap_effects::Placed;
use simgap_estimate::{EstimateError, FitOptions, Problem, fit_initial_states, simulator_at};
use simgap_inference::noise_model::{InputNoise, noise_variance, stepped};
use simgap_simulate::Simulator;

use crate::diagnosis::{ChannelGap, Gap};

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
