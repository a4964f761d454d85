//! A sensor reads by a factor too much.

use crate::effect::{Action, Effect, Family, Parameter, SiteKind, SiteScale};
use crate::signal_map::{Sampled, SignalMap};

/// A sensor reads by a factor too much.
///
/// ```text
/// y_measured = factor y
/// ```
pub(crate) struct SensorGain;

/// Multiplies a signal.
pub(crate) struct Gain(pub(crate) f64);

impl SignalMap for Gain {
    fn apply(&self, signal: Sampled<'_>) -> Vec<f64> {
        signal.values.iter().map(|value| value * self.0).collect()
    }
}

impl Effect for SensorGain {
    fn kind(&self) -> &'static str {
        "sensor_gain"
    }

    fn family(&self) -> Family {
        Family::Measurement
    }

    fn site(&self) -> SiteKind {
        SiteKind::Channel
    }

    fn summary(&self) -> &'static str {
        "the sensor reads by a factor too much or too little"
    }

    fn equation(&self) -> &'static str {
        "y_measured = factor y"
    }

    fn parameters(&self) -> &'static [Parameter] {
        &[Parameter {
            name: "gain_factor",
            unit: "1",
            lower: 0.0,
            upper: f64::INFINITY,
            neutral: Some(1.0),
        }]
    }

    fn starts(&self, scale: &SiteScale) -> Vec<Vec<f64>> {
        {
            let _ = scale;
            vec![vec![1.05]]
        }
    }

    fn action(&self, values: &[f64]) -> Action {
        Action::Output(Box::new(Gain(values[0])))
    }

    fn experiment(&self) -> &'static str {
        "a static calibration of the sensor against a reference"
    }
}
