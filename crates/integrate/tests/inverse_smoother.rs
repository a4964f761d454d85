//! The smoother against a slow oracle, its stated uncertainty against known noise.
#![allow(clippy::unwrap_used)]

use crate::support::{Normal, largest_difference};
use faer::Mat;
use faer::linalg::solvers::{DenseSolveCore, Solve};
use simgap_integrate::inverse::{
    NoiseModel, SmoothedMotion, fit_noise_model, kalman_smoother, smoother_transfer,
};

const STEP_S: f64 = 0.02;
const STD_M: f64 = 3e-4;
const INTENSITY: f64 = 40.0;

fn transition(h: f64) -> [[f64; 3]; 3] {
    [[1.0, h, h * h / 2.0], [0.0, 1.0, h], [0.0, 0.0, 1.0]]
}

fn process(h: f64, q: f64) -> Mat<f64> {
    let rows = [
        [h.powi(5) / 20.0, h.powi(4) / 8.0, h.powi(3) / 6.0],
        [h.powi(4) / 8.0, h.powi(3) / 3.0, h.powi(2) / 2.0],
        [h.powi(3) / 6.0, h.powi(2) / 2.0, h],
    ];
    Mat::from_fn(3, 3, |i, j| q * rows[i][j])
}

/// A draw of the noise model itself: true states and the measured displacement.
fn draw_record(samples: usize, seed: u64) -> (Vec<[f64; 3]>, Vec<f64>) {
    let mut normal = Normal(seed);
    let factor = process(STEP_S, INTENSITY).llt(faer::Side::Lower).unwrap();
    let lower = factor.L().to_owned();
    let f = transition(STEP_S);
    let mut state = [0.01, -0.2, 1.0];
    let mut states = Vec::new();
    let mut measured = Vec::new();
    for _ in 0..samples {
        states.push(state);
        measured.push(state[0] + STD_M * normal.draw());
        let draw = [normal.draw(), normal.draw(), normal.draw()];
        let mut next = [0.0; 3];
        for i in 0..3 {
            for j in 0..3 {
                next[i] += f[i][j] * state[j] + lower[(i, j)] * draw[j];
            }
        }
        state = next;
    }
    (states, measured)
}

/// The slow and obvious oracle: all states at once by generalised least squares.
/// Minimises Σ (y − x)²/σ² + Σ (s⁺ − F s)ᵀ Q⁻¹ (s⁺ − F s); the inverse Hessian is the covariance.
fn oracle(measured: &[f64]) -> SmoothedMotion {
    let count = measured.len();
    // Scaled state (x, h v, h² a)/σ keeps the Hessian well conditioned.
    let smoothness = INTENSITY * STEP_S.powi(5) / (STD_M * STD_M);
    let weight = process(1.0, smoothness).partial_piv_lu().inverse();
    let f = transition(1.0);
    let mut hessian = Mat::<f64>::zeros(3 * count, 3 * count);
    let mut rhs = Mat::<f64>::zeros(3 * count, 1);
    for n in 0..count {
        hessian[(3 * n, 3 * n)] += 1.0;
        rhs[(3 * n, 0)] += measured[n] / STD_M;
    }
    for n in 0..count - 1 {
        // B = [−F, I] acting on (s_n, s_(n+1)).
        let b = Mat::from_fn(3, 6, |i, j| match j {
            0..=2 => -f[i][j],
            _ => f64::from(u8::from(j - 3 == i)),
        });
        let block = b.transpose() * &weight * &b;
        for i in 0..6 {
            for j in 0..6 {
                hessian[(3 * n + i, 3 * n + j)] += block[(i, j)];
            }
        }
    }
    let factor = hessian.partial_piv_lu();
    let mean = factor.solve(&rhs);
    let covariance = factor.inverse();
    let unit = [STD_M, STD_M / STEP_S, STD_M / STEP_S.powi(2)];
    let pick = |j: usize| (0..count).map(|n| mean[(3 * n + j, 0)] * unit[j]).collect();
    let std = |j: usize| {
        (0..count)
            .map(|n| covariance[(3 * n + j, 3 * n + j)].sqrt() * unit[j])
            .collect()
    };
    SmoothedMotion {
        displacement: pick(0),
        velocity: pick(1),
        acceleration: pick(2),
        displacement_std: std(0),
        velocity_std: std(1),
        acceleration_std: std(2),
    }
}

