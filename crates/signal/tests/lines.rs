//! Lines at known frequencies, harmonics, images about half the Nyquist frequency.
#![allow(clippy::unwrap_used)]

use crate::common::{Noise, max_diff};
use proptest::prelude::*;
use simgap_signal::SignalError;
use simgap_signal::lines::fit_lines;
use simgap_signal::orders::{fit_harmonics, nyquist_image_lines};
use std::f64::consts::TAU;

/// Rounding of a well conditioned fit of order-one data.
const ROUNDING: f64 = 1e-10;

fn even_times(n: usize, sample_rate_hz: f64) -> Vec<f64> {
    (0..n).map(|i| i as f64 / sample_rate_hz).collect()
}

#[test]
fn verify_lines_are_recovered_from_uneven_times() {
    let mut noise = Noise::new(1);
    let t: Vec<f64> = (0..300)
        .map(|i| 5.0 + 0.01 * (f64::from(i) + noise.uniform()))
        .collect();
    let v: Vec<f64> = t
        .iter()
        .map(|t| {
            0.7 - 0.2 * (t - 5.0)
                + 2.0 * (TAU * 3.3 * t + 0.4).cos()
                + 0.1 * (TAU * 17.9 * t - 2.0).cos()
        })
        .collect();
    let fit = fit_lines(&t, &v, &[3.3, 17.9]).unwrap();
    for (line, (amplitude, phase)) in fit.lines.iter().zip([(2.0, 0.4), (0.1, -2.0)]) {
        assert!((line.amplitude - amplitude).abs() < ROUNDING, "{line:?}");
        assert!((line.phase_rad - phase).abs() < 10.0 * ROUNDING, "{line:?}");
    }
    assert!((fit.trend_per_s + 0.2).abs() < ROUNDING);
    assert!((fit.mean - (0.7 - 0.2 * (fit.mid_time_s - 5.0))).abs() < ROUNDING);
    assert!(fit.residual.iter().all(|e| e.abs() < ROUNDING));
    let again: Vec<f64> = t.iter().map(|&t| fit.value_at(t)).collect();
    assert!(max_diff(&again, &v) < ROUNDING);
}

#[test]
fn verify_standard_errors_of_orthogonal_lines() {
    // Whole periods: var a = var b = 2 s²/N, var mean = s²/N, and amplitude as well as coefficient. The
    // trend is not quite orthogonal to the sine, by 6/(π k)² /2 of the variance at k = 30 periods.
    const TREND: f64 = 1e-3;
    let (n, fs) = (1000, 100.0);
    let v = Noise::new(2).normals(n);
    let fit = fit_lines(&even_times(n, fs), &v, &[3.0, 7.0]).unwrap();
    let want = fit.residual_std * (2.0 / n as f64).sqrt();
    for line in &fit.lines {
        for got in [line.cosine_std, line.sine_std, line.amplitude_std] {
            assert!((got / want - 1.0).abs() < TREND, "{got} {want}");
        }
        assert!((line.phase_std_rad * line.amplitude / want - 1.0).abs() < TREND);
    }
    assert!((fit.mean_std / (fit.residual_std / (n as f64).sqrt()) - 1.0).abs() < TREND);
    assert_eq!(fit.degrees_of_freedom, n - 6);
    assert_eq!(fit.covariance(6, 0), None);
}

