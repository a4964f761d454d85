//! What a rebuilt record follows, and the plans of the paper.

use simgap_integrate::inverse::{Differentiator, exact_transfer, transfer};

use crate::error::{not_negative, positive};
use crate::{MoldError, OneDof};

/// Amplitude of the n-th harmonic of the displacement over n⁻² of the fundamental. Table 2 prints
/// which lines there are and not how high; 1 % is **assumed**, low enough to leave the 2 mm
/// stroke as it is and high enough to be seen in a spectrum.
pub const HARMONIC_SHARE: f64 = 0.01;

/// Why the displacement shows a line at 50 − f when it is sampled at 100 Hz.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub enum Reading {
    /// No such line.
    None,
    /// The converter takes every other sample of the displacement late by τ and the others early:
    /// sample n is taken at n h + (−1)ⁿ τ.
    AlternatingTiming {
        /// τ, s.
        timing_error_s: f64,
    },
    /// The mold itself vibrates at base ∓ f: B cos(2πf t) cos(2π base t).
    FlexibleSupport {
        /// B, m: twice the amplitude of each of the two lines.
        line_amplitude: f64,
        /// Middle of the two lines, Hz; 50 in the paper.
        base_hz: f64,
    },
}

/// How (3) of [`RebuildPlan`] takes its derivatives.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub enum Derivative {
    /// D = iω.
    Exact,
    /// The factor of Park's formula at a sampling step.
    Park {
        /// The step, s.
        time_step_s: f64,
    },
}

/// What a rebuilt record follows.
///
/// ```text
/// y(t)  = A sin(ωt) + Σ_n (A s / n²) sin(nωt)   over the lines of Table 2, n > 1     (1)
/// α(t)  = a₀ + (Δα/2) cos(ωt)                   Table 3                              (2)
/// F(t)  = m D²y + c D y + k y + m g − α         Eq. (3), D: the plan's derivative    (3)
/// ```
///
/// Table 3 came out of Park's formula at 0.01 s, which is wrong by some per cent at 6 Hz; so the
/// force that *was* measured follows from the tables with the same formula in (3), and
/// [`published_plan`] puts it there ([`Derivative::Park`]). The force does not depend on the sample
/// rate of the record.
///
/// The samples of y then carry the [`Reading`]; those of F do not, as Table 2 finds no high line
/// in the pressure.
///
/// | symbol | field | unit | source |
/// |---|---|---|---|
/// | ω/2π | `excitation_freq_hz` | Hz | rows of the tables |
/// | A | `amplitude` | m | section 3.1, 2 mm |
/// | s | `harmonic_share` | 1 | **assumed** ([`HARMONIC_SHARE`]) |
/// | n ω/2π | `lines_hz` | Hz | Table 2 |
/// | a₀ | `centre_force` | N | Table 3 |
/// | Δα | `stroke_force` | N | Table 3; its phase, that of the velocity, is **assumed** |
/// | | `noise_rms` | m | **assumed**, none unless asked for |
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct RebuildPlan {
    /// Excitation f, Hz.
    pub excitation_freq_hz: f64,
    /// Amplitude A, m.
    pub amplitude: f64,
    /// Height of the harmonics, 1.
    pub harmonic_share: f64,
    /// Harmonics of Table 2, Hz; the fundamental and lines above the Nyquist frequency are left
    /// out when the record is built.
    pub lines_hz: Vec<f64>,
    /// a₀, N.
    pub centre_force: f64,
    /// max α − min α of the Fourier part, N.
    pub stroke_force: f64,
    /// The derivative through which a₀ and max α − min α were computed.
    pub derivative: Derivative,
    /// Samples per second.
    pub sample_rate_hz: f64,
    /// Length, s.
    pub duration_s: f64,
    /// What makes the line at 50 − f.
    pub reading: Reading,
    /// Standard deviation of the noise on y, m.
    pub noise_rms: f64,
    /// Seed of the noise.
    pub seed: u64,
}

