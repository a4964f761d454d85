//! One number for all rows of Table 4: is the line at f_s/2 − f made by the converter?

use std::f64::consts::TAU;

use crate::error::{all_finite, positive};
use crate::{AlphaError, Oscillator, RateFormula, force_gain};

/// A fault that alternates from sample to sample.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum ConverterFault {
    /// Every other sample τ late, the others τ early: y_n = y(n h + (−1)ⁿ τ).
    AlternatingTiming,
    /// Every other sample too large, the others too small: y_n = (1 + (−1)ⁿ ε) y(n h).
    AlternatingGain,
}

/// The amplitude F₀ of the unknown force at f_s/2 − f, for one excitation.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ObservedLine {
    /// Excitation f, Hz.
    pub excitation_freq_hz: f64,
    /// F₀, N.
    pub force_amplitude: f64,
}

/// One row explained.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ExplanationRow {
    /// Excitation f, Hz.
    pub excitation_freq_hz: f64,
    /// F₀ given, N.
    pub observed: f64,
    /// F₀ that follows from the one number, N.
    pub predicted: f64,
    /// predicted / observed − 1.
    pub relative_error: f64,
}

/// How well one number explains all rows.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Explanation {
    /// The fault assumed.
    pub fault: ConverterFault,
    /// τ in s, or ε.
    pub value: f64,
    /// Standard error of it, from the scatter of the rows.
    pub standard_error: f64,
    /// 1 − Σ (observed − predicted)² / Σ (observed − mean)²; negative when the mean of the rows
    /// would do better.
    pub r_squared: f64,
    /// Largest |relative error| of a row.
    pub worst_relative_error: f64,
    /// Row by row.
    pub rows: Vec<ExplanationRow>,
}

/// Least squares for the one number of an alternating fault.
///
/// A displacement A sin(2πf t), sampled with the fault, carries to first order
///
/// ```text
/// timing:  (−1)ⁿ τ ẏ  →  amplitude 2π f A τ at f_s/2 − f                        (1)
/// gain:    (−1)ⁿ ε y  →  amplitude      A ε at f_s/2 − f                        (2)
/// ```
///
/// and Eq. (3) with the formula's factor D turns it into a force of amplitude
///
/// ```text
/// F₀(f) = |G(f_s/2 − f)| · 2π f A τ    or    |G(f_s/2 − f)| · A ε               (3)
/// ```
///
/// which is linear in the one unknown: F₀ ≈ p g, p = Σ g F₀ / Σ g².                  (4)
///
/// | symbol | argument | unit |
/// |---|---|---|
/// | A | `amplitude` | m |
/// | 1/f_s | `time_step_s` | s |
/// | G | [`force_gain`] | N/m |
///
/// Valid for 2π f τ ≪ 1 and at least two rows with 0 < f < f_s/2.
///
/// # Errors
/// [`AlphaError::Length`] for fewer than two rows, [`AlphaError::Parameter`] out of range.
pub fn explain_lines(
    observed: &[ObservedLine],
    plant: &Oscillator,
    amplitude: f64,
    time_step_s: f64,
    formula: RateFormula,
    fault: ConverterFault,
) -> Result<Explanation, AlphaError> {
    if observed.len() < 2 {
        return Err(AlphaError::Length {
            what: "rows to explain",
            found: observed.len(),
            needed: 2,
        });
    }
    positive("amplitude", amplitude)?;
    let nyquist_hz = 0.5 / positive("time step", time_step_s)?;
    let force: Vec<f64> = observed.iter().map(|row| row.force_amplitude).collect();
    all_finite("force amplitude", &force)?;
    let mut per_unit = Vec::with_capacity(observed.len());
    for row in observed {
        let freq = positive("excitation frequency", row.excitation_freq_hz)?;
        if freq >= nyquist_hz {
            return Err(AlphaError::Parameter {
                name: "excitation frequency",
                found: freq,
                needed: format!("below the Nyquist frequency {nyquist_hz}"),
            });
        }
        let gain = force_gain(plant, formula, nyquist_hz - freq, time_step_s)?.norm();
        per_unit.push(match fault {
            ConverterFault::AlternatingTiming => gain * TAU * freq * amplitude, // (1) (3)
            ConverterFault::AlternatingGain => gain * amplitude,                // (2) (3)
        });
    }
    let square: f64 = per_unit.iter().map(|g| g * g).sum();
    let value = per_unit.iter().zip(&force).map(|(g, f)| g * f).sum::<f64>() / square; // (4)
    Ok(judge(observed, &per_unit, value, square, fault))
}

fn judge(
    observed: &[ObservedLine],
    per_unit: &[f64],
    value: f64,
    square: f64,
    fault: ConverterFault,
) -> Explanation {
    let count = observed.len() as f64;
    let mean = observed.iter().map(|row| row.force_amplitude).sum::<f64>() / count;
    let (mut left, mut total) = (0.0, 0.0);
    let rows: Vec<ExplanationRow> = observed
        .iter()
        .zip(per_unit)
        .map(|(row, g)| {
            let predicted = value * g;
            left += (row.force_amplitude - predicted).powi(2);
            total += (row.force_amplitude - mean).powi(2);
            ExplanationRow {
                excitation_freq_hz: row.excitation_freq_hz,
                observed: row.force_amplitude,
                predicted,
                relative_error: predicted / row.force_amplitude - 1.0,
            }
        })
        .collect();
    Explanation {
        fault,
        value,
        standard_error: (left / (count - 1.0) / square).sqrt(),
        r_squared: 1.0 - left / total,
        worst_relative_error: rows
            .iter()
            .map(|row| row.relative_error.abs())
            .fold(0.0, f64::max),
        rows,
    }
}
