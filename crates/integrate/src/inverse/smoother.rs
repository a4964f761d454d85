//! Fixed-interval smoother of one measured displacement (Rauch, Tung and Striebel).
//!
//! Everything inside runs in the units of the model, h = 1 and σ = 1, with the state
//! (x, h ẋ, h² ẍ)/σ. Only one number is then left, the smoothness λ = q h⁵ / σ².

use super::estimate::Estimate;
use super::flat_start::start;
use super::matrix3::{Matrix, apply, multiply, solve_right, transpose};
use crate::error::{IntegrateError, Result, check_finite, check_length, check_time_step};

/// Least number of samples: three fix the state, the fourth is the first that can surprise.
pub(super) const LEAST_SAMPLES: usize = 4;

/// What the smoother assumes about motion and sensor.
///
/// ```text
/// d³x/dt³ = w(t),   E[w(t) w(s)] = q δ(t − s)        white jerk
/// y_n = x(nh) + e_n,   E[e_n²] = σ²                  white measurement noise
/// ```
///
/// Over one step, exactly,
///
/// ```text
///     ⎡1  h  h²/2⎤         ⎡h⁵/20  h⁴/8  h³/6⎤
/// F = ⎢0  1  h   ⎥   Q = q ⎢h⁴/8   h³/3  h²/2⎥
///     ⎣0  0  1   ⎦         ⎣h³/6   h²/2  h   ⎦
/// ```
///
/// | symbol | field | unit |
/// |---|---|---|
/// | σ | `measurement_std` | m |
/// | q | `jerk_intensity` | m²/s⁵ |
///
/// The displacement it gives is the smoothing spline of degree five that minimises
/// Σ (y_n − x_n)²/σ² + ∫ (d³x/dt³)² dt / q (Wahba 1978).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NoiseModel {
    measurement_std: f64,
    jerk_intensity: f64,
}

impl NoiseModel {
    /// Both must be finite and greater than zero.
    ///
    /// # Errors
    ///
    /// [`IntegrateError::Parameter`].
    ///
    /// ```
    /// use simgap_integrate::inverse::NoiseModel;
    /// assert!(NoiseModel::new(1e-6, 10.0).is_ok());
    /// assert!(NoiseModel::new(0.0, 10.0).is_err());
    /// ```
    pub fn new(measurement_std: f64, jerk_intensity: f64) -> Result<Self> {
        for (name, found) in [
            ("measurement_std", measurement_std),
            ("jerk_intensity", jerk_intensity),
        ] {
            if !(found.is_finite() && found > 0.0) {
                return Err(IntegrateError::Parameter {
                    name,
                    found,
                    needed: "finite and greater than 0",
                });
            }
        }
        Ok(Self {
            measurement_std,
            jerk_intensity,
        })
    }

    /// σ, m.
    #[must_use]
    pub fn measurement_std(self) -> f64 {
        self.measurement_std
    }

    /// q, m²/s⁵.
    #[must_use]
    pub fn jerk_intensity(self) -> f64 {
        self.jerk_intensity
    }

    /// λ = q h⁵ / σ²: large follows every sample, small bends as little as it can.
    #[must_use]
    pub fn smoothness(self, time_step_s: f64) -> f64 {
        self.jerk_intensity * time_step_s.powi(5) / self.measurement_std.powi(2)
    }
}

/// Motion estimated from the whole record, with its standard deviations.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SmoothedMotion {
    /// m, one per sample.
    pub displacement: Vec<f64>,
    /// m/s.
    pub velocity: Vec<f64>,
    /// m/s².
    pub acceleration: Vec<f64>,
    /// Standard deviation of the displacement, m.
    pub displacement_std: Vec<f64>,
    /// Standard deviation of the velocity, m/s.
    pub velocity_std: Vec<f64>,
    /// Standard deviation of the acceleration, m/s².
    pub acceleration_std: Vec<f64>,
}