/// The plan for one excitation of the paper, 1 to 6 Hz (the rows Tables 2, 3 and 4 share), without
/// noise and for 20 s.
///
/// # Errors
/// [`MoldError::NoRow`] for any other excitation.
pub fn published_plan(
    excitation_freq_hz: f64,
    sample_rate_hz: f64,
    reading: Reading,
) -> Result<RebuildPlan, MoldError> {
    let no_row = || MoldError::NoRow {
        table: "Table 3",
        found: excitation_freq_hz,
        has: "1, 2, 3, 4, 5, 6 Hz",
    };
    let (table2, table3) = (simgap_tables::table2()?, simgap_tables::table3()?);
    let stated = simgap_tables::stated_values()?;
    let force = table3
        .rows
        .iter()
        .find(|row| row.excitation.si() == excitation_freq_hz)
        .ok_or_else(no_row)?;
    let lines = table2
        .rows
        .iter()
        .find(|row| row.excitation.si() == excitation_freq_hz)
        .ok_or_else(no_row)?;
    Ok(RebuildPlan {
        excitation_freq_hz,
        amplitude: stated.amplitude.si(),
        harmonic_share: HARMONIC_SHARE,
        lines_hz: lines.displacement.lines_hz().to_vec(),
        centre_force: force.centre.si(),
        stroke_force: force.peak_to_peak.si(),
        derivative: Derivative::Park {
            time_step_s: stated.time_step.si(),
        },
        sample_rate_hz,
        duration_s: 20.0,
        reading,
        noise_rms: 0.0,
        seed: 0,
    })
}

/// The amplitude B (m) of the displacement at 50 − f that the printed F₀ of Table 4 asks for, when
/// Park's formula is applied twice at the paper's sampling step:
///
/// ```text
/// B = F₀ / |m D² + c D + k|,     D = D(50 − f) of Park's formula
/// ```
///
/// # Errors
/// [`MoldError::NoRow`] for an excitation Table 4 does not have.
pub fn published_line_amplitude(excitation_freq_hz: f64) -> Result<f64, MoldError> {
    let (table4, stated) = (simgap_tables::table4()?, simgap_tables::stated_values()?);
    let row = table4
        .rows
        .iter()
        .find(|row| row.excitation.si() == excitation_freq_hz)
        .ok_or(MoldError::NoRow {
            table: "Table 4",
            found: excitation_freq_hz,
            has: "1, 2, 3, 4, 5, 6 Hz",
        })?;
    let mold = OneDof::published()?;
    let line_hz = stated.image_base.si() - excitation_freq_hz;
    let park = Derivative::Park {
        time_step_s: stated.time_step.si(),
    };
    let [re, im] = force_per_displacement(&mold, line_hz, park)?;
    Ok(row.amplitude.si() / re.hypot(im))
}

/// m D² + c D + k, real and imaginary part, N/m.
pub(crate) fn force_per_displacement(
    mold: &OneDof,
    freq_hz: f64,
    derivative: Derivative,
) -> Result<[f64; 2], MoldError> {
    let rate = match derivative {
        Derivative::Exact => exact_transfer(freq_hz)?,
        Derivative::Park { time_step_s } => transfer(Differentiator::Park, freq_hz, time_step_s)?,
    };
    let force = rate * rate * mold.mass_kg() + rate * mold.damping() + mold.stiffness();
    Ok([force.re, force.im])
}

/// Whether a record can be built from the plan.
pub(crate) fn check(plan: &RebuildPlan) -> Result<(), MoldError> {
    positive("excitation frequency", plan.excitation_freq_hz)?;
    positive("amplitude", plan.amplitude)?;
    not_negative("harmonic share", plan.harmonic_share)?;
    positive("sample rate", plan.sample_rate_hz)?;
    positive("duration", plan.duration_s)?;
    not_negative("noise", plan.noise_rms)?;
    let finite = |name, value: f64| {
        if value.is_finite() {
            Ok(())
        } else {
            Err(MoldError::Parameter {
                name,
                found: value,
                needed: "finite",
            })
        }
    };
    finite("centre force", plan.centre_force)?;
    finite("stroke force", plan.stroke_force)?;
    match plan.reading {
        Reading::None => Ok(()),
        Reading::AlternatingTiming { timing_error_s } => finite("timing error", timing_error_s),
        Reading::FlexibleSupport {
            line_amplitude,
            base_hz,
        } => {
            finite("line amplitude", line_amplitude)?;
            positive("base frequency", base_hz).map(|_| ())
        }
    }
}
