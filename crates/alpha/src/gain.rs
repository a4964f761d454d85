//! What a differentiation formula does to the unknown force.

use std::f64::consts::TAU;

use faer::c64;
use simgap_integrate::inverse::{Differentiator, exact_transfer, transfer};

use crate::error::positive;
use crate::{AlphaError, Oscillator};

/// How a derivative is taken, seen from the frequency domain.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RateFormula {
    /// A finite-difference formula.
    Scheme(Differentiator),
    /// The exact derivative, iω.
    Exact,
}

impl RateFormula {
    /// The factor D of a derivative, 1/s.
    ///
    /// # Errors
    /// Those of [`transfer`].
    pub fn rate(self, freq_hz: f64, time_step_s: f64) -> Result<c64, AlphaError> {
        Ok(match self {
            Self::Scheme(differentiator) => transfer(differentiator, freq_hz, time_step_s)?,
            Self::Exact => exact_transfer(freq_hz)?,
        })
    }
}

/// Force in α per displacement in the record at one frequency,
///
/// ```text
/// G(f) = m D² + c D + k,    D: the formula's factor at f
/// ```
///
/// | symbol | argument | unit |
/// |---|---|---|
/// | f | `freq_hz` | Hz, up to 1/(2h) |
/// | h | `time_step_s` | s |
/// | G | returned | N/m |
///
/// ```
/// use simgap_alpha::{Oscillator, RateFormula, force_gain};
/// use simgap_integrate::inverse::Differentiator;
/// let plant = Oscillator { mass_kg: 1.0, damping: 0.0, stiffness: 0.0, load: 0.0 };
/// let park = force_gain(&plant, RateFormula::Scheme(Differentiator::Park), 50.0, 0.01)?;
/// let exact = force_gain(&plant, RateFormula::Exact, 50.0, 0.01)?;
/// // (16/(3 π))² and of opposite sign: a factor of 2.88 too much at the Nyquist frequency.
/// assert!((park.re / exact.re + 2.882).abs() < 1e-3);
/// # Ok::<(), simgap_alpha::AlphaError>(())
/// ```
///
/// # Errors
/// Those of the formula.
pub fn force_gain(
    plant: &Oscillator,
    formula: RateFormula,
    freq_hz: f64,
    time_step_s: f64,
) -> Result<c64, AlphaError> {
    Ok(plant.force_per_displacement(formula.rate(freq_hz, time_step_s)?))
}

/// One formula at one frequency, beside the exact derivative.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GainRow {
    /// The formula.
    pub differentiator: Differentiator,
    /// Frequency, Hz.
    pub freq_hz: f64,
    /// |D|/ω, 1 when exact.
    pub rate_ratio: f64,
    /// arg D − π/2, degrees; negative when the derivative comes late.
    pub rate_phase_deg: f64,
    /// |G|/|G exact|, 1 when exact.
    pub force_ratio: f64,
    /// arg G − arg G exact, degrees, in (−180, 180].
    pub force_phase_deg: f64,
}

/// [`force_gain`] of every formula of [`Differentiator::ALL`] at the given frequencies, beside
/// the exact derivative.
///
/// # Errors
/// [`AlphaError::Parameter`] for a frequency that is not positive, and those of the formulas.
pub fn gain_table(
    plant: &Oscillator,
    freqs_hz: &[f64],
    time_step_s: f64,
) -> Result<Vec<GainRow>, AlphaError> {
    let mut rows = Vec::new();
    for differentiator in Differentiator::ALL {
        for freq in freqs_hz {
            let freq_hz = positive("frequency", *freq)?;
            let scheme = RateFormula::Scheme(differentiator);
            let rate = scheme.rate(freq_hz, time_step_s)?;
            let exact_rate = RateFormula::Exact.rate(freq_hz, time_step_s)?;
            let force = force_gain(plant, scheme, freq_hz, time_step_s)?;
            let exact_force = force_gain(plant, RateFormula::Exact, freq_hz, time_step_s)?;
            rows.push(GainRow {
                differentiator,
                freq_hz,
                rate_ratio: rate.norm() / exact_rate.norm(),
                rate_phase_deg: degrees(rate, exact_rate),
                force_ratio: force.norm() / exact_force.norm(),
                force_phase_deg: degrees(force, exact_force),
            });
        }
    }
    Ok(rows)
}

/// Phase of a over b, degrees.
fn degrees(a: c64, b: c64) -> f64 {
    let turned = (a * b.conj()).arg() * 360.0 / TAU;
    if turned <= -180.0 {
        turned + 360.0
    } else {
        turned
    }
}
