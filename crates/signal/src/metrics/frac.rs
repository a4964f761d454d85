//! Frequency response assurance criterion.

use crate::{Complex64, SignalError, check};

/// Frequency response assurance criterion of two complex frequency responses.
///
/// ```text
/// FRAC = |Σ_k H_k conj(G_k)|² / ( Σ_k |H_k|² · Σ_k |G_k|² )
/// ```
///
/// | Symbol | Argument | Unit | Shape |
/// |---|---|---|---|
/// | H | `measured` | any | K |
/// | G | `predicted` | any | K |
///
/// 1 for responses of one shape, whatever their (complex) scale; 0 for orthogonal ones. Reference:
/// HeylenLammens1996, Allemang2003.
///
/// # Errors
///
/// [`SignalError::TooShort`], [`SignalError::LengthMismatch`], [`SignalError::NonFinite`];
/// [`SignalError::Flat`] when either response is zero throughout.
///
/// # Examples
///
/// ```
/// use simgap_signal::{Complex64, metrics::frac};
/// let h = [Complex64::new(1.0, 2.0), Complex64::new(-1.0, 0.5)];
/// let g = h.map(|v| v * Complex64::new(0.0, 3.0));
/// assert!((frac(&h, &g)? - 1.0).abs() < 1e-15);
/// # Ok::<(), simgap_signal::SignalError>(())
/// ```
pub fn frac(measured: &[Complex64], predicted: &[Complex64]) -> Result<f64, SignalError> {
    check::same_len("predicted", predicted.len(), "measured", measured.len())?;
    let measured_norm = norm("measured", measured)?;
    let predicted_norm = norm("predicted", predicted)?;
    let product: Complex64 = measured
        .iter()
        .zip(predicted)
        .map(|(h, g)| (h / measured_norm) * (g / predicted_norm).conj())
        .sum();
    Ok(product.norm_sqr())
}

fn norm(what: &'static str, values: &[Complex64]) -> Result<f64, SignalError> {
    let parts: Vec<f64> = values.iter().map(|v| v.norm()).collect();
    check::finite(what, &parts, 1)?;
    let norm = parts.iter().map(|v| v * v).sum::<f64>().sqrt();
    if norm > 0.0 {
        Ok(norm)
    } else {
        Err(SignalError::Flat { what })
    }
}
