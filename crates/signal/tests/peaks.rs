//! Peak finding, interpolation between bins, and the standard errors it claims.
#![allow(clippy::unwrap_used)]

use crate::common::{Noise, cosine};
use simgap_signal::peaks::{Peak, PeakOptions, find_peaks};
use simgap_signal::spectrum::spectrum;
use simgap_signal::{Trend, Window};

fn peaks_of(x: &[f64], fs: f64, window: Window) -> Vec<Peak> {
    let s = spectrum(x, fs, window, Trend::Mean).unwrap();
    find_peaks(&s, &PeakOptions::default()).unwrap()
}

fn add_noise(x: &mut [f64], std: f64, noise: &mut Noise) {
    x.iter_mut().for_each(|v| *v += std * noise.normal());
}

#[test]
fn verify_place_between_bins_without_noise() {
    // What is left is the leakage of the mirror line at bin -100: 1/(2k) of the amplitude for the
    // rectangular window, scaled by the step at the edge (0.08/0.54) for Hamming, none to
    // speak of for the windows that end at zero.
    let (fs, n) = (1000.0, 1000);
    for window in Window::ALL {
        let tolerance = match window {
            Window::Rectangular => 5e-3,
            Window::Hamming => 5e-3 * 0.08 / 0.54,
            _ => 1e-5,
        };
        for tenth in -5..=5 {
            let freq = 100.0 + 0.1 * f64::from(tenth);
            let mut x = cosine(n, fs, freq, 2.0, 0.4);
            add_noise(&mut x, 1e-9, &mut Noise::new(1));
            let peaks = peaks_of(&x, fs, window);
            let top = peaks
                .iter()
                .max_by(|a, b| a.amplitude.total_cmp(&b.amplitude))
                .unwrap();
            assert!(
                (top.freq_hz - freq).abs() < tolerance,
                "{window:?} {freq} {top:?}"
            );
            assert!(
                (top.amplitude / 2.0 - 1.0).abs() < tolerance,
                "{window:?} {freq} {top:?}"
            );
            // Phase at the start turns by π N/fs per hertz of frequency error.
            assert!(
                (top.phase_rad - 0.4).abs() < 10.0 * tolerance,
                "{window:?} {freq} {top:?}"
            );
        }
    }
}

#[test]
fn verify_monte_carlo_coverage_and_cramer_rao() {
    // 95 % intervals of 2000 runs: binomial scatter 0.5 %, three of these. Beside a rectangular
    // window the side lobes of the line pass for noise, so that its intervals are too wide, never
    // too narrow.
    const RUNS: usize = 2000;
    const SCATTER: f64 = 0.015;
    let (fs, n, amplitude, std) = (100.0, 512, 1.0, 0.3);
    // Frequency scatter over the Cramér-Rao bound, averaged over the place between bins.
    for (window, excess) in [
        (Window::Rectangular, 1.25),
        (Window::Hann, 1.96),
        (Window::BlackmanHarris, 2.62),
    ] {
        let mut noise = Noise::new(11);
        let (mut freq_hits, mut amplitude_hits) = (0, 0);
        let mut freq_square = 0.0;
        for _ in 0..RUNS {
            let freq = 23.0 + noise.uniform();
            let mut x = cosine(
                n,
                fs,
                freq,
                amplitude,
                std::f64::consts::TAU * noise.uniform(),
            );
            add_noise(&mut x, std, &mut noise);
            let peaks = peaks_of(&x, fs, window);
            let top = peaks
                .iter()
                .max_by(|a, b| a.amplitude.total_cmp(&b.amplitude))
                .unwrap();
            let error = top.freq_hz - freq;
            freq_hits += usize::from(error.abs() < 1.96 * top.freq_std_hz);
            amplitude_hits +=
                usize::from((top.amplitude - amplitude).abs() < 1.96 * top.amplitude_std);
            freq_square += error * error;
        }
        let runs = RUNS as f64;
        let (freq_cover, amplitude_cover) = (freq_hits as f64 / runs, amplitude_hits as f64 / runs);
        let count = n as f64;
        let bound = fs / std::f64::consts::TAU
            * (24.0 * std * std / (amplitude * amplitude * count * (count * count - 1.0))).sqrt();
        let over_bound = (freq_square / runs).sqrt() / bound;
        println!("{window:?}: {freq_cover} {amplitude_cover} excess {over_bound:.3}");
        let highest = if window == Window::Rectangular {
            0.985
        } else {
            0.95 + SCATTER
        };
        assert!(
            (0.95 - SCATTER..highest).contains(&freq_cover),
            "{window:?} {freq_cover}"
        );
        assert!(
            (0.95 - SCATTER..highest).contains(&amplitude_cover),
            "{window:?} {amplitude_cover}"
        );
        // Scatter of a standard deviation from 2000 runs: 1.6 %.
        assert!(
            (over_bound / excess - 1.0).abs() < 0.05,
            "{window:?} {over_bound}"
        );
    }
}

