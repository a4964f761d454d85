//! Averaged spectra and frequency responses.
#![allow(clippy::unwrap_used)]

use crate::common::{Noise, max_diff};
use simgap_signal::frf::frf;
use simgap_signal::spectrum::periodogram;
use simgap_signal::welch::{WelchOptions, cross_spectra, welch};
use simgap_signal::{Complex64, Trend, Window};
use std::f64::consts::TAU;

/// Rounding of sums of a few hundred order-one terms.
const ROUNDING: f64 = 1e-12;

#[test]
fn verify_welch_is_the_mean_of_the_periodograms() {
    let x = Noise::new(1).normals(1000);
    for (segment_len, overlap, window, trend) in [
        (100, 0.0, Window::Hann, Trend::Mean),
        (101, 0.5, Window::BlackmanHarris, Trend::Linear),
        (64, 0.75, Window::Hamming, Trend::Keep),
        (1000, 0.5, Window::Rectangular, Trend::Mean),
    ] {
        let options = WelchOptions {
            segment_len,
            overlap,
            window,
            trend,
        };
        let got = welch(&x, 20.0, &options).unwrap();
        let step = (segment_len as f64 * (1.0 - overlap)).round() as usize;
        let mut want = vec![0.0; segment_len / 2 + 1];
        let mut count = 0.0;
        for start in (0..=x.len() - segment_len).step_by(step) {
            let part = periodogram(&x[start..start + segment_len], 20.0, window, trend).unwrap();
            want.iter_mut()
                .zip(&part.density)
                .for_each(|(w, p)| *w += p);
            count += 1.0;
        }
        want.iter_mut().for_each(|w| *w /= count);
        assert_eq!(got.segments as f64, count);
        assert!(max_diff(&got.density, &want) < ROUNDING, "{segment_len}");
    }
}

#[test]
fn verify_effective_averages_are_the_scatter_of_the_bins() {
    // 2048 bins of white noise, 4 of them correlated under a Hann window: 2 % scatter of the standard
    // deviation, four of these.
    let x = Noise::new(2).normals(4096 * 40);
    for (overlap, window) in [
        (0.0, Window::Hann),
        (0.5, Window::Hann),
        (0.75, Window::Hann),
        (0.5, Window::Rectangular),
    ] {
        let options = WelchOptions {
            segment_len: 4096,
            overlap,
            window,
            trend: Trend::Mean,
        };
        let p = welch(&x, 2.0, &options).unwrap();
        let inner = &p.density[4..p.density.len() - 4];
        let mean = inner.iter().sum::<f64>() / inner.len() as f64;
        let variance =
            inner.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / (inner.len() - 1) as f64;
        let scatter = variance.sqrt() / mean * p.effective_averages.sqrt();
        println!(
            "{overlap} {window:?}: {} {} {scatter}",
            p.segments, p.effective_averages
        );
        assert!(
            (scatter - 1.0).abs() < 0.08,
            "{overlap} {window:?} {scatter}"
        );
        // Density of unit white noise at fs = 2 Hz is 1 per Hz.
        assert!((mean - 1.0).abs() < 0.02, "{mean}");
    }
}

#[test]
fn verify_cross_spectrum_sign_and_size() {
    // y is x late by 3 samples: S_xy / S_xx = e^{-i 2π f 3/fs}, but for the ends of the segments.
    let x = Noise::new(3).normals(100_000);
    let y: Vec<f64> = (0..x.len())
        .map(|n| if n < 3 { 0.0 } else { x[n - 3] })
        .collect();
    let s = cross_spectra(&x, &y, 100.0, &WelchOptions::new(1024)).unwrap();
    let own = welch(&x, 100.0, &WelchOptions::new(1024)).unwrap();
    assert!(max_diff(&s.xx, &own.density) < ROUNDING);
    for k in (10..500).step_by(49) {
        let want = Complex64::from_polar(s.xx[k], -TAU * s.freq_hz[k] * 0.03);
        // The 3 of 1024 samples that leave a segment: about √(2·3/1024/195) of it.
        assert!(
            (s.xy[k] - want).norm() < 0.03 * s.xx[k],
            "{k} {} {want}",
            s.xy[k]
        );
    }
}

/// y = 2 x_n + x_{n-1} and its response.
fn filtered(x: &[f64]) -> Vec<f64> {
    (0..x.len())
        .map(|n| 2.0 * x[n] + if n > 0 { x[n - 1] } else { 0.0 })
        .collect()
}

