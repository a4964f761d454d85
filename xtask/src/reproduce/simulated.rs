//! Simulations for the figures.

use std::f64::consts::TAU;

use simgap_integrate::{Excitation, Method, Problem, TimeGrid, simulate};
use simgap_model::undamped_modes;
use simgap_mold::{OneDof, STANDARD_GRAVITY, TwoDof};

use super::ReproduceError;

/// Displacement of the mold from rest under a force that depends on time.
pub(crate) fn response(
    mold: &OneDof,
    force_n: &dyn Fn(f64) -> f64,
    time_step_s: f64,
    count: usize,
) -> Result<Vec<f64>, ReproduceError> {
    let drive = |time: f64, force: &mut [f64]| force[0] = force_n(time);
    let problem =
        Problem::new(&mold.model()?.matrices()?)?.with_excitation(Excitation::Function(&drive))?;
    let solution = simulate(
        &problem,
        &TimeGrid::new(0.0, time_step_s, count)?,
        Method::RungeKutta4,
    )?;
    Ok((0..count)
        .map(|n| solution.motion.displacement[(0, n)])
        .collect())
}

/// Displacement of the mold under a sampled pressure force and weight, by Park's method on the
/// force's own samples, from the state the first two displacements tell.
pub(crate) fn driven_response(
    mold: &OneDof,
    pressure_force: &[f64],
    displacement: &[f64],
    time_step_s: f64,
) -> Result<Vec<f64>, ReproduceError> {
    let count = pressure_force.len();
    let weight = mold.mass_kg() * STANDARD_GRAVITY;
    let net = |time: f64, force: &mut [f64]| {
        let at = (time / time_step_s).clamp(0.0, (count - 1) as f64);
        let (low, part) = (at.floor() as usize, at.fract());
        let high = (low + 1).min(count - 1);
        force[0] = (1.0 - part) * pressure_force[low] + part * pressure_force[high] - weight;
    };
    let velocity = (displacement[1] - displacement[0]) / time_step_s;
    let problem = Problem::new(&mold.model()?.matrices()?)?
        .with_initial_state(&[displacement[0]], &[velocity])?
        .with_excitation(Excitation::Function(&net))?;
    let solution = simulate(
        &problem,
        &TimeGrid::new(0.0, time_step_s, count)?,
        Method::Park,
    )?;
    Ok((0..count)
        .map(|n| solution.motion.displacement[(0, n)])
        .collect())
}

/// Motion of the two-mass model from rest, driven by the sine force that moves m₁ by `amplitude`
/// in steady state: displacement of mold and support.
pub(crate) struct TwoMassMotion {
    pub(crate) time_s: Vec<f64>,
    pub(crate) mold: Vec<f64>,
    pub(crate) support: Vec<f64>,
    pub(crate) force_amplitude: f64,
}

/// Runge-Kutta steps in a sample at 500 Hz: 62 steps in a period of the highest mode (57 Hz),
/// which leaves an error below 1e-5 of it in 20 s.
const SUBSTEPS: usize = 4;

pub(crate) fn two_mass_motion(
    mold: &TwoDof,
    amplitude: f64,
    freq_hz: f64,
    sample_rate_hz: f64,
    count: usize,
) -> Result<TwoMassMotion, ReproduceError> {
    let force_amplitude = mold.force_amplitude(amplitude, freq_hz)?;
    if mold.dampings() == [0.0; 3] {
        return undamped_motion(mold, force_amplitude, freq_hz, sample_rate_hz, count);
    }
    let drive = |time: f64, force: &mut [f64]| {
        force[0] = force_amplitude * (TAU * freq_hz * time).sin();
        force[1] = 0.0;
    };
    let problem =
        Problem::new(&mold.model()?.matrices()?)?.with_excitation(Excitation::Function(&drive))?;
    let fine = SUBSTEPS as f64 * sample_rate_hz;
    let grid = TimeGrid::new(0.0, fine.recip(), SUBSTEPS * (count - 1) + 1)?;
    let motion = simulate(&problem, &grid, Method::RungeKutta4)?.motion;
    let every = |dof: usize| {
        (0..count)
            .map(|n| motion.displacement[(dof, SUBSTEPS * n)])
            .collect()
    };
    Ok(TwoMassMotion {
        time_s: (0..count).map(|n| n as f64 / sample_rate_hz).collect(),
        mold: every(0),
        support: every(1),
        force_amplitude,
    })
}

/// The same in closed form, for a model without damping,
///
/// ```text
/// y = Σ_r φ_r φ_1r F (sin ωt − (ω/ω_r) sin ω_r t) / (ω_r² − ω²)
/// ```
fn undamped_motion(
    mold: &TwoDof,
    force_amplitude: f64,
    freq_hz: f64,
    sample_rate_hz: f64,
    count: usize,
) -> Result<TwoMassMotion, ReproduceError> {
    let modes = undamped_modes(&mold.model()?.matrices()?)?;
    let omega = TAU * freq_hz;
    let time_s: Vec<f64> = (0..count).map(|n| n as f64 / sample_rate_hz).collect();
    let every = |dof: usize| {
        let at = |t: &f64| {
            (0..2)
                .map(|r| {
                    let natural = modes.natural_freq_rad[r];
                    let part = modes.mode_shape[(dof, r)] * modes.mode_shape[(0, r)];
                    part * force_amplitude / (natural * natural - omega * omega)
                        * ((omega * t).sin() - omega / natural * (natural * t).sin())
                })
                .sum()
        };
        time_s.iter().map(at).collect::<Vec<f64>>()
    };
    Ok(TwoMassMotion {
        mold: every(0),
        support: every(1),
        time_s: time_s.clone(),
        force_amplitude,
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    /// Largest difference between the closed form and Runge and Kutta's method with next to no damping, m, in one second.
    fn off_closed_form(sample_rate_hz: f64) -> f64 {
        let mold = TwoDof::published(1.0).unwrap();
        let count = sample_rate_hz as usize;
        let bare = two_mass_motion(&mold, 2e-3, 1.0, sample_rate_hz, count).unwrap();
        let damped = mold.with_damping([1e-3, 0.0, 0.0]).unwrap();
        let stepped = two_mass_motion(&damped, 2e-3, 1.0, sample_rate_hz, count).unwrap();
        let pairs = bare.mold.iter().zip(&stepped.mold);
        pairs.fold(0.0, |off, (a, b)| f64::max(off, (a - b).abs()))
    }

    #[test]
    fn verify_the_closed_form() {
        let (coarse, fine) = (off_closed_form(500.0), off_closed_form(1000.0));
        // Fourth order: a step of half the length leaves a sixteenth.
        let order = (coarse / fine).log2();
        assert!((order - 4.0).abs() < 0.1, "order {order}");
        // 40 µm of ringing at 57 Hz, turned by ω (ωh)⁴/120 in a second.
        let omega = TAU * 57.0;
        let turned = omega * (omega / 4000.0).powi(4) / 120.0;
        assert!(fine < 40e-6 * turned, "{fine}");
    }
}
