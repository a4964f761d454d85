//! Gain and phase of the differentiators, in closed form.

use faer::c64;

use super::differentiator::Differentiator;
use super::smoother::NoiseModel;
use crate::error::{IntegrateError, Result, check_time_step};

/// What a finite-difference formula does to a sampled sine, away from the ends of the record.
///
/// ```text
/// y_n = exp(i ω h n)   ->   ẏ_n = H y_n,      H = (1/h) Σ_k c_k exp(i k ω h)
/// ```
///
/// | symbol | argument | unit |
/// |---|---|---|
/// | ω / 2π | `freq_hz` | Hz, up to Nyquist 1/(2h); periodic beyond |
/// | h | `time_step_s` | s |
/// | H | returned; gain is its modulus, phase its argument | 1/s |
/// | k, c_k | [`Differentiator::weights`] | |
///
/// The exact factor is [`exact_transfer`].
///
/// # Errors
///
/// [`IntegrateError::TimeStep`]; [`IntegrateError::Parameter`] when the frequency is not finite.
///
/// ```
/// use simgap_integrate::inverse::{Differentiator, transfer};
/// let nyquist = transfer(Differentiator::Park, 50.0, 0.01)?;
/// assert!((nyquist.re - 1600.0 / 3.0).abs() < 1e-9 && nyquist.im.abs() < 1e-9);
/// # Ok::<(), simgap_integrate::IntegrateError>(())
/// ```
pub fn transfer(differentiator: Differentiator, freq_hz: f64, time_step_s: f64) -> Result<c64> {
    let angle = phase_per_sample(freq_hz, time_step_s)?;
    let sum: c64 = differentiator
        .weights()
        .into_iter()
        .map(|(offset, weight)| weight * unit(offset as f64 * angle))
        .sum();
    Ok(sum / time_step_s)
}

/// The factor iω of an exact derivative.
///
/// # Errors
///
/// [`IntegrateError::Parameter`] when the frequency is not finite.
///
/// ```
/// let factor = simgap_integrate::inverse::exact_transfer(50.0)?;
/// assert!((factor.im - 314.159_265).abs() < 1e-6);
/// # Ok::<(), simgap_integrate::IntegrateError>(())
/// ```
pub fn exact_transfer(freq_hz: f64) -> Result<c64> {
    check_freq(freq_hz)?;
    Ok(c64::new(0.0, std::f64::consts::TAU * freq_hz))
}

/// What [`kalman_smoother`](super::kalman_smoother) does to a sampled sine far from the ends:
/// factors for displacement (1), velocity (1/s) and acceleration (1/s²).
///
/// The smoother is the two-sided Wiener filter of its noise model. With z = exp(iωh), the
/// transition matrix F and the noise covariance Q of [`NoiseModel`],
///
/// ```text
/// u(z) = (z I − F)⁻¹        S = u Q uᴴ        H_j = S_j1 / (S_11 + σ²)
/// ```
///
/// The displacement passes with phase zero and gain S_11/(S_11 + σ²) < 1.
///
/// # Errors
///
/// [`IntegrateError::TimeStep`]; [`IntegrateError::Parameter`] when the frequency is not finite.
///
/// ```
/// use simgap_integrate::inverse::{NoiseModel, smoother_transfer};
/// let noise = NoiseModel::new(1e-6, 1.0)?;
/// let [displacement, velocity, _] = smoother_transfer(noise, 1.0, 0.001)?;
/// assert!((displacement.re - 1.0).abs() < 1e-3 && (velocity.im - 6.283).abs() < 0.01);
/// # Ok::<(), simgap_integrate::IntegrateError>(())
/// ```
pub fn smoother_transfer(noise: NoiseModel, freq_hz: f64, time_step_s: f64) -> Result<[c64; 3]> {
    let angle = phase_per_sample(freq_hz, time_step_s)?;
    if angle == 0.0 {
        // The integrator chain has infinite power at rest: a constant passes unchanged.
        return Ok([c64::new(1.0, 0.0), c64::new(0.0, 0.0), c64::new(0.0, 0.0)]);
    }
    let (transition, covariance) = super::smoother::unit_step_model(noise.smoothness(time_step_s));
    // Rows of u by back substitution: (z − 1) u_j − Σ_(k>j) F_jk u_k = e_j.
    let pivot = unit(angle) - 1.0;
    let mut u = [[c64::new(0.0, 0.0); 3]; 3];
    for j in (0..3).rev() {
        for column in 0..3 {
            let mut sum = c64::new(if j == column { 1.0 } else { 0.0 }, 0.0);
            for k in j + 1..3 {
                sum += transition[j][k] * u[k][column];
            }
            u[j][column] = sum / pivot;
        }
    }
    let spectrum = |j: usize| -> c64 {
        let mut sum = c64::new(0.0, 0.0);
        for a in 0..3 {
            for b in 0..3 {
                sum += u[j][a] * covariance[a][b] * u[0][b].conj();
            }
        }
        sum
    };
    // In the units of the model (σ = 1, h = 1), back to m, s.
    let total = spectrum(0).re + 1.0;
    Ok([
        spectrum(0) / total,
        spectrum(1) / (total * time_step_s),
        spectrum(2) / (total * time_step_s * time_step_s),
    ])
}

/// exp(i angle).
fn unit(angle: f64) -> c64 {
    c64::new(angle.cos(), angle.sin())
}

/// ω h in radians.
fn phase_per_sample(freq_hz: f64, time_step_s: f64) -> Result<f64> {
    check_time_step(time_step_s)?;
    check_freq(freq_hz)?;
    Ok(std::f64::consts::TAU * freq_hz * time_step_s)
}

fn check_freq(freq_hz: f64) -> Result<()> {
    if freq_hz.is_finite() {
        Ok(())
    } else {
        Err(IntegrateError::Parameter {
            name: "freq_hz",
            found: freq_hz,
            needed: "finite",
        })
    }
}
