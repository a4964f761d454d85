//! What printed numbers imply about the plant. Closed forms; each names what it assumes.

use std::f64::consts::TAU;

use crate::AlphaError;
use crate::error::positive;

/// Share of the damping that a force in phase with velocity stands for,
///
/// ```text
/// Δc / c = (Δα/2) / (c · 2π f A)
/// ```
///
/// if the whole Fourier part of the unknown force, peak to peak Δα, is a damping error of a
/// motion of amplitude A. It is an upper bound when the part has other phases or harmonics.
///
/// | symbol | argument | unit |
/// |---|---|---|
/// | Δα | `peak_to_peak` | N |
/// | c | `damping` | N s/m |
/// | A | `amplitude` | m |
/// | f | `freq_hz` | Hz |
///
/// ```
/// let share = simgap_alpha::leads::damping_share(4191.30, 313_779.0, 0.002, 1.0)?;
/// assert!((share - 0.531).abs() < 1e-3);
/// # Ok::<(), simgap_alpha::AlphaError>(())
/// ```
///
/// # Errors
/// [`AlphaError::Parameter`] for an argument that is not positive.
pub fn damping_share(
    peak_to_peak: f64,
    damping: f64,
    amplitude: f64,
    freq_hz: f64,
) -> Result<f64, AlphaError> {
    let force = 0.5 * positive("peak to peak", peak_to_peak)?;
    let velocity = TAU * positive("frequency", freq_hz)? * positive("amplitude", amplitude)?;
    Ok(force / (positive("damping", damping)? * velocity))
}

/// The damping ratio at which the damped frequency is a given one: ζ = √(1 − (f_d/f_n)²).
///
/// ```
/// let ratio = simgap_alpha::leads::damping_ratio_of_damped_freq(2.5222, 2.499)?;
/// assert!((ratio - 0.1353).abs() < 1e-3);
/// # Ok::<(), simgap_alpha::AlphaError>(())
/// ```
///
/// # Errors
/// [`AlphaError::Parameter`] unless 0 < f_d ≤ f_n.
pub fn damping_ratio_of_damped_freq(
    natural_freq_hz: f64,
    damped_freq_hz: f64,
) -> Result<f64, AlphaError> {
    let ratio = positive("damped frequency", damped_freq_hz)?
        / positive("natural frequency", natural_freq_hz)?;
    if ratio > 1.0 {
        return Err(AlphaError::Parameter {
            name: "damped frequency",
            found: damped_freq_hz,
            needed: format!("not above the natural frequency {natural_freq_hz}"),
        });
    }
    Ok((1.0 - ratio * ratio).sqrt())
}

/// The mass at which the natural frequency is a given one: m = k / (2π f)², kg.
///
/// ```
/// let mass = simgap_alpha::leads::mass_of_natural_freq(8_287_639.0, 2.499)?;
/// assert!((mass - 33_615.4).abs() < 0.1);
/// # Ok::<(), simgap_alpha::AlphaError>(())
/// ```
///
/// # Errors
/// [`AlphaError::Parameter`] for an argument that is not positive.
pub fn mass_of_natural_freq(stiffness: f64, natural_freq_hz: f64) -> Result<f64, AlphaError> {
    let omega = TAU * positive("natural frequency", natural_freq_hz)?;
    Ok(positive("stiffness", stiffness)? / (omega * omega))
}
