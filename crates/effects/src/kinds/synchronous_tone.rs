//! A tone in a channel that grows with the velocity.

use std::f64::consts::TAU;

use super::carrier::carriers_hz;
use crate::effect::{Action, Clock, Effect, Family, Parameter, SiteKind, SiteScale};
use crate::signal_map::{Sampled, SignalMap};

/// A tone in a channel that grows with the velocity: an encoder or a clock that is early and late in turn, a
/// pick-up of what drives the motion.
///
/// ```text
/// y_measured(t) = y(t) + τ_a sin(2π f t + φ) ẏ(t),   t on the clock of the record
/// ẏ_n = (y_(n−2) − 8 y_(n−1) + 8 y_(n+1) − y_(n+2)) / (12 Δt)
/// ```
///
/// For small τ_a it is y(t + τ_a sin(2π f t + φ)): samples taken early and late by τ_a. At half the sample rate it
/// is an `alternating_timing`. Every record has a phase of its own.
pub(crate) struct SynchronousTone;

/// Share of the signal in a start.
const START: f64 = 0.05;

struct Tone {
    amplitude: f64,
    omega: f64,
    phase: f64,
}

impl SignalMap for Tone {
    fn apply(&self, signal: Sampled<'_>) -> Vec<f64> {
        let slope = slopes(signal.values, signal.time_step_s);
        let values = signal.values.iter().zip(slope).enumerate();
        let toned = |(n, (value, slope)): (usize, (&f64, f64))| {
            let time_s = signal.start_s + n as f64 * signal.time_step_s;
            value + self.amplitude * (self.omega * time_s + self.phase).sin() * slope
        };
        values.map(toned).collect()
    }
}

/// Central differences: of five points, nearer to the ends of three, one-sided at the ends.
fn slopes(y: &[f64], step_s: f64) -> Vec<f64> {
    let last = y.len().saturating_sub(1);
    let slope = |n: usize| match n.min(last - n) {
        0 => (y[(n + 1).min(last)] - y[n.saturating_sub(1)]) / step_s,
        1 => (y[n + 1] - y[n - 1]) / (2.0 * step_s),
        _ => (8.0 * (y[n + 1] - y[n - 1]) - (y[n + 2] - y[n - 2])) / (12.0 * step_s),
    };
    (0..y.len()).map(slope).collect()
}

impl Effect for SynchronousTone {
    fn kind(&self) -> &'static str {
        "synchronous_tone"
    }

    fn family(&self) -> Family {
        Family::Measurement
    }

    fn site(&self) -> SiteKind {
        SiteKind::Channel
    }

    fn summary(&self) -> &'static str {
        "a tone in the channel grows with the velocity of the motion: it is early and late in turn"
    }

    fn equation(&self) -> &'static str {
        "y_measured(t) = y(t) + tau_a sin(2 pi f t + phi) dy/dt"
    }

    fn parameters(&self) -> &'static [Parameter] {
        const {
            &[
                Parameter::size("time_amplitude_s", "s", 0.0, f64::INFINITY),
                Parameter::shape("frequency_hz", "Hz", 1e-6, f64::INFINITY),
                Parameter::shape("phase_rad", "rad", f64::NEG_INFINITY, f64::INFINITY).of_record(),
            ]
        }
    }

    /// A twentieth of the signal at the frequency of the motion, or of a sample.
    fn starts(&self, scale: &SiteScale) -> Vec<Vec<f64>> {
        let amplitude_s = match scale.motion_hz[0] {
            line if line > 0.0 => START / (TAU * line),
            _ => START * scale.time_step_s,
        };
        let carriers = carriers_hz(scale).into_iter();
        carriers.map(|freq| vec![amplitude_s, freq, 0.0]).collect()
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
                "alternating_timing",
                "at half the sample rate the two are the same",
            ),
            (
                "tone_pickup",
                "of a motion at constant speed both are a tone",
            ),
            (
                "gain_ripple",
                "of a motion at one frequency a carrier times the value leaves the same two lines",
            ),
        ]
    }

    fn experiment(&self) -> &'static str {
        "the same motion at two frequencies and with the drive off: the tone grows with the velocity and is gone at rest"
    }
}
