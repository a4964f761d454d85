//! White-noise level, autocorrelation, effective number of samples.
#![allow(clippy::unwrap_used)]

use crate::common::{Noise, cosine, max_diff};
use simgap_signal::SignalError;
use simgap_signal::correlation::{
    autocorrelation, effective_sample_count, independent_sample_count,
};
use simgap_signal::noise::{noise_std_by_differences, white_noise_std};

#[test]
fn verify_noise_under_a_smooth_signal() {
    // Median of 8000 correlated differences: 1.5 % scatter; of 2000 correlated bins: 2 % of the level;
    // four of the larger.
    const SCATTER: f64 = 0.08;
    let n = 8000;
    for (seed, std) in [(1, 1e-3), (2, 0.1), (3, 2.0)] {
        let mut noise = Noise::new(seed);
        let x: Vec<f64> = cosine(n, 1000.0, 31.0, 2.0, 0.3)
            .iter()
            .enumerate()
            .map(|(i, v)| v + 1e-3 * i as f64 + std * noise.normal())
            .collect();
        let w = white_noise_std(&x).unwrap();
        assert!(
            (w.by_differences / std - 1.0).abs() < SCATTER,
            "{w:?} {std}"
        );
        assert!((w.by_spectrum / std - 1.0).abs() < SCATTER, "{w:?} {std}");
        assert_eq!(w.std, w.by_differences.min(w.by_spectrum));
    }
}

#[test]
fn verify_every_order_of_differences_is_scaled_right() {
    let x = Noise::new(4).normals(20_000);
    for order in 1..=12 {
        let std = noise_std_by_differences(&x, order).unwrap();
        assert!((std - 1.0).abs() < 0.05, "{order} {std}");
    }
    assert!(noise_std_by_differences(&x, 0).is_err());
    assert!(noise_std_by_differences(&x, 13).is_err());
}

#[test]
fn verify_each_estimate_stands_in_for_the_other() {
    let n = 8000;
    // A line at 0.48 fs is noise to the differences, one bin to the spectrum.
    let mut noise = Noise::new(5);
    let line: Vec<f64> = cosine(n, 1.0, 0.48, 1.0, 0.0)
        .iter()
        .map(|v| v + 0.01 * noise.normal())
        .collect();
    let w = white_noise_std(&line).unwrap();
    assert!(w.by_differences > 0.1, "{w:?}");
    assert!((w.std / 0.01 - 1.0).abs() < 0.08, "{w:?}");
    // A spike in 500 samples is noise to the spectrum, seven differences to the other. (At even
    // distances it would be a comb of lines.)
    let spikes: Vec<f64> = (0..n)
        .map(|_| 0.01 * noise.normal() + if noise.uniform() < 0.002 { 1.0 } else { 0.0 })
        .collect();
    let w = white_noise_std(&spikes).unwrap();
    assert!(w.by_spectrum > 0.02, "{w:?}");
    assert!((w.std / 0.01 - 1.0).abs() < 0.08, "{w:?}");
}

#[test]
fn verify_autocorrelation_is_the_slow_one() {
    for n in [2usize, 3, 10, 33, 64] {
        let x = Noise::new(6).normals(n);
        let mean = x.iter().sum::<f64>() / n as f64;
        let sum = |lag: usize| -> f64 {
            (0..n - lag)
                .map(|i| (x[i] - mean) * (x[i + lag] - mean))
                .sum()
        };
        let want: Vec<f64> = (0..n).map(|lag| sum(lag) / sum(0)).collect();
        assert!(max_diff(&autocorrelation(&x, n - 1).unwrap(), &want) < 1e-12);
    }
}

#[test]
fn verify_effective_count_of_first_order_noise() {
    // N_eff = N (1-φ)/(1+φ) of the mean, N (1-φ²)/(1+φ²) of the variance. The estimate scatters by about 10 % at 20000 samples; mean
    // of 20 runs.
    let n = 20_000;
    for phi in [0.0, 0.5, 0.9] {
        let mut noise = Noise::new(7);
        let (mut mean, mut of_variance) = (0.0, 0.0);
        for _ in 0..20 {
            let mut state = 0.0;
            let x: Vec<f64> = (0..n)
                .map(|_| {
                    state = phi * state + noise.normal();
                    state
                })
                .collect();
            mean += effective_sample_count(&x).unwrap() / 20.0;
            of_variance += independent_sample_count(&x).unwrap() / 20.0;
        }
        let want = n as f64 * (1.0 - phi) / (1.0 + phi);
        assert!((mean / want - 1.0).abs() < 0.06, "{phi} {mean} {want}");
        let want = n as f64 * (1.0 - phi * phi) / (1.0 + phi * phi);
        assert!(
            (of_variance / want - 1.0).abs() < 0.02,
            "{phi} {of_variance} {want}"
        );
    }
}

/// A resonance of damping ratio ζ at ω has n = 2 ζ ω T independent samples in its variance, wherever its band lies: the square of its correlation
/// is ½ e^(-2 ζ ω τ).
#[test]
fn verify_independent_samples_of_a_narrow_band() {
    let n = 40_000;
    for angle in [0.05_f64, 0.4, 1.5] {
        let decay = 0.995_f64;
        let mut noise = Noise::new(11);
        let mut mean = 0.0;
        for _ in 0..20 {
            let (mut last, mut before) = (0.0, 0.0);
            let x: Vec<f64> = (0..n)
                .map(|_| {
                    let next =
                        2.0 * decay * angle.cos() * last - decay * decay * before + noise.normal();
                    (before, last) = (last, next);
                    next
                })
                .collect();
            mean += independent_sample_count(&x).unwrap() / 20.0;
        }
        let want = n as f64 * -2.0 * decay.ln();
        assert!((mean / want - 1.0).abs() < 0.1, "{angle} {mean} {want}");
    }
    let line: Vec<f64> = (0..n).map(|i| (0.01 * f64::from(i)).sin()).collect();
    assert!(independent_sample_count(&line).unwrap() < 10.0);
    assert!(independent_sample_count(&[1.0; 7]).is_err());
    assert!(independent_sample_count(&[1.0; 50]).is_err());
}

#[test]
fn verify_alternating_residual_is_worth_no_more_than_its_samples() {
    let x: Vec<f64> = (0..100)
        .map(|i| if i % 2 == 0 { 1.0 } else { -1.0 })
        .collect();
    assert_eq!(effective_sample_count(&x).unwrap(), 100.0);
    let whole = independent_sample_count(&x).unwrap();
    assert!((1.0..=100.0).contains(&whole), "{whole}");
    assert_eq!(
        effective_sample_count(&[2.0; 50]),
        Err(SignalError::Flat { what: "values" })
    );
}
