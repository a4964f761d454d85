//! A sensor reads a constant too much.

use crate::effect::{Action, Effect, Family, Parameter, SiteKind, SiteScale};
use crate::line::Line;
use crate::signal_map::{Sampled, SignalMap};

/// A sensor reads a constant too much.
///
/// ```text
/// y_measured = y + bias
/// ```
pub(crate) struct SensorBias;

struct Bias(f64);

impl SignalMap for Bias {
    fn apply(&self, signal: Sampled<'_>) -> Vec<f64> {
        signal.values.iter().map(|value| value + self.0).collect()
    }
}

impl Effect for SensorBias {
    fn kind(&self) -> &'static str {
        "sensor_bias"
    }

    fn family(&self) -> Family {
        Family::Measurement
    }

    fn site(&self) -> SiteKind {
        SiteKind::Channel
    }

    fn summary(&self) -> &'static str {
        "the sensor reads a constant too much or too little"
    }

    fn equation(&self) -> &'static str {
        "y_measured = y + bias"
    }

    fn parameters(&self) -> &'static [Parameter] {
        &[Parameter {
            name: "bias",
            unit: "unit of the output",
            lower: f64::NEG_INFINITY,
            upper: f64::INFINITY,
            neutral: Some(0.0),
            per_record: false,
        }]
    }

    fn starts(&self, scale: &SiteScale) -> Vec<Vec<f64>> {
        vec![vec![0.05 * scale.signal]]
    }

    fn line(&self, values: &[f64]) -> Option<Line> {
        Some(Line::constant(values[0]))
    }

    fn action(&self, values: &[f64]) -> Action {
        Action::Output(Box::new(Bias(values[0])))
    }

    fn experiment(&self) -> &'static str {
        "the sensor on a fixed reference, beside a record of the machine at rest"
    }
}
