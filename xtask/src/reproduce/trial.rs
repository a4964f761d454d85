//! Readings of the lines at 50 − f, each with one number for the six F0 of Table 4.

use simgap_alpha::{RateFormula, force_gain};
use simgap_signal::peaks::Peak;

use super::context::{EXCITATIONS_HZ, PARK};
use super::peaks::two_mass_lines;
use super::{Context, ReproduceError};

/// A reading and what its one number makes of the six F0.
pub(crate) struct Trial {
    pub(crate) name: &'static str,
    /// What the number is, and its unit.
    pub(crate) number: &'static str,
    pub(crate) value: f64,
    /// F0 predicted, N.
    pub(crate) predicted: Vec<f64>,
    pub(crate) r_squared: f64,
    pub(crate) worst_relative_error: f64,
    /// Of the six F0 with one unknown scatter for all of them, nat.
    pub(crate) log_likelihood: f64,
}

/// Least squares for one number: F0 ≈ p g.
fn trial(context: &Context, name: &'static str, number: &'static str, per_unit: &[f64]) -> Trial {
    let observed: Vec<f64> = context
        .table4
        .rows
        .iter()
        .map(|row| row.amplitude.si())
        .collect();
    let count = observed.len() as f64;
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let value = dot(per_unit, &observed) / dot(per_unit, per_unit);
    let predicted: Vec<f64> = per_unit.iter().map(|g| value * g).collect();
    let left: Vec<f64> = observed
        .iter()
        .zip(&predicted)
        .map(|(o, p)| o - p)
        .collect();
    let average = super::context::mean(&observed);
    let about: Vec<f64> = observed.iter().map(|o| o - average).collect();
    let (rest, total) = (dot(&left, &left), dot(&about, &about));
    let relative = left.iter().zip(&observed).map(|(l, o)| (l / o).abs());
    Trial {
        name,
        number,
        value,
        r_squared: 1.0 - rest / total,
        worst_relative_error: relative.fold(0.0, f64::max),
        log_likelihood: -0.5 * count * ((std::f64::consts::TAU * rest / count).ln() + 1.0),
        predicted,
    }
}

/// Name of the reading that the records are rebuilt with.
pub(crate) const TIMING: &str = "alternating or interleaved sampling";
/// Name of the empirical line.
pub(crate) const LINE: &str = "F0 proportional to f";
/// Name of Eq. (4) from rest.
pub(crate) const FROM_REST: &str = "Eq. (4) as printed, from rest";
/// Name of what is flat in f.
pub(crate) const GAIN: &str = "a gain or a carrier times the displacement";

/// Name of a tilt, which grows as f².
pub(crate) const TILT: &str = "a carrier times a tilt, in step with the acceleration";
/// Name of interpolation, which grows as f².
pub(crate) const INTERPOLATION: &str = "interpolation of every other sample";

/// The seven readings, and two that are excluded by their shape.
pub(crate) fn trials(context: &Context) -> Result<Vec<Trial>, ReproduceError> {
    let (step, amplitude) = (context.time_step_s(), context.amplitude());
    let base = context.stated.image_base.si();
    let omega = |freq: f64| std::f64::consts::TAU * freq;
    // Force in α per displacement at 50 − f, through Park's formula.
    let gain = |freq: f64| -> Result<f64, ReproduceError> {
        Ok(force_gain(&context.plant, PARK, base - freq, step)?.norm())
    };
    let each =
        |law: &dyn Fn(f64) -> Result<f64, ReproduceError>| -> Result<Vec<f64>, ReproduceError> {
            EXCITATIONS_HZ.iter().map(|freq| law(*freq)).collect()
        };
    // y_n takes (−1)ⁿ τ ẏ.
    let velocity = each(&|f| Ok(gain(f)? * omega(f) * amplitude))?;
    // Held for two samples, the second one is h late: (−1)ⁿ (x(t) − x(t − h))/2.
    let held = each(&|f| Ok(gain(f)? * amplitude * (0.5 * omega(f) * step).sin()))?;
    // Forces in proportion to f at 50 − f and 50 + f; the second line folds onto the first.
    let vibration = each(&|f| {
        let per_force = |line: f64| -> Result<f64, ReproduceError> {
            Ok(force_gain(&context.plant, RateFormula::Exact, line, step)?
                .norm()
                .recip())
        };
        Ok(gain(f)? * f * (per_force(base - f)? + per_force(base + f)?))
    })?;
    let line = each(&|f| Ok(f))?;
    let rest = from_rest(context)?;
    let displacement = each(&|f| Ok(gain(f)? * amplitude))?;
    // A sensor, or the mold under it, tilts with the force that accelerates: p ÿ of the displacement.
    let tilted = each(&|f| Ok(gain(f)? * amplitude * omega(f) * omega(f)))?;
    // Every other sample is the mean of its neighbours: (−1)ⁿ y (1 − cos ωh)/2.
    let interpolated = each(&|f| Ok(gain(f)? * 0.5 * amplitude * (1.0 - (omega(f) * step).cos())))?;
    Ok(vec![
        trial(context, TIMING, "τ [s]", &velocity),
        trial(
            context,
            "a tone at 50 Hz times the velocity, in the cable",
            "τ [s]",
            &velocity,
        ),
        trial(
            context,
            "a set point held for 20 ms, through the servo",
            "share of the held motion that the servo passes",
            &held,
        ),
        trial(
            context,
            "a real vibration at 50 ∓ f, forces as f",
            "force of each line [N per Hz]",
            &vibration,
        ),
        trial(context, LINE, "N per Hz", &line),
        trial(context, FROM_REST, "scale", &rest),
        trial(context, GAIN, "share", &displacement),
        trial(context, TILT, "displacement for each m/s² [s²]", &tilted),
        trial(
            context,
            INTERPOLATION,
            "scale (1 if it were so)",
            &interpolated,
        ),
    ])
}

/// F0 of the motion of m₁ that Eq. (4) as printed gives from rest: both lines through Park's formula, at the frequency
/// where the paper's sampling shows them.
fn from_rest(context: &Context) -> Result<Vec<f64>, ReproduceError> {
    let rate = context.sample_rate_hz();
    let mut forces = vec![];
    for item in two_mass_lines(context, 0)? {
        let is_mode = |peak: &&Peak| (peak.freq_hz - item.excitation_hz).abs() > 1.0;
        let mut sum = 0.0;
        for peak in item.peaks.iter().filter(is_mode) {
            let shown = if peak.freq_hz > 0.5 * rate {
                rate - peak.freq_hz
            } else {
                peak.freq_hz
            };
            sum += peak.amplitude
                * force_gain(&context.plant, PARK, shown, context.time_step_s())?.norm();
        }
        forces.push(sum);
    }
    Ok(forces)
}

/// The trial of a name.
pub(crate) fn named<'a>(
    trials: &'a [Trial],
    name: &'static str,
) -> Result<&'a Trial, ReproduceError> {
    let found = trials.iter().find(|trial| trial.name == name);
    found.ok_or(ReproduceError::Story("every reading is tried"))
}