#[test]
fn verify_monte_carlo_coverage_of_close_lines() {
    // Two lines 0.7/T apart: strongly correlated coefficients. 2000 runs, binomial scatter of the
    // coverage 0.5 %, three of these.
    const RUNS: usize = 2000;
    const SCATTER: f64 = 0.015;
    let (n, fs) = (100, 50.0);
    let t = even_times(n, fs);
    let freqs = [4.0, 4.35];
    let clean: Vec<f64> = t
        .iter()
        .map(|t| 1.5 * (TAU * freqs[0] * t).cos() - 0.8 * (TAU * freqs[1] * t).sin())
        .collect();
    let mut noise = Noise::new(3);
    let mut hits = [0; 4];
    let (mut empty, mut cross, mut claimed, mut product) = (0.0, 0.0, 0.0, 0.0);
    for _ in 0..RUNS {
        let v: Vec<f64> = clean.iter().map(|c| c + 0.1 * noise.normal()).collect();
        let fit = fit_lines(&t, &v, &freqs).unwrap();
        let [a, b] = [fit.lines[0], fit.lines[1]];
        // 1.985: 97.5 % point of Student's t with 94 degrees of freedom.
        let hit = |error: f64, std: f64| usize::from(error.abs() < 1.985 * std);
        hits[0] += hit(a.cosine - 1.5, a.cosine_std);
        hits[1] += hit(b.sine + 0.8, b.sine_std);
        hits[2] += hit(a.amplitude - 1.5, a.amplitude_std);
        hits[3] += hit(b.phase_rad - std::f64::consts::FRAC_PI_2, b.phase_std_rad);
        cross += (a.cosine - 1.5) * b.cosine;
        let covariance = fit.covariance(2, 4).unwrap();
        claimed += covariance;
        product += (a.cosine_std * b.cosine_std).powi(2) + covariance * covariance;
        empty += fit_lines(&t, &v, &[4.0, 4.35, 11.0]).unwrap().lines[2].chi_square;
    }
    for hit in hits {
        let coverage = hit as f64 / RUNS as f64;
        assert!((coverage - 0.95).abs() < SCATTER, "{hits:?}");
    }
    // Covariance of the cosines of the two lines, against the scatter of the mean of its products.
    assert!(claimed > 6.0 * product.sqrt(), "{claimed} {product}");
    assert!(
        (cross - claimed).abs() < 3.0 * product.sqrt(),
        "{cross} {claimed} {product}"
    );
    // Mean of χ² with 2 degrees of freedom (F with 2 and 92, mean 2.04): scatter 2/√2000 = 0.045.
    assert!(
        (empty / RUNS as f64 - 2.04).abs() < 0.15,
        "{}",
        empty / RUNS as f64
    );
}

#[test]
fn verify_chi_square_is_what_the_line_takes_from_the_residual() {
    // (a, b) C⁻¹ (a, b)ᵀ = (RSS without the line - RSS with it) / s², exactly; 1.3 periods in the record, so
    // that a and b are correlated.
    let t = even_times(60, 60.0);
    let v = Noise::new(6).normals(60);
    let with = fit_lines(&t, &v, &[9.0, 1.3]).unwrap();
    let without = fit_lines(&t, &v, &[9.0]).unwrap();
    let rss = |r: &[f64]| r.iter().map(|e| e * e).sum::<f64>();
    let want = (rss(&without.residual) - rss(&with.residual)) / with.residual_std.powi(2);
    let line = with.lines[1];
    assert!(
        (line.chi_square / want - 1.0).abs() < 1e-9,
        "{} {want}",
        line.chi_square
    );
    let correlation = with.covariance(4, 5).unwrap() / (line.cosine_std * line.sine_std);
    assert!(
        correlation.abs() > 0.1,
        "the test needs correlated coefficients, not {correlation}"
    );
}

#[test]
fn verify_lines_that_cannot_be_told_apart_are_named() {
    let t = even_times(200, 100.0);
    let v = Noise::new(4).normals(200);
    let named = |freqs: &[f64]| fit_lines(&t, &v, freqs).unwrap_err();
    assert_eq!(
        named(&[3.0, 7.0, 3.0]),
        SignalError::NotSeparable { freq_hz: 3.0 }
    );
    // An alias of 30 Hz at fs = 100 Hz, and the Nyquist frequency itself.
    assert_eq!(
        named(&[30.0, 70.0]),
        SignalError::NotSeparable { freq_hz: 70.0 }
    );
    assert_eq!(named(&[50.0]), SignalError::NotSeparable { freq_hz: 50.0 });
    // A ten-thousandth of a period per record is a parabola too flat to see.
    assert_eq!(named(&[5e-5]), SignalError::NotSeparable { freq_hz: 5e-5 });
    assert_eq!(
        named(&[3.0, 3.0]).to_string(),
        "the line at 3 Hz cannot be told from the lines before it, the mean or the trend on these times"
    );
    assert_eq!(
        named(&[-1.0]).to_string(),
        "freqs_hz is -1, a positive finite number is needed"
    );
    assert_eq!(
        fit_lines(&t[..4], &v[..4], &[3.0]).unwrap_err().to_string(),
        "time_s has 4 entries, at least 5 are needed"
    );
}

