//! Sprague-Geers error: magnitude and phase apart.

use std::f64::consts::PI;

use crate::{SignalError, check};

/// Sprague-Geers magnitude, phase and comprehensive error; all zero for a perfect prediction.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SpragueGeers {
    /// Relative excess of the predicted over the measured root mean square (signed).
    pub magnitude: f64,
    /// Angle between the curves over π: 0 in phase, 0.5 a quarter period, 1 opposite.
    pub phase: f64,
    /// √(magnitude² + phase²).
    pub comprehensive: f64,
}

/// Sprague-Geers error of a prediction.
///
/// ```text
/// I_mm = Σ m²,  I_pp = Σ p²,  I_mp = Σ m p
/// M = √(I_pp / I_mm) - 1
/// P = 1/π · arccos( I_mp / √(I_mm I_pp) )
/// C = √(M² + P²)
/// ```
///
/// The phase does not depend on the scale of the prediction. Reference: SpragueGeers2004, in the
/// form of Schwer2007.
///
/// # Errors
///
/// [`SignalError::TooShort`], [`SignalError::LengthMismatch`], [`SignalError::NonFinite`];
/// [`SignalError::Flat`] when either curve is zero throughout (the angle does not exist).
///
/// # Examples
///
/// ```
/// use simgap_signal::metrics::sprague_geers;
/// let error = sprague_geers(&[1.0, -2.0, 3.0], &[1.2, -2.4, 3.6])?;
/// assert!((error.magnitude - 0.2).abs() < 1e-12 && error.phase < 1e-7);
/// # Ok::<(), simgap_signal::SignalError>(())
/// ```
pub fn sprague_geers(measured: &[f64], predicted: &[f64]) -> Result<SpragueGeers, SignalError> {
    let (measured_norm, predicted_norm, angle) = norms_and_angle(measured, predicted)?;
    let magnitude = predicted_norm / measured_norm - 1.0;
    let phase = angle / PI;
    Ok(SpragueGeers {
        magnitude,
        phase,
        comprehensive: magnitude.hypot(phase),
    })
}

/// √Σm², √Σp² and the angle between the two curves as vectors.
pub(super) fn norms_and_angle(
    measured: &[f64],
    predicted: &[f64],
) -> Result<(f64, f64, f64), SignalError> {
    check::pair(measured, predicted, 1)?;
    let norm = |x: &[f64]| x.iter().map(|v| v * v).sum::<f64>().sqrt();
    let (m, p) = (norm(measured), norm(predicted));
    if m == 0.0 {
        return Err(SignalError::Flat { what: "measured" });
    }
    if p == 0.0 {
        return Err(SignalError::Flat { what: "predicted" });
    }
    let dot: f64 = measured
        .iter()
        .zip(predicted)
        .map(|(a, b)| (a / m) * (b / p))
        .sum();
    Ok((m, p, dot.clamp(-1.0, 1.0).acos()))
}