#[test]
fn verify_smoother_against_all_states_at_once() {
    for samples in [4, 5, 40] {
        let (_, measured) = draw_record(samples, 7);
        let noise = NoiseModel::new(STD_M, INTENSITY).unwrap();
        let found = kalman_smoother(&measured, STEP_S, noise).unwrap();
        let slow = oracle(&measured);
        // The oracle's Hessian has a condition of about 1e7: nine digits of the largest value.
        for (name, a, b) in [
            ("x", &found.displacement, &slow.displacement),
            ("v", &found.velocity, &slow.velocity),
            ("a", &found.acceleration, &slow.acceleration),
            ("std x", &found.displacement_std, &slow.displacement_std),
            ("std v", &found.velocity_std, &slow.velocity_std),
            ("std a", &found.acceleration_std, &slow.acceleration_std),
        ] {
            let size = b.iter().fold(0.0_f64, |top, v| top.max(v.abs()));
            let error = largest_difference(a, b) / size;
            assert!(error < 1e-9, "{name}, {samples} samples: {error:e}");
        }
    }
}

#[test]
fn verify_parabola_passes_unchanged() {
    let values: Vec<f64> = (0..200)
        .map(|n| 2.0 - 0.3 * f64::from(n) + 0.01 * f64::from(n * n))
        .collect();
    let found = kalman_smoother(&values, 1.0, NoiseModel::new(0.1, 1e-4).unwrap()).unwrap();
    // 1e-16 of the largest value, 340, times the length of the recursion.
    assert!(largest_difference(&found.displacement, &values) < 1e-10);
    assert!(found.acceleration.iter().all(|a| (a - 0.02).abs() < 1e-11));
}

/// Errors divided by the stated standard deviation have variance one. 4000 samples, of which about
/// one in ten is independent: the mean square is 1 ± 0.07 (one sigma).
#[test]
fn verify_stated_uncertainty_is_the_true_one() {
    let (states, measured) = draw_record(4000, 11);
    let noise = NoiseModel::new(STD_M, INTENSITY).unwrap();
    let found = kalman_smoother(&measured, STEP_S, noise).unwrap();
    for (j, mean, std) in [
        (0, &found.displacement, &found.displacement_std),
        (1, &found.velocity, &found.velocity_std),
        (2, &found.acceleration, &found.acceleration_std),
    ] {
        let square: f64 = (0..states.len())
            .map(|n| ((mean[n] - states[n][j]) / std[n]).powi(2))
            .sum::<f64>()
            / states.len() as f64;
        assert!((square - 1.0).abs() < 0.2, "component {j}: {square}");
    }
}

/// log density of the third differences, which is what is left of a record when nothing is known
/// of its first state.
fn oracle_log_likelihood(measured: &[f64], noise: NoiseModel) -> f64 {
    let count = measured.len() - 3;
    let q = process(STEP_S, noise.jerk_intensity());
    let sigma = noise.measurement_std();
    let f = transition(STEP_S);
    // Displacement response to unit w_k after m further steps: row one of F^m.
    let mut rows = vec![[1.0, 0.0, 0.0]];
    for m in 0..measured.len() {
        let last = rows[m];
        rows.push(std::array::from_fn(|j| {
            (0..3).map(|i| last[i] * f[i][j]).sum()
        }));
    }
    let difference = [-1.0, 3.0, -3.0, 1.0];
    let total = measured.len();
    let covariance = Mat::from_fn(total, total, |a, b| {
        let mut sum = if a == b { sigma * sigma } else { 0.0 };
        for k in 1..=a.min(b) {
            for i in 0..3 {
                for j in 0..3 {
                    sum += rows[a - k][i] * q[(i, j)] * rows[b - k][j];
                }
            }
        }
        sum
    });
    let contrast = Mat::from_fn(count, total, |r, c| {
        if (r..r + 4).contains(&c) {
            difference[c - r]
        } else {
            0.0
        }
    });
    let spread = &contrast * &covariance * contrast.transpose();
    let data = Mat::from_fn(count, 1, |r, _| {
        (0..4).map(|k| difference[k] * measured[r + k]).sum()
    });
    let factor = spread.llt(faer::Side::Lower).unwrap();
    let lower = factor.L();
    let logs: f64 = (0..count).map(|i| 2.0 * f64::ln(lower[(i, i)])).sum();
    let square = (data.transpose() * factor.solve(&data))[(0, 0)];
    -0.5 * (count as f64 * std::f64::consts::TAU.ln() + logs + square)
}

