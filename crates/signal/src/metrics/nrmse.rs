//! Normalised root mean square error.

use crate::{SignalError, check};

/// Root mean square of the discrepancy over the standard deviation of the measurement.
///
/// ```text
/// NRMSE = √( 1/N Σ (m_n - p_n)² ) / √( 1/N Σ (m_n - m̄)² )
/// ```
///
/// | Symbol | Argument | Unit | Shape |
/// |---|---|---|---|
/// | m | `measured` | any | N |
/// | p | `predicted` | that of m | N |
///
/// 0 is perfect; 1 is what the mean of the measurement as prediction reaches.
///
/// # Errors
///
/// [`SignalError::TooShort`] below 2 samples, [`SignalError::LengthMismatch`],
/// [`SignalError::NonFinite`], [`SignalError::Flat`] for a constant measurement.
///
/// # Examples
///
/// ```
/// use simgap_signal::metrics::nrmse;
/// assert_eq!(nrmse(&[1.0, -1.0], &[0.0, 0.0])?, 1.0);
/// # Ok::<(), simgap_signal::SignalError>(())
/// ```
pub fn nrmse(measured: &[f64], predicted: &[f64]) -> Result<f64, SignalError> {
    check::pair(measured, predicted, 2)?;
    if measured.iter().all(|&m| m == measured[0]) {
        return Err(SignalError::Flat { what: "measured" });
    }
    let n = measured.len() as f64;
    let mean = measured.iter().sum::<f64>() / n;
    let spread: f64 = measured.iter().map(|m| (m - mean).powi(2)).sum();
    let error: f64 = measured
        .iter()
        .zip(predicted)
        .map(|(m, p)| (m - p).powi(2))
        .sum();
    if spread > 0.0 {
        Ok((error / spread).sqrt())
    } else {
        Err(SignalError::Flat { what: "measured" })
    }
}

/// Root of the mean square of the values of the channels.
///
/// ```text
/// NRMSE = √( 1/C Σ_c NRMSE_c² )
/// ```
///
/// # Errors
///
/// [`SignalError::TooShort`] without channels, [`SignalError::NonFinite`].
///
/// # Examples
///
/// ```
/// use simgap_signal::metrics::nrmse_over_channels;
/// assert!((nrmse_over_channels(&[0.3, 0.4])? - 0.125f64.sqrt()).abs() < 1e-15);
/// # Ok::<(), simgap_signal::SignalError>(())
/// ```
pub fn nrmse_over_channels(channel_nrmse: &[f64]) -> Result<f64, SignalError> {
    check::finite("channel_nrmse", channel_nrmse, 1)?;
    let sum: f64 = channel_nrmse.iter().map(|v| v * v).sum();
    Ok((sum / channel_nrmse.len() as f64).sqrt())
}