/// Displacement, velocity and acceleration from a noisy uniformly sampled displacement, each
/// sample estimated from the whole record.
///
/// A Kalman filter forwards and the Rauch-Tung-Striebel recursion backwards for the state
/// s = (x, ẋ, ẍ), m = F s, with the model of [`NoiseModel`]:
///
/// ```text
/// s_n|N = s_n|n + G (s_(n+1)|N − F s_n|n),      G = P_n|n Fᵀ P_(n+1)|n⁻¹            (1)
/// P_n|N = P_n|n + G (P_(n+1)|N − P_(n+1)|n) Gᵀ                                      (2)
/// ```
///
/// Nothing is assumed about the initial state: it has an exactly flat prior, and the first three
/// samples determine it.
///
/// | symbol | argument | unit | shape |
/// |---|---|---|---|
/// | y | `measured` | m | samples ≥ 4 |
/// | h | `time_step_s` | s | |
///
/// The standard deviations hold as far as the noise model holds; obtain one from the record by
/// [`fit_noise_model`](super::fit_noise_model).
///
/// # Errors
///
/// [`IntegrateError::TimeStep`], [`IntegrateError::TooFewSamples`],
/// [`IntegrateError::NotFinite`]; [`IntegrateError::Parameter`] when q h⁵/σ² is beyond 1e±30,
/// where the recursion has no digits left.
///
/// ```
/// use simgap_integrate::inverse::{NoiseModel, kalman_smoother};
/// let fall: Vec<f64> = (0..50).map(|n| 4.905 * (0.01 * f64::from(n)).powi(2)).collect();
/// let motion = kalman_smoother(&fall, 0.01, NoiseModel::new(1e-6, 1.0)?)?;
/// assert!(motion.acceleration.iter().all(|a| (a - 9.81).abs() < 1e-6));
/// # Ok::<(), simgap_integrate::IntegrateError>(())
/// ```
///
/// References: Rauch, Tung and Striebel 1965 (`rauch1965`); Wahba 1978 (`wahba1978`).
pub fn kalman_smoother(
    measured: &[f64],
    time_step_s: f64,
    noise: NoiseModel,
) -> Result<SmoothedMotion> {
    check_record(measured, time_step_s)?;
    let smoothness = noise.smoothness(time_step_s);
    if !(SMOOTHNESS_RANGE.0..=SMOOTHNESS_RANGE.1).contains(&smoothness) {
        return Err(IntegrateError::Parameter {
            name: "jerk_intensity * time_step_s^5 / measurement_std^2",
            found: smoothness,
            needed: "between 1e-30 and 1e30",
        });
    }
    let sigma = noise.measurement_std;
    let scaled: Vec<f64> = measured.iter().map(|y| y / sigma).collect();
    let smoothed = smooth(&scaled, smoothness);
    let unit = [sigma, sigma / time_step_s, sigma / time_step_s.powi(2)];
    let mean = |j: usize| smoothed.iter().map(|(s, _)| s[j] * unit[j]).collect();
    let std = |j: usize| {
        smoothed
            .iter()
            .map(|(_, p)| p[j][j].max(0.0).sqrt() * unit[j])
            .collect()
    };
    Ok(SmoothedMotion {
        displacement: mean(0),
        velocity: mean(1),
        acceleration: mean(2),
        displacement_std: std(0),
        velocity_std: std(1),
        acceleration_std: std(2),
    })
}

/// Range of λ in which the recursion is sound in double precision.
const SMOOTHNESS_RANGE: (f64, f64) = (1e-30, 1e30);

pub(super) fn check_record(measured: &[f64], time_step_s: f64) -> Result<()> {
    check_time_step(time_step_s)?;
    check_length("the measured displacement", measured.len(), LEAST_SAMPLES)?;
    check_finite("the measured displacement", measured)
}

/// F and Q for h = 1 and q = λ.
pub(super) fn unit_step_model(smoothness: f64) -> (Matrix, Matrix) {
    let transition = [[1.0, 1.0, 0.5], [0.0, 1.0, 1.0], [0.0, 0.0, 1.0]];
    let shape = [
        [1.0 / 20.0, 1.0 / 8.0, 1.0 / 6.0],
        [1.0 / 8.0, 1.0 / 3.0, 1.0 / 2.0],
        [1.0 / 6.0, 1.0 / 2.0, 1.0],
    ];
    (
        transition,
        shape.map(|row| row.map(|entry| smoothness * entry)),
    )
}

