//! A cable picks up a tone.

use std::f64::consts::TAU;

use crate::effect::{Action, Clock, Effect, Family, Parameter, SiteKind, SiteScale};
use crate::line::Line;
use crate::signal_map::{Sampled, SignalMap};

/// A cable picks up a tone: the mains, a converter, an image of what lies above half the sample
/// rate.
///
/// ```text
/// y_measured(t) = y(t) + A sin(2π f t + φ),   t on the clock of the record
/// ```
///
/// Every record has a phase φ of its own. A frequency above half the sample rate f_s is stored as
/// its image |f − k f_s|.
///
/// Reference: \[BendatPiersol2010\], power line pickup.
pub(crate) struct TonePickup;

const MAINS_HZ: f64 = 50.0;

/// Samples between two sines that are computed, those between turned on by a table.
const BLOCK: usize = 64;

struct Tone {
    amplitude: f64,
    frequency_hz: f64,
    phase_rad: f64,
}

impl SignalMap for Tone {
    fn apply(&self, signal: Sampled<'_>) -> Vec<f64> {
        let per_sample = TAU * self.frequency_hz * signal.time_step_s;
        let turn: [(f64, f64); BLOCK] = std::array::from_fn(|k| (per_sample * k as f64).sin_cos());
        let mut delivered = Vec::with_capacity(signal.values.len());
        for (b, block) in signal.values.chunks(BLOCK).enumerate() {
            let time_s = signal.start_s + (b * BLOCK) as f64 * signal.time_step_s;
            let (sin, cos) = (TAU * self.frequency_hz * time_s + self.phase_rad).sin_cos();
            for (value, (s, c)) in block.iter().zip(&turn) {
                // sin(α + kδ) = sin α cos kδ + cos α sin kδ
                delivered.push(value + self.amplitude * (sin * c + cos * s));
            }
        }
        delivered
    }
}

/// Where a frequency appears below half the sample rate.
fn image_hz(frequency_hz: f64, sample_rate_hz: f64) -> f64 {
    let turns = frequency_hz / sample_rate_hz;
    (turns - turns.round()).abs() * sample_rate_hz
}

impl Effect for TonePickup {
    fn kind(&self) -> &'static str {
        "tone_pickup"
    }

    fn family(&self) -> Family {
        Family::Measurement
    }

    fn site(&self) -> SiteKind {
        SiteKind::Channel
    }

    fn summary(&self) -> &'static str {
        "a tone is picked up on the way, such as mains hum or its image, and has nothing to do with the motion"
    }

    fn equation(&self) -> &'static str {
        "y_measured(t) = y(t) + A sin(2 pi f t + phi)"
    }

    fn reference(&self) -> Option<&'static str> {
        Some("[BendatPiersol2010], power line pickup")
    }

    fn parameters(&self) -> &'static [Parameter] {
        const {
            &[
                Parameter::size("amplitude", "unit of the output", 0.0, f64::INFINITY),
                Parameter::shape("frequency_hz", "Hz", 1e-6, f64::INFINITY),
                Parameter::shape("phase_rad", "rad", f64::NEG_INFINITY, f64::INFINITY).of_record(),
            ]
        }
    }

    /// At the lines of what is left, and at the mains as sampled.
    fn starts(&self, scale: &SiteScale) -> Vec<Vec<f64>> {
        let mains = image_hz(MAINS_HZ, 1.0 / scale.time_step_s);
        let lines = scale.lines_hz.iter().copied().filter(|&line| line > 0.0);
        let mut frequencies: Vec<f64> = lines.collect();
        // A line within the resolution of the record is the mains already, and known better.
        let resolution = 1.0 / scale.duration_s;
        let known = |line: &f64| (line - mains).abs() < resolution;
        if mains > resolution && !frequencies.iter().any(known) {
            frequencies.push(mains);
        }
        frequencies
            .into_iter()
            .map(|frequency| vec![0.1 * scale.signal, frequency, 0.0])
            .collect()
    }

    fn clock(&self) -> Option<Clock> {
        Some(Clock {
            amplitude: 0,
            frequency: 1,
            phase: 2,
        })
    }

    fn line(&self, values: &[f64]) -> Option<Line> {
        self.clock().map(|clock| clock.line(values))
    }

    fn action(&self, values: &[f64]) -> Action {
        Action::Output(Box::new(Tone {
            amplitude: values[0],
            frequency_hz: values[1],
            phase_rad: values[2],
        }))
    }

    fn confused_with(&self) -> &'static [(&'static str, &'static str)] {
        &[
            (
                "harmonic_force",
                "a force at one frequency moves the machine by a tone too: with one output the two are the same",
            ),
            (
                "alternating_timing",
                "of a motion at one frequency it leaves one line, at half the sample rate minus that frequency",
            ),
        ]
    }

    fn experiment(&self) -> &'static str {
        "a record with the drive off, at another sample rate: the tone stays, its image moves"
    }
}
