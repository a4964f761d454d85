//! Windows, amplitude spectrum and periodogram.
#![allow(clippy::unwrap_used)]

use std::f64::consts::TAU;

use crate::common::{Noise, cosine, max_diff};
use proptest::prelude::*;
use simgap_signal::spectrum::{periodogram, spectrum};
use simgap_signal::{Complex64, SignalError, Trend, Window};

/// Rounding of transforms of order-one data up to a thousand samples.
const ROUNDING: f64 = 1e-11;

/// The slow and obvious transform.
fn dft(x: &[f64]) -> Vec<Complex64> {
    let n = x.len();
    (0..=n / 2)
        .map(|k| {
            x.iter()
                .enumerate()
                .map(|(i, v)| Complex64::from_polar(*v, -TAU * ((k * i) % n) as f64 / n as f64))
                .sum()
        })
        .collect()
}

#[test]
fn verify_spectrum_is_the_dft_for_any_length() {
    let mut noise = Noise::new(1);
    for n in [2, 3, 4, 5, 7, 8, 12, 31, 64, 97, 100, 125, 210] {
        let x = noise.normals(n);
        let s = spectrum(&x, 7.0, Window::Rectangular, Trend::Keep).unwrap();
        let oracle = dft(&x);
        assert_eq!(s.amplitude.len(), oracle.len());
        for (k, want) in oracle.iter().enumerate() {
            let sides = if k == 0 || 2 * k == n { 1.0 } else { 2.0 };
            let got = Complex64::from_polar(s.amplitude[k] * n as f64 / sides, s.phase_rad[k]);
            assert!(
                (got - want).norm() < ROUNDING,
                "n {n} bin {k}: {got} {want}"
            );
        }
    }
}

#[test]
fn verify_line_on_a_bin_gives_amplitude_and_phase_with_every_window() {
    let (fs, n) = (200.0, 400);
    let x: Vec<f64> = cosine(n, fs, 20.0, 3.0, 0.7)
        .iter()
        .map(|v| v + 5.0)
        .collect();
    for window in Window::ALL {
        let s = spectrum(&x, fs, window, Trend::Mean).unwrap();
        let k = s.nearest_bin(20.0);
        assert_eq!(s.freq_hz[k], 20.0);
        assert!((s.amplitude[k] - 3.0).abs() < ROUNDING, "{window:?}");
        assert!((s.phase_rad[k] - 0.7).abs() < ROUNDING, "{window:?}");
        assert!(s.amplitude[0] < ROUNDING, "{window:?}: the mean is gone");
    }
}

#[test]
fn verify_mean_and_nyquist_lines_are_not_doubled() {
    let x: Vec<f64> = (0..64)
        .map(|i| 2.0 + if i % 2 == 0 { 0.5 } else { -0.5 })
        .collect();
    let s = spectrum(&x, 64.0, Window::Rectangular, Trend::Keep).unwrap();
    assert!((s.amplitude[0] - 2.0).abs() < ROUNDING);
    assert!((s.amplitude[32] - 0.5).abs() < ROUNDING);
    assert_eq!(s.freq_hz[32], 32.0);
}

#[test]
fn val_harris_heinzel_window_figures() {
    // Noise-equivalent bandwidth in bins and scallop loss in dB: Heinzel2002, appendices C and D,
    // given there to four decimals.
    const LAST_DIGIT: f64 = 0.6e-4;
    for (window, bandwidth, scallop_db) in [
        (Window::Rectangular, 1.0, -3.9224),
        (Window::Hann, 1.5, -1.4236),
        (Window::Hamming, 1.3628, -1.7514),
        (Window::BlackmanHarris, 2.0044, -0.8256),
        (Window::FlatTop, 3.7702, -0.0156),
    ] {
        assert!(
            (window.noise_bandwidth_bins() - bandwidth).abs() < LAST_DIGIT,
            "{window:?}"
        );
        let loss = 20.0 * (window.lobe(0.5) / window.lobe(0.0)).log10();
        // The flat top's figure is its worst error within half a bin, not the one at the half.
        let worst = (0..=50)
            .map(|i| 20.0 * (window.lobe(0.01 * f64::from(i)) / window.lobe(0.0)).log10())
            .fold(loss, f64::min);
        assert!(
            (worst - scallop_db).abs() < LAST_DIGIT,
            "{window:?}: {worst}"
        );
    }
}