fn response(freq_hz: f64, sample_rate_hz: f64) -> Complex64 {
    Complex64::new(2.0, 0.0) + Complex64::from_polar(1.0, -TAU * freq_hz / sample_rate_hz)
}

#[test]
fn verify_random_error_of_h1() {
    let fs = 100.0;
    let mut noise = Noise::new(4);
    let x = noise.normals(200_000);
    let y: Vec<f64> = filtered(&x)
        .iter()
        .map(|v| v + 1.5 * noise.normal())
        .collect();
    let f = frf(&x, &y, fs, &WelchOptions::new(512)).unwrap();
    let (mut magnitude, mut phase, mut coherence, mut count) = (0.0, 0.0, 0.0, 0.0);
    for k in 4..252 {
        let h = response(f.freq_hz[k], fs);
        magnitude += ((f.h1[k].norm() / h.norm() - 1.0) / f.magnitude_error[k]).powi(2);
        phase += ((f.h1[k] / h).arg() / f.phase_error_rad[k]).powi(2);
        coherence += f.coherence[k] - h.norm_sqr() / (h.norm_sqr() + 2.25);
        count += 1.0;
    }
    let (magnitude, phase) = ((magnitude / count).sqrt(), (phase / count).sqrt());
    println!("{magnitude} {phase} {}", coherence / count);
    // 250 bins, neighbours correlated: 7 % scatter, two of these.
    assert!((magnitude - 1.0).abs() < 0.15, "{magnitude}");
    assert!((phase - 1.0).abs() < 0.15, "{phase}");
    // √2 (1-γ²) |γ| / √n is 0.013; over 248 bins, of which two count as one, 1.2e-3, four of these.
    assert!((coherence / count).abs() < 5e-3, "{}", coherence / count);
}

#[test]
fn verify_h1_and_h2_bound_the_response_from_either_side() {
    // Noise of variance 0.5 on the unit input: E H1 = H/1.5, E H2 = H; on the output the other way round.
    let fs = 100.0;
    let mut noise = Noise::new(5);
    let x = noise.normals(300_000);
    let y = filtered(&x);
    let noisy: Vec<f64> = x
        .iter()
        .map(|v| v + 0.5f64.sqrt() * noise.normal())
        .collect();
    let options = WelchOptions::new(256);
    let input = frf(&noisy, &y, fs, &options).unwrap();
    let noisy: Vec<f64> = y.iter().map(|v| v + 2.0 * noise.normal()).collect();
    let output = frf(&x, &noisy, fs, &options).unwrap();
    let ratio = |estimate: &[Complex64]| {
        let k = 30;
        (estimate[k] / response(input.freq_hz[k], fs)).norm()
    };
    let h = response(input.freq_hz[30], fs).norm_sqr();
    // Random error at 2000 effective averages: about 2 %.
    for (got, want) in [
        (ratio(&input.h1), 1.0 / 1.5),
        (ratio(&input.h2), 1.0),
        (ratio(&output.h1), 1.0),
        (ratio(&output.h2), 1.0 + 4.0 / h),
    ] {
        assert!((got / want - 1.0).abs() < 0.05, "{got} {want}");
    }
}

#[test]
fn verify_bad_options_are_named() {
    let x = vec![1.0; 100];
    let run = |options: &WelchOptions| welch(&x, 1.0, options).unwrap_err().to_string();
    assert_eq!(
        run(&WelchOptions::new(200)),
        "values has 100 entries, at least 200 are needed"
    );
    assert_eq!(
        run(&WelchOptions::new(2)),
        "window has 2 entries, at least 3 are needed"
    );
    assert_eq!(
        run(&WelchOptions {
            overlap: 1.0,
            ..WelchOptions::new(10)
        }),
        "overlap is 1, a number from 0 to below 1 is needed"
    );
    assert_eq!(
        frf(&x, &x, 1.0, &WelchOptions::new(80))
            .unwrap_err()
            .to_string(),
        "number of segments is 1, 2 or more is needed"
    );
    let silent = frf(&[0.0; 100], &x, 1.0, &WelchOptions::new(10)).unwrap();
    assert!(silent.coherence.iter().all(|&c| c == 0.0));
    assert!(silent.magnitude_error.iter().all(|e| e.is_infinite()));
}
