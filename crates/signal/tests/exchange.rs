//! Results leave the crate and come back: through `serde`, and as `ndarray` views.
#![cfg(all(feature = "ndarray", feature = "serde"))]
#![allow(clippy::unwrap_used)]

use simgap_signal::frf::{Frf, frf};
use simgap_signal::lines::{LineFit, fit_lines};
use simgap_signal::metrics::{Iso18571, SpragueGeers, iso18571, sprague_geers};
use simgap_signal::peaks::{Peak, PeakOptions, find_peaks};
use simgap_signal::spectrum::{Spectrum, spectrum};
use simgap_signal::welch::{CrossSpectra, WelchOptions, cross_spectra, welch};
use simgap_signal::{Trend, Window};

const RATE_HZ: f64 = 100.0;

fn signals() -> [Vec<f64>; 2] {
    let input: Vec<f64> = (0..600).map(|n| f64::from((n * n) % 97).sin()).collect();
    let late = |n: usize| if n < 3 { 0.0 } else { input[n - 3] };
    let output = (0..600).map(|n| 0.7 * late(n) + 0.01 * f64::from((n * 7 % 13) as u32));
    let output = output.collect();
    [input, output]
}

/// Through JSON and back; numbers keep every bit.
fn round_trip<T: serde::Serialize + serde::de::DeserializeOwned>(value: &T) -> T {
    serde_json::from_str(&serde_json::to_string(value).unwrap()).unwrap()
}

#[test]
fn verify_results_come_back_from_json() {
    let [x, y] = signals();
    let spectrum: Spectrum = spectrum(&x, RATE_HZ, Window::Hann, Trend::Mean).unwrap();
    assert_eq!(round_trip(&spectrum), spectrum);
    let options = WelchOptions::new(100);
    let cross: CrossSpectra = cross_spectra(&x, &y, RATE_HZ, &options).unwrap();
    assert_eq!(round_trip(&cross), cross);
    let response: Frf = frf(&x, &y, RATE_HZ, &options).unwrap();
    assert_eq!(round_trip(&response), response);
    let peaks: Vec<Peak> = find_peaks(&spectrum, &PeakOptions::default()).unwrap();
    assert_eq!(round_trip(&peaks), peaks);
    let time_s: Vec<f64> = (0..600).map(|n| f64::from(n) / RATE_HZ).collect();
    let lines: LineFit = fit_lines(&time_s, &y, &[7.0, 12.5]).unwrap();
    assert_eq!(round_trip(&lines), lines);
    let agreement: SpragueGeers = sprague_geers(&x, &y).unwrap();
    assert_eq!(round_trip(&agreement), agreement);
    let score: Iso18571 = iso18571(&x, &y).unwrap();
    assert_eq!(round_trip(&score), score);
}

#[test]
fn verify_views_hold_the_values_of_the_results() {
    let [x, y] = signals();
    let spectrum = spectrum(&x, RATE_HZ, Window::Hann, Trend::Mean).unwrap();
    assert_eq!(spectrum.freq_hz_view().to_vec(), spectrum.freq_hz);
    assert_eq!(spectrum.amplitude_view().to_vec(), spectrum.amplitude);
    assert_eq!(spectrum.phase_rad_view().to_vec(), spectrum.phase_rad);
    let density = welch(&x, RATE_HZ, &WelchOptions::new(100)).unwrap();
    assert_eq!(density.freq_hz_view().to_vec(), density.freq_hz);
    assert_eq!(density.density_view().to_vec(), density.density);
    let response = frf(&x, &y, RATE_HZ, &WelchOptions::new(100)).unwrap();
    assert_eq!(response.freq_hz_view().to_vec(), response.freq_hz);
    assert_eq!(response.h1_view().to_vec(), response.h1);
}
