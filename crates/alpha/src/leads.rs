//! What printed numbers imply about the plant. Closed forms; each names what it assumes.

use std::f64::consts::TAU;

use faer::c64;

use crate::error::positive;
use crate::{AlphaError, Oscillator, RateFormula, force_gain};

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

/// The unknown force that a differentiation formula makes by itself, peak to peak, of a plant
/// that Eq. (3) describes perfectly and that moves as A sin(2πf t):
///
/// ```text
/// Δα = 2 A |G(f) − G_exact(f)|,    G = m D² + c D + k
/// ```
///
/// ```
/// use simgap_alpha::{Oscillator, RateFormula, leads};
/// use simgap_integrate::inverse::Differentiator;
/// let plant = Oscillator { mass_kg: 1.0, damping: 0.0, stiffness: 0.0, load: 0.0 };
/// let park = RateFormula::Scheme(Differentiator::Park);
/// // Gain (ωh)²/6 too large, twice: 2 A ω² (ωh)²/3.
/// let made = leads::formula_stroke(&plant, park, 1.0, 1.0 / std::f64::consts::TAU, 0.01)?;
/// assert!((made / (2.0 * 1e-4 / 3.0) - 1.0).abs() < 0.02);
/// # Ok::<(), simgap_alpha::AlphaError>(())
/// ```
///
/// # Errors
/// Those of [`force_gain`], [`AlphaError::Parameter`] for an amplitude that is not positive.
pub fn formula_stroke(
    plant: &Oscillator,
    formula: RateFormula,
    amplitude: f64,
    freq_hz: f64,
    time_step_s: f64,
) -> Result<f64, AlphaError> {
    let error = formula_error(plant, formula, freq_hz, time_step_s)?;
    Ok(2.0 * positive("amplitude", amplitude)? * error.norm())
}

/// [`damping_share`] with the formula's own error taken into account: the Δc / c for which
///
/// ```text
/// | G(f) − G_exact(f) + iω Δc | = Δα / (2 A)
/// ```
///
/// The larger of two solutions; `None` where there is none: the formula's error in phase with
/// displacement is then already more than the force, and damping alone cannot be the cause.
///
/// # Errors
/// As [`damping_share`] and [`formula_stroke`].
pub fn damping_share_through(
    plant: &Oscillator,
    formula: RateFormula,
    peak_to_peak: f64,
    amplitude: f64,
    freq_hz: f64,
    time_step_s: f64,
) -> Result<Option<f64>, AlphaError> {
    let per_amplitude =
        0.5 * positive("peak to peak", peak_to_peak)? / positive("amplitude", amplitude)?;
    let omega_c = TAU * positive("frequency", freq_hz)? * positive("damping", plant.damping)?;
    let error = formula_error(plant, formula, freq_hz, time_step_s)?;
    let rest = per_amplitude * per_amplitude - error.re * error.re;
    Ok((rest >= 0.0).then(|| (rest.sqrt() - error.im) / omega_c))
}

fn formula_error(
    plant: &Oscillator,
    formula: RateFormula,
    freq_hz: f64,
    time_step_s: f64,
) -> Result<c64, AlphaError> {
    let with = force_gain(plant, formula, freq_hz, time_step_s)?;
    Ok(with - force_gain(plant, RateFormula::Exact, freq_hz, time_step_s)?)
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
