//! How finely nonlinear forces must be stepped.

use std::f64::consts::PI;

use simgap_model::{Model, damped_modes};

use crate::{Run, SimulateError};

/// Largest ω h of a step that carries nonlinear forces. The trapezoidal treatment of the force is
/// then off by (ω h)²/12, about 0.3 % of the nonlinear part.
const LARGEST_PHASE_STEP: f64 = 0.2;

/// More steps than this between two samples cost more than they bring.
const MOST_SUBSTEPS: usize = 16;

/// Steps between two samples when nonlinear forces act: enough for the natural frequencies below
/// the Nyquist frequency and for the content of the inputs. The linear part needs none.
///
/// ```text
/// substeps = ⌈max(ω_r, ω_u) Δt / 0.2⌉,  ω_u² = Σ (Δu)² / (Δt² Σ (u − ū)²)
/// ```
///
/// # Errors
/// [`SimulateError::Model`] when the model has no modes because M is singular.
pub fn substeps_for(model: &Model, runs: &[Run]) -> Result<usize, SimulateError> {
    if model.is_external() {
        return Ok(1);
    }
    let modes = damped_modes(&hanging(model).tangent_matrices()?)?;
    let mut substeps = 1;
    for run in runs {
        let step = run.time_step_s;
        let natural = modes
            .iter()
            .map(|mode| 2.0 * PI * mode.damped_freq_hz)
            .filter(|omega| omega * step < PI)
            .fold(0.0, f64::max);
        let driven = run
            .inputs
            .iter()
            .map(|u| rms_frequency(u, step))
            .fold(0.0, f64::max);
        let phase = natural.max(driven) * step;
        substeps = substeps.max((phase / LARGEST_PHASE_STEP).ceil() as usize);
    }
    Ok(substeps.clamp(1, MOST_SUBSTEPS))
}

/// The model with every pendulum hanging: an inverted one swings about its rest as fast.
fn hanging(model: &Model) -> Model {
    let mut model = model.clone();
    for pendulum in &mut model.pendulums {
        pendulum.value = pendulum.value.abs();
    }
    model
}

fn rms_frequency(signal: &[f64], step: f64) -> f64 {
    let mean = signal.iter().sum::<f64>() / signal.len().max(1) as f64;
    let power: f64 = signal.iter().map(|u| (u - mean) * (u - mean)).sum();
    let slope: f64 = signal
        .windows(2)
        .map(|w| (w[1] - w[0]) * (w[1] - w[0]))
        .sum();
    if power > 0.0 {
        (slope / power).sqrt() / step
    } else {
        0.0
    }
}
