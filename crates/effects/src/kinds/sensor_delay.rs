//! A channel arrives late.

use crate::effect::{Action, Effect, Family, Parameter, SiteKind, SiteScale};
use crate::signal_map::{Retiming, Sampled};

/// A channel arrives late.
///
/// ```text
/// y_measured(t) = y(t - tau)
/// ```
pub(crate) struct SensorDelay;

/// Delays that a fit starts from, in samples.
const SHORT: [f64; 2] = [0.5, 3.0];

pub(super) struct Delay {
    pub(super) delay_s: f64,
}

/// Starting values of a delay that is short against what the signal does.
pub(super) fn short_delays(scale: &SiteScale) -> Vec<Vec<f64>> {
    SHORT.map(|steps| vec![steps * scale.time_step_s]).into()
}

/// The delay that signals which come late by more show themselves.
pub(super) fn long_delay(scale: &SiteScale) -> Vec<Vec<f64>> {
    let [_, longest] = SHORT;
    let is_long = scale.late_s > longest * scale.time_step_s;
    is_long.then(|| vec![scale.late_s]).into_iter().collect()
}

impl Delay {
    fn samples(&self, signal: &Sampled<'_>) -> f64 {
        self.delay_s / signal.time_step_s
    }
}

impl Retiming for Delay {
    fn position(&self, signal: &Sampled<'_>, i: usize) -> f64 {
        i as f64 - self.samples(signal)
    }

    fn behind(&self, signal: &Sampled<'_>) -> Option<f64> {
        Some(self.samples(signal))
    }
}

impl Effect for SensorDelay {
    fn kind(&self) -> &'static str {
        "sensor_delay"
    }

    fn family(&self) -> Family {
        Family::Measurement
    }

    fn site(&self) -> SiteKind {
        SiteKind::Channel
    }

    fn summary(&self) -> &'static str {
        "the channel arrives late"
    }

    fn equation(&self) -> &'static str {
        "y_measured(t) = y(t - tau)"
    }

    fn parameters(&self) -> &'static [Parameter] {
        &[Parameter {
            name: "delay_s",
            unit: "s",
            lower: 0.0,
            upper: f64::INFINITY,
            neutral: Some(0.0),
            per_record: false,
        }]
    }

    fn starts(&self, scale: &SiteScale) -> Vec<Vec<f64>> {
        short_delays(scale)
    }

    fn pointed_at(&self, scale: &SiteScale) -> Vec<Vec<f64>> {
        long_delay(scale)
    }

    fn action(&self, values: &[f64]) -> Action {
        Action::Output(Box::new(Delay { delay_s: values[0] }))
    }

    fn experiment(&self) -> &'static str {
        "broadband excitation: a delay turns the phase in proportion to the frequency and leaves the amplitude"
    }
}