#[test]
fn verify_harmonics_of_a_square_wave() {
    // N samples a period, half a sample off the jumps: odd harmonics, with their aliases, of amplitude
    // (4/N) / sin(π k/N), which tends to 4/(π k). Even about the middle, so that the trend is zero.
    let t: Vec<f64> = (0..5000).map(|i| (f64::from(i) + 0.5) / 1000.0).collect();
    let v: Vec<f64> = t.iter().map(|t| (TAU * t).cos().signum()).collect();
    let fit = fit_harmonics(&t, &v, 1.0, 7).unwrap();
    for line in &fit.lines {
        let k = line.freq_hz;
        let odd = if k % 2.0 == 1.0 { 1.0 } else { 0.0 };
        let want = odd * 0.004 / (std::f64::consts::PI * k / 1000.0).sin();
        assert!(
            (line.amplitude - want).abs() < ROUNDING,
            "{k} {} {want}",
            line.amplitude
        );
    }
}

#[test]
fn verify_image_of_alternating_gain_is_flat_in_frequency() {
    let (fs, gain_error) = (100.0, 0.03);
    let t = even_times(2000, fs);
    let v: Vec<f64> = t
        .iter()
        .enumerate()
        .map(|(n, t)| {
            let gain = if n % 2 == 0 {
                1.0 + gain_error
            } else {
                1.0 - gain_error
            };
            gain * ((TAU * 2.0 * t).cos() + 0.5 * (TAU * 4.0 * t).sin())
        })
        .collect();
    let images = nyquist_image_lines(&t, &v, fs, 2.0, 3).unwrap();
    for pair in &images.pairs[..2] {
        let (direct, image) = (pair.direct.unwrap(), pair.image.unwrap());
        assert!((image.amplitude / direct.amplitude - gain_error).abs() < ROUNDING);
        assert!((image.freq_hz - (50.0 - 2.0 * pair.order as f64)).abs() < ROUNDING);
    }
    assert!(images.pairs[2].image.unwrap().amplitude < ROUNDING);
}

#[test]
fn verify_images_that_coincide_with_harmonics_are_left_out() {
    let t = even_times(1000, 100.0);
    let v = Noise::new(5).normals(1000);
    // 50 - 5 k is a harmonic of 5 Hz; k = 10 is the Nyquist frequency itself.
    let five = nyquist_image_lines(&t, &v, 100.0, 5.0, 10).unwrap();
    assert!(five.pairs.iter().all(|p| p.image.is_none()));
    assert!(five.pairs[8].direct.is_some() && five.pairs[9].direct.is_none());
    // With few orders the images 45 … 30 Hz stand alone.
    let few = nyquist_image_lines(&t, &v, 100.0, 5.0, 4).unwrap();
    assert!(
        few.pairs
            .iter()
            .all(|p| p.image.is_some() && p.direct.is_some())
    );
    assert_eq!(
        nyquist_image_lines(&t, &v, 100.0, 60.0, 1)
            .unwrap_err()
            .to_string(),
        "excitation_hz is 60 Hz, a value between 0 and 50 Hz is needed"
    );
}

proptest! {
    #[test]
    fn prop_residual_holds_none_of_the_lines(seed in 0u64..1000, f in 1.0..20.0f64) {
        let mut noise = Noise::new(seed);
        let t: Vec<f64> = (0..80).map(|i| 0.02 * (f64::from(i) + 0.5 * noise.uniform())).collect();
        let v = noise.normals(80);
        let freqs = [f, f + 1.7];
        let first = fit_lines(&t, &v, &freqs).unwrap();
        let second = fit_lines(&t, &first.residual, &freqs).unwrap();
        for line in &second.lines {
            prop_assert!(line.amplitude < 1e-11, "{:?}", line);
        }
        prop_assert!(second.mean.abs() < 1e-11 && second.trend_per_s.abs() < 1e-11);
    }
}
