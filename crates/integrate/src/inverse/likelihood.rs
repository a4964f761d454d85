//! Noise parameters of the smoother by maximum likelihood.

use super::flat_start::start;
use super::smoother::{NoiseModel, check_record, correct, predict, unit_step_model};
use crate::error::{IntegrateError, Result};

/// A noise model fitted to a record.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MaximumLikelihood {
    /// The fitted σ and q.
    pub noise: NoiseModel,
    /// Logarithm of the likelihood at the fit, the first three samples used up by the initial state.
    pub log_likelihood: f64,
    /// The likelihood still rises at the end of the searched range of λ: the record shows no noise
    /// (upper end) or no motion beyond a parabola (lower end), and the fit is only a bound.
    pub at_bound: bool,
}

/// Range of log10 λ searched: at the lower end the smoother averages over about λ^(−1/6) = 2000
/// samples, at the upper end the measurement noise is 1e-4 of one step's surprise.
const LOG10_SMOOTHNESS_RANGE: (f64, f64) = (-20.0, 8.0);

/// Coarse steps in log10 λ that bracket the maximum.
const BRACKET_STEP: f64 = 1.0;

/// Width in log10 λ to which golden section narrows the bracket: 0.02 % of λ, hundreds of times
/// less than its own uncertainty in any record of under a million samples.
const GOLDEN_WIDTH: f64 = 1e-4;

/// σ and q of [`NoiseModel`] from the record alone, by maximum likelihood.
///
/// With the innovations ν_n and their variances S_n (in units of σ²) of the Kalman filter for
/// λ = q h⁵/σ², and N − 3 of them,
///
/// ```text
/// σ²(λ) = (1/(N−3)) Σ ν_n² / S_n                                                   (1)
/// log L(λ) = −(N−3)/2 (log(2π σ²) + 1) − ½ Σ log S_n                               (2)
/// ```
///
/// Equation (1) is the best σ for a given λ, so one number is left; (2) is bracketed on a grid of
/// one decade and refined by golden section.
///
/// # Errors
///
/// [`IntegrateError::TimeStep`], [`IntegrateError::TooFewSamples`], [`IntegrateError::NotFinite`];
/// [`IntegrateError::Parameter`] when the record is an exact parabola, in which there is no noise
/// to measure.
///
/// ```
/// use simgap_integrate::inverse::fit_noise_model;
/// let noisy: Vec<f64> = (0..400)
///     .map(|n| (0.05 * f64::from(n)).sin() + 1e-3 * (f64::from(n * n) * 1.7).sin())
///     .collect();
/// let fit = fit_noise_model(&noisy, 0.01)?;
/// assert!((0.5e-3..1e-3).contains(&fit.noise.measurement_std()) && !fit.at_bound);
/// # Ok::<(), simgap_integrate::IntegrateError>(())
/// ```
pub fn fit_noise_model(measured: &[f64], time_step_s: f64) -> Result<MaximumLikelihood> {
    check_record(measured, time_step_s)?;
    let objective = |log10_smoothness: f64| concentrated(measured, 10f64.powf(log10_smoothness)).0;
    let (low, high) = LOG10_SMOOTHNESS_RANGE;
    let grid = ((high - low) / BRACKET_STEP).round() as usize;
    let mut best = (low, f64::NEG_INFINITY);
    for k in 0..=grid {
        let at = low + k as f64 * BRACKET_STEP;
        let value = objective(at);
        if value > best.1 {
            best = (at, value);
        }
    }
    let refined = golden_section(
        objective,
        (best.0 - BRACKET_STEP).max(low),
        (best.0 + BRACKET_STEP).min(high),
    );
    let smoothness = 10f64.powf(refined);
    let (log_likelihood, variance) = concentrated(measured, smoothness);
    let measurement_std = variance.sqrt();
    let spread = measured.iter().fold(0.0_f64, |top, y| top.max(y.abs()));
    // Below the rounding of the values themselves, what is left over is not noise.
    if measurement_std.is_nan() || measurement_std <= spread * f64::EPSILON {
        return Err(IntegrateError::Parameter {
            name: "noise of the measured displacement",
            found: measurement_std,
            needed: "more than the rounding of the record",
        });
    }
    let jerk_intensity = smoothness * variance / time_step_s.powi(5);
    Ok(MaximumLikelihood {
        noise: NoiseModel::new(measurement_std, jerk_intensity)?,
        log_likelihood,
        at_bound: refined - low < BRACKET_STEP || high - refined < BRACKET_STEP,
    })
}

/// Equations (2) and (1): log likelihood and σ² at λ.
fn concentrated(measured: &[f64], smoothness: f64) -> (f64, f64) {
    let (transition, process) = unit_step_model(smoothness);
    let mut current = start([measured[0], measured[1], measured[2]], &process).estimates[2];
    let (mut squares, mut logs) = (0.0, 0.0);
    for &value in &measured[3..] {
        let prediction = predict(&current, &transition, &process);
        let (corrected, innovation, variance) = correct(&prediction, value);
        current = corrected;
        squares += innovation * innovation / variance;
        logs += variance.ln();
    }
    let count = (measured.len() - 3) as f64;
    let sigma_squared = squares / count;
    let log_likelihood =
        -0.5 * count * ((std::f64::consts::TAU * sigma_squared).ln() + 1.0) - 0.5 * logs;
    (log_likelihood, sigma_squared)
}

/// Place of the maximum of a function with one peak between `low` and `high`.
fn golden_section(objective: impl Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    let ratio = (5.0_f64.sqrt() - 1.0) / 2.0;
    let mut left = high - ratio * (high - low);
    let mut right = low + ratio * (high - low);
    let (mut at_left, mut at_right) = (objective(left), objective(right));
    while high - low > GOLDEN_WIDTH {
        if at_left > at_right {
            high = right;
            (right, at_right) = (left, at_left);
            left = high - ratio * (high - low);
            at_left = objective(left);
        } else {
            low = left;
            (left, at_left) = (right, at_right);
            right = low + ratio * (high - low);
            at_right = objective(right);
        }
    }
    0.5 * (low + high)
}
