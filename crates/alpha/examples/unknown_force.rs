//! The force a model lacks, from a measured motion, and its harmonics.
//!
//! ```sh
//! cargo run -p simgap-alpha --example unknown_force
//! ```
#![allow(clippy::print_stdout)]

use std::f64::consts::TAU;

use simgap_alpha::{Oscillator, fit_fourier, unknown_force};
use simgap_integrate::inverse::Differentiator;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let plant = Oscillator {
        mass_kg: 2.0,
        damping: 4.0,
        stiffness: 800.0,
        load: 0.0,
    };
    // 1 mm at 1 Hz, held by a cubic spring of 5e7 N/m³ that the model lacks; 1000 samples a second.
    let motion: Vec<f64> = (0..4000)
        .map(|n| 1e-3 * (TAU * 1e-3 * f64::from(n)).sin())
        .collect();
    let applied: Vec<f64> = (0..4000)
        .map(|n| {
            let (sin, cos) = (TAU * 1e-3 * f64::from(n)).sin_cos();
            let linear = (800.0 - 2.0 * TAU * TAU) * 1e-3 * sin + 4.0 * TAU * 1e-3 * cos;
            linear + 5e7 * (1e-3 * sin).powi(3)
        })
        .collect();
    let found = unknown_force(&plant, &motion, &applied, 1e-3, Differentiator::Park)?;
    let fit = fit_fourier(&found.unknown_force, 1e-3, found.settling_samples, 1.0, 3)?;
    for harmonic in 1..=3 {
        let amplitude = fit.amplitude(harmonic).unwrap_or(0.0);
        println!("harmonic {harmonic}: {amplitude:.4} N");
    }
    // α = −5e7 y³ has 3/4 of its amplitude at 1 Hz, a quarter at 3 Hz.
    Ok(())
}