#[test]
fn verify_likelihood_against_third_differences() {
    let (_, measured) = draw_record(60, 5);
    let fit = fit_noise_model(&measured, STEP_S).unwrap();
    let top = oracle_log_likelihood(&measured, fit.noise);
    // The covariance of third differences of 60 samples has a condition of about 1e6.
    assert!(
        (fit.log_likelihood - top).abs() < 1e-6,
        "{} {top}",
        fit.log_likelihood
    );
    let (std, q) = (fit.noise.measurement_std(), fit.noise.jerk_intensity());
    for (a, b) in [(1.02, 1.0), (1.0 / 1.02, 1.0), (1.0, 1.1), (1.0, 1.0 / 1.1)] {
        let beside = oracle_log_likelihood(&measured, NoiseModel::new(std * a, q * b).unwrap());
        assert!(beside < top, "{a} {b}");
    }
}

#[test]
fn verify_maximum_likelihood_recovers_the_noise() {
    let (_, measured) = draw_record(6000, 3);
    let fit = fit_noise_model(&measured, STEP_S).unwrap();
    assert!(!fit.at_bound);
    // Standard error of σ is about σ/√(2N) = 0.9 %, of log q about ten times that: four of each.
    assert!(
        (fit.noise.measurement_std() / STD_M - 1.0).abs() < 0.04,
        "{fit:?}"
    );
    assert!(
        (fit.noise.jerk_intensity() / INTENSITY).ln().abs() < 0.4,
        "{fit:?}"
    );
}

/// Zero-phase and closed form: gain of the middle of a long record against the two-sided filter.
#[test]
fn verify_smoother_transfer_against_sampled_sines() {
    let noise = NoiseModel::new(STD_M, INTENSITY).unwrap();
    let count = 801;
    let middle = 400;
    for freq_hz in [0.5, 2.0, 5.0, 12.0, 20.0, 25.0] {
        let angle = std::f64::consts::TAU * freq_hz * STEP_S;
        let phase = |n: usize| angle * (n as f64 - middle as f64);
        let cosine: Vec<f64> = (0..count).map(|n| phase(n).cos()).collect();
        let sine: Vec<f64> = (0..count).map(|n| phase(n).sin()).collect();
        let real = kalman_smoother(&cosine, STEP_S, noise).unwrap();
        let imaginary = kalman_smoother(&sine, STEP_S, noise).unwrap();
        let closed = smoother_transfer(noise, freq_hz, STEP_S).unwrap();
        let measured = [
            (real.displacement[middle], imaginary.displacement[middle]),
            (real.velocity[middle], imaginary.velocity[middle]),
            (real.acceleration[middle], imaginary.acceleration[middle]),
        ];
        let size = [1.0, 1.0 / STEP_S, 1.0 / STEP_S.powi(2)];
        for j in 0..3 {
            // The filter forgets over some ten samples; what is left is rounding.
            let error = (closed[j].re - measured[j].0).hypot(closed[j].im - measured[j].1);
            assert!(
                error < 1e-9 * size[j],
                "{freq_hz} Hz, component {j}: {error:e}"
            );
        }
    }
}

