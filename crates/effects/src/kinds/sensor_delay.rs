//! A channel arrives late.

use crate::effect::{Action, Effect, Family, Parameter, SiteKind, SiteScale};
use crate::signal_map::{Retiming, Sampled};

/// A channel arrives late.
///
/// ```text
/// y_measured(t) = y(t - tau)
/// ```
pub(crate) struct SensorDelay;

pub(super) struct Delay {
    pub(super) delay_s: f64,
}

impl Retiming for Delay {
    fn position(&self, signal: &Sampled<'_>, i: usize) -> f64 {
        i as f64 - self.delay_s / signal.time_step_s
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
        vec![vec![0.5 * scale.time_step_s], vec![3.0 * scale.time_step_s]]
    }

    fn action(&self, values: &[f64]) -> Action {
        Action::Output(Box::new(Delay { delay_s: values[0] }))
    }

    fn experiment(&self) -> &'static str {
        "broadband excitation: a delay turns the phase in proportion to the frequency and leaves the amplitude"
    }
}