#[test]
fn verify_window_gains_are_those_of_the_weights() {
    for window in Window::ALL {
        for n in [window.min_len(), 10, 33] {
            let w = window.coefficients(n).unwrap();
            let mean = w.iter().sum::<f64>() / n as f64;
            let square = w.iter().map(|v| v * v).sum::<f64>() / n as f64;
            assert!(
                (mean - window.coherent_gain()).abs() < 1e-14,
                "{window:?} {n}"
            );
            assert!(
                (square - window.power_gain()).abs() < 1e-14,
                "{window:?} {n}"
            );
        }
        assert!(window.coefficients(window.min_len() - 1).is_err());
    }
}

#[test]
fn verify_lobe_is_the_transform_of_the_window() {
    // Periodic weights are not centred: the lobe of the infinite window is met to order 1/N².
    let n = 4096;
    for window in Window::ALL {
        let w = window.coefficients(n).unwrap();
        for offset in [0.0, 0.3, 0.5, 1.0, 1.7, 4.4] {
            let sum: Complex64 = w
                .iter()
                .enumerate()
                .map(|(i, v)| {
                    Complex64::from_polar(*v, TAU * offset * (i as f64 - n as f64 / 2.0) / n as f64)
                })
                .sum();
            let got = sum.re / n as f64;
            assert!(
                (got - window.lobe(offset)).abs() < 1e-6,
                "{window:?} {offset} {got}"
            );
        }
    }
}

#[test]
fn verify_linear_trend_is_removed() {
    let line = cosine(300, 30.0, 3.0, 1.0, 0.2);
    let tilted: Vec<f64> = line
        .iter()
        .enumerate()
        .map(|(i, v)| v + 4.0 - 0.3 * i as f64)
        .collect();
    let (mut a, mut b) = (line, tilted);
    Trend::Linear.remove(&mut a);
    Trend::Linear.remove(&mut b);
    assert!(max_diff(&a, &b) < ROUNDING);
}

#[test]
fn verify_white_noise_density_with_every_window() {
    // Mean of 10^5 samples' worth of periodogram: relative scatter √(2 B/N) < 1 %, four of these.
    let x: Vec<f64> = Noise::new(2)
        .normals(100_000)
        .iter()
        .map(|v| 3.0 * v)
        .collect();
    for window in Window::ALL {
        let p = periodogram(&x, 50.0, window, Trend::Mean).unwrap();
        let power = p.band_power(0.0, 25.0);
        assert!((power / 9.0 - 1.0).abs() < 0.04, "{window:?} {power}");
    }
}

proptest! {
    #[test]
    fn prop_parseval(x in prop::collection::vec(-10.0..10.0f64, 2..200), fs in 0.1..1e4f64) {
        let p = periodogram(&x, fs, Window::Rectangular, Trend::Keep).unwrap();
        let mean_square = x.iter().map(|v| v * v).sum::<f64>() / x.len() as f64;
        prop_assert!((p.band_power(0.0, fs) - mean_square).abs() < 1e-10 * (1.0 + mean_square));
    }

    #[test]
    fn prop_amplitude_scales(x in prop::collection::vec(-1.0..1.0f64, 20..80), c in 0.1..9.0f64) {
        let y: Vec<f64> = x.iter().map(|v| c * v).collect();
        let a = spectrum(&x, 1.0, Window::Hann, Trend::Mean).unwrap();
        let b = spectrum(&y, 1.0, Window::Hann, Trend::Mean).unwrap();
        for (u, v) in a.amplitude.iter().zip(&b.amplitude) {
            prop_assert!((c * u - v).abs() < 1e-12);
        }
    }
}

#[test]
fn verify_bad_input_is_named() {
    let message = |e: SignalError| e.to_string();
    let run = |x: &[f64], fs| spectrum(x, fs, Window::Hann, Trend::Mean).unwrap_err();
    assert_eq!(
        message(run(&[], 1.0)),
        "values has 0 entries, at least 3 are needed"
    );
    assert_eq!(
        message(run(&[1.0, f64::NAN, 1.0], 1.0)),
        "values is NaN at index 1, a finite number is needed"
    );
    assert_eq!(
        message(run(&[1.0; 8], 0.0)),
        "sample_rate_hz is 0, a positive finite number is needed"
    );
}