/// Filtered estimate of one sample and the prediction it was corrected from.
struct Filtered {
    estimate: Estimate,
    prediction: Estimate,
}

/// Prediction to the next sample: F s and F P Fᵀ + Q.
pub(super) fn predict(estimate: &Estimate, transition: &Matrix, process: &Matrix) -> Estimate {
    let mut covariance = multiply(&multiply(transition, &estimate.1), &transpose(transition));
    for i in 0..3 {
        for j in 0..3 {
            covariance[i][j] += process[i][j];
        }
    }
    (apply(transition, &estimate.0), covariance)
}

/// Correction by one sample of unit noise, in Joseph's form, which keeps P positive.
/// Also returns the innovation and its variance.
pub(super) fn correct(prediction: &Estimate, measured: f64) -> (Estimate, f64, f64) {
    let (state, p) = prediction;
    let innovation = measured - state[0];
    let variance = p[0][0] + 1.0;
    let gain = [p[0][0] / variance, p[1][0] / variance, p[2][0] / variance];
    let mut keep = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    for i in 0..3 {
        keep[i][0] -= gain[i];
    }
    let mut covariance = multiply(&multiply(&keep, p), &transpose(&keep));
    let mut mean = *state;
    for i in 0..3 {
        mean[i] += gain[i] * innovation;
        for j in 0..3 {
            covariance[i][j] += gain[i] * gain[j];
        }
    }
    ((mean, covariance), innovation, variance)
}

/// Filter forwards, smooth backwards, in units of the model.
fn smooth(scaled: &[f64], smoothness: f64) -> Vec<Estimate> {
    let (transition, process) = unit_step_model(smoothness);
    let start = start([scaled[0], scaled[1], scaled[2]], &process);
    let mut filtered = vec![Filtered {
        estimate: start.estimates[2],
        prediction: start.estimates[2],
    }];
    let mut current = start.estimates[2];
    for &measured in &scaled[3..] {
        let prediction = predict(&current, &transition, &process);
        current = correct(&prediction, measured).0;
        filtered.push(Filtered {
            estimate: current,
            prediction,
        });
    }
    // Backwards over samples N−1 .. 2, then 1 and 0 through their covariance with sample 2.
    let mut smoothed = vec![current];
    for pair in filtered.windows(2).rev() {
        let cross = multiply(&pair[0].estimate.1, &transpose(&transition));
        current = step_back(&pair[0].estimate, &cross, &pair[1].prediction, &current);
        smoothed.push(current);
    }
    let at_two = current;
    for k in [1, 0] {
        smoothed.push(step_back(
            &start.estimates[k],
            &start.cross[k],
            &start.estimates[2],
            &at_two,
        ));
    }
    smoothed.reverse();
    smoothed
}

/// Equations (1) and (2): carries what was learnt about a later state to an earlier one.
/// `cross` is the covariance of the earlier with the later state before smoothing.
fn step_back(earlier: &Estimate, cross: &Matrix, before: &Estimate, after: &Estimate) -> Estimate {
    let gain = solve_right(cross, &before.1);
    let mut change = [[0.0; 3]; 3];
    let mut shift = [0.0; 3];
    for i in 0..3 {
        shift[i] = after.0[i] - before.0[i];
        for j in 0..3 {
            change[i][j] = after.1[i][j] - before.1[i][j];
        }
    }
    let moved = apply(&gain, &shift);
    let spread = multiply(&multiply(&gain, &change), &transpose(&gain));
    let (mut mean, mut covariance) = *earlier;
    for i in 0..3 {
        mean[i] += moved[i];
        for j in 0..3 {
            covariance[i][j] += spread[i][j];
        }
    }
    (mean, covariance)
}
