//! Lines of a record: frequency, height and phase.
//!
//! ```sh
//! cargo run -p simgap-signal --example lines
//! ```
#![allow(clippy::print_stdout)]

use std::f64::consts::TAU;

use simgap_signal::peaks::{PeakOptions, find_peaks};
use simgap_signal::spectrum::spectrum;
use simgap_signal::{Trend, Window};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let record: Vec<f64> = (0..2000)
        .map(|n| {
            let t = f64::from(n) / 100.0;
            let dither = f64::from((n * 7919) % 101) / 101.0 - 0.5;
            2.0 * (TAU * 4.7 * t).cos() + 0.2 * (TAU * 11.3 * t).sin() + 0.01 * dither
        })
        .collect();
    let found = spectrum(&record, 100.0, Window::Hann, Trend::Mean)?;
    for peak in find_peaks(&found, &PeakOptions::default())? {
        println!(
            "{:.4} Hz, height {:.4}, phase {:.1} degrees",
            peak.freq_hz,
            peak.amplitude,
            peak.phase_rad.to_degrees()
        );
    }
    Ok(())
}