#[test]
fn verify_false_alarm_rate_of_white_noise() {
    // 1000 records at a false-alarm probability of 5 %: 50 expected, binomial scatter 7, three of these.
    let options = PeakOptions {
        false_alarm_probability: 0.05,
        ..PeakOptions::default()
    };
    for window in [Window::Rectangular, Window::Hann] {
        let mut noise = Noise::new(3);
        let alarms = (0..1000)
            .filter(|_| {
                let s = spectrum(&noise.normals(1024), 1.0, window, Trend::Mean).unwrap();
                !find_peaks(&s, &options).unwrap().is_empty()
            })
            .count();
        println!("{window:?}: {alarms} of 1000");
        assert!((29..=71).contains(&alarms), "{window:?} {alarms}");
    }
}

#[test]
fn verify_side_lobes_are_not_lines() {
    let (fs, n) = (100.0, 2000);
    let mut x = cosine(n, fs, 10.013, 1.0, 0.0);
    for (v, w) in x.iter_mut().zip(cosine(n, fs, 31.37, 0.05, 1.0)) {
        *v += w;
    }
    add_noise(&mut x, 1e-3, &mut Noise::new(5));
    for window in [
        Window::Hann,
        Window::BlackmanHarris,
        Window::Hamming,
        Window::FlatTop,
    ] {
        let peaks = peaks_of(&x, fs, window);
        let freqs: Vec<f64> = peaks.iter().map(|p| p.freq_hz).collect();
        assert_eq!(freqs.len(), 2, "{window:?} {freqs:?}");
        assert!((freqs[0] - 10.013).abs() < 1e-3 && (freqs[1] - 31.37).abs() < 1e-3);
    }
}

#[test]
fn verify_noise_level_beside_a_line() {
    let (fs, n, std) = (100.0, 4096, 0.2);
    let mut x = cosine(n, fs, 12.3, 1.0, 0.0);
    add_noise(&mut x, std, &mut Noise::new(6));
    let peaks = peaks_of(&x, fs, Window::Hann);
    assert_eq!(peaks.len(), 1);
    // Median of about 120 correlated bins: 15 % scatter of the power, 8 % of the level.
    assert!(
        (peaks[0].local_noise_std / std - 1.0).abs() < 0.25,
        "{:?}",
        peaks[0]
    );
}

#[test]
fn verify_bad_options_are_named() {
    let s = spectrum(&[0.0; 64], 1.0, Window::Hann, Trend::Keep).unwrap();
    let options = PeakOptions {
        false_alarm_probability: 1.5,
        ..PeakOptions::default()
    };
    assert_eq!(
        find_peaks(&s, &options).unwrap_err().to_string(),
        "false_alarm_probability is 1.5, a number between 0 and 1 is needed"
    );
    assert!(find_peaks(&s, &PeakOptions::default()).unwrap().is_empty());
}