#[test]
fn verify_fit_says_when_there_is_no_noise_to_see() {
    let sine: Vec<f64> = (0..500).map(|n| (0.3 * f64::from(n)).sin()).collect();
    assert!(fit_noise_model(&sine, 0.01).unwrap().at_bound);
    let error = fit_noise_model(&[0.0; 50], 0.01).unwrap_err().to_string();
    assert_eq!(
        error,
        "noise of the measured displacement is 0, needed: more than the rounding of the record"
    );
}

/// On a noisy sine the smoother beats both differences by far, in velocity and in acceleration.
#[test]
fn regress_error_on_a_noisy_sine() {
    use simgap_integrate::inverse::{Differentiator, derive_motion};
    let (h, std) = (0.01, 5e-6);
    let omega = std::f64::consts::TAU * 2.0;
    let mut normal = Normal(1);
    let time: Vec<f64> = (0..1000).map(|n| h * f64::from(n)).collect();
    let measured: Vec<f64> = time
        .iter()
        .map(|t| 2e-3 * (omega * t).sin() + std * normal.draw())
        .collect();
    let rms = |found: &[f64], exact: &dyn Fn(f64) -> f64| {
        let sum: f64 = (20..980).map(|n| (found[n] - exact(time[n])).powi(2)).sum();
        (sum / 960.0).sqrt()
    };
    let velocity = |t: f64| 2e-3 * omega * (omega * t).cos();
    let acceleration = |t: f64| -2e-3 * omega * omega * (omega * t).sin();
    let mut table = String::from("2 mm at 2 Hz, noise 5 um, h = 0.01 s: rms error, m/s and m/s2\n");
    for differentiator in Differentiator::ALL {
        let found = derive_motion(differentiator, &measured, h).unwrap();
        let errors = (
            rms(&found.velocity, &velocity),
            rms(&found.acceleration, &acceleration),
        );
        table += &format!(
            "{:<17} {:.3e} {:.3e}\n",
            format!("{differentiator:?}"),
            errors.0,
            errors.1
        );
    }
    let fit = fit_noise_model(&measured, h).unwrap();
    let found = kalman_smoother(&measured, h, fit.noise).unwrap();
    let errors = (
        rms(&found.velocity, &velocity),
        rms(&found.acceleration, &acceleration),
    );
    table += &format!("{:<17} {:.3e} {:.3e}\n", "smoother", errors.0, errors.1);
    table += &format!("fitted noise {:.2e} m", fit.noise.measurement_std());
    insta::assert_snapshot!(table);
}

/// Gain over the exact factor for three strengths of smoothing; the phase is exact everywhere.
#[test]
fn regress_smoother_gain_up_to_nyquist() {
    let h = 0.01_f64;
    let mut table = String::from("h = 0.01 s; gain over exact factor of x, v, a for q h^5/sigma^2");
    table +=
        "\n f Hz                       1e-6                       1e-2                        1e2";
    for freq_hz in [1.0, 2.0, 5.0, 10.0, 20.0, 30.0, 40.0, 49.0] {
        table += &format!("\n{freq_hz:>5}");
        let omega = std::f64::consts::TAU * freq_hz;
        for smoothness in [1e-6, 1e-2, 1e2_f64] {
            let noise = NoiseModel::new(1.0, smoothness / h.powi(5)).unwrap();
            let [x, v, a] = smoother_transfer(noise, freq_hz, h).unwrap();
            // Zero phase, by the symmetry of smoothing: x and a real, v imaginary.
            assert!(
                x.im.abs() < 1e-9 && (v.re / omega).abs() < 1e-9,
                "{freq_hz} {x} {v}"
            );
            assert!((a.im / (omega * omega)).abs() < 1e-9, "{freq_hz} {a}");
            table += &format!(
                "  {:>7.4} {:>7.4} {:>7.4}",
                x.norm(),
                v.norm() / omega,
                a.norm() / omega.powi(2)
            );
        }
    }
    insta::assert_snapshot!(table);
}
