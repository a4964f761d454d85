//! The gain of a sensor swings at one frequency.

use std::f64::consts::TAU;

use super::carrier::carriers_hz;
use crate::effect::{Action, Clock, Effect, Family, Parameter, SiteKind, SiteScale};
use crate::signal_map::{Sampled, SignalMap};

/// The gain of a sensor swings at one frequency: a supply or an excitation of the transducer that ripples.
///
/// ```text
/// y_measured(t) = (1 + g_a sin(2π f t + φ)) y(t),   t on the clock of the record
/// ```
///
/// At half the sample rate it is an `alternating_gain`. Every record has a phase of its own.
pub(crate) struct GainRipple;

/// Share of the signal in a start.
const START: f64 = 0.05;

struct Tone {
    amplitude: f64,
    omega: f64,
    phase: f64,
}

impl SignalMap for Tone {
    fn apply(&self, signal: Sampled<'_>) -> Vec<f64> {
        let toned = |(n, value): (usize, &f64)| {
            let time_s = signal.start_s + n as f64 * signal.time_step_s;
            (1.0 + self.amplitude * (self.omega * time_s + self.phase).sin()) * value
        };
        signal.values.iter().enumerate().map(toned).collect()
    }
}

impl Effect for GainRipple {
    fn kind(&self) -> &'static str {
        "gain_ripple"
    }

    fn family(&self) -> Family {
        Family::Measurement
    }

    fn site(&self) -> SiteKind {
        SiteKind::Channel
    }

    fn summary(&self) -> &'static str {
        "the gain of the sensor swings at one frequency, as with a rippling supply"
    }

    fn equation(&self) -> &'static str {
        "y_measured(t) = (1 + g_a sin(2 pi f t + phi)) y(t)"
    }

    fn parameters(&self) -> &'static [Parameter] {
        const {
            &[
                Parameter::size("gain_amplitude", "1", 0.0, f64::INFINITY),
                Parameter::shape("frequency_hz", "Hz", 1e-6, f64::INFINITY),
                Parameter::shape("phase_rad", "rad", f64::NEG_INFINITY, f64::INFINITY).of_record(),
            ]
        }
    }

    fn starts(&self, scale: &SiteScale) -> Vec<Vec<f64>> {
        let carriers = carriers_hz(scale).into_iter();
        carriers.map(|freq| vec![START, freq, 0.0]).collect()
    }

    fn clock(&self) -> Option<Clock> {
        Some(Clock {
            amplitude: 0,
            frequency: 1,
            phase: 2,
        })
    }

    fn action(&self, values: &[f64]) -> Action {
        Action::Output(Box::new(Tone {
            amplitude: values[0],
            omega: TAU * values[1],
            phase: values[2],
        }))
    }

    fn confused_with(&self) -> &'static [(&'static str, &'static str)] {
        &[
            (
                "alternating_gain",
                "at half the sample rate the two are the same",
            ),
            (
                "synchronous_tone",
                "of a motion at one frequency a carrier times the velocity leaves the same two lines",
            ),
            (
                "tone_pickup",
                "of a channel with a large constant part both are a tone",
            ),
        ]
    }

    fn experiment(&self) -> &'static str {
        "the channel at rest at several constant values: the tone grows with the value"
    }
}
