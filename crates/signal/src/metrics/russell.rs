//! Russell's error: magnitude on a logarithmic scale, so that over- and underprediction weigh alike.

use std::f64::consts::PI;

use super::sprague_geers::norms_and_angle;
use crate::SignalError;

/// Russell's magnitude, phase and comprehensive error; all zero for a perfect prediction.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Russell {
    /// Signed logarithmic magnitude error; positive when the prediction is too large.
    pub magnitude: f64,
    /// Angle between the curves over π: 0 in phase, 1 opposite.
    pub phase: f64,
    /// √( π/4 (magnitude² + phase²) ).
    pub comprehensive: f64,
}

/// Russell's error of a prediction.
///
/// ```text
/// A = Σ p²,  B = Σ m²,  C = Σ m p
/// m  = (A - B) / √(A B)
/// RM = sign(m) log10(1 + |m|)
/// RP = 1/π · arccos( C / √(A B) )
/// RC = √( π/4 (RM² + RP²) )
/// ```
///
/// A comprehensive error up to 0.15 was called excellent, up to 0.28 acceptable by the panel of
/// Russell1997b. Reference: Russell1997.
///
/// # Errors
///
/// As [`super::sprague_geers`].
///
/// # Examples
///
/// ```
/// use simgap_signal::metrics::russell;
/// let over = russell(&[1.0, -2.0], &[2.0, -4.0])?;
/// let under = russell(&[2.0, -4.0], &[1.0, -2.0])?;
/// assert!((over.magnitude + under.magnitude).abs() < 1e-15);
/// # Ok::<(), simgap_signal::SignalError>(())
/// ```
pub fn russell(measured: &[f64], predicted: &[f64]) -> Result<Russell, SignalError> {
    let (measured_norm, predicted_norm, angle) = norms_and_angle(measured, predicted)?;
    let ratio = predicted_norm / measured_norm;
    // (A - B)/√(AB) with √(A/B) = ratio.
    let m = ratio - 1.0 / ratio;
    let magnitude = m.signum() * (1.0 + m.abs()).log10();
    let phase = angle / PI;
    let comprehensive = (PI / 4.0 * (magnitude * magnitude + phase * phase)).sqrt();
    Ok(Russell {
        magnitude,
        phase,
        comprehensive,
    })
}
