//! A sensor reads too much or too little in proportion.

use crate::Prior;
use crate::effect::{Action, Effect, Family, Parameter, SiteKind, SiteScale};
use crate::signal_map::{Sampled, SignalMap};
use simgap_model::NominalQuantity;

/// A sensor reads too much or too little in proportion. A negative factor is a sensor of the wrong
/// sign: swapped wires, or mounted the other way round.
///
/// ```text
/// y_measured = g y
/// ```
pub(crate) struct SensorGain;

struct Gain(f64);

impl SignalMap for Gain {
    fn apply(&self, signal: Sampled<'_>) -> Vec<f64> {
        signal.values.iter().map(|value| self.0 * value).collect()
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
        "the sensor reads too much or too little in proportion, or with the wrong sign"
    }

    fn equation(&self) -> &'static str {
        "y_measured = g y"
    }

    fn parameters(&self) -> &'static [Parameter] {
        const {
            &[Parameter {
                lower: f64::NEG_INFINITY,
                ..Parameter::factor("gain_factor")
            }]
        }
    }

    fn starts(&self, _: &SiteScale) -> Vec<Vec<f64>> {
        vec![vec![1.05]]
    }

    fn prior(&self, _: usize, _: &SiteScale) -> Prior {
        Prior::gain()
    }

    fn nominal_quantity(&self) -> Option<NominalQuantity> {
        Some(NominalQuantity::OutputGain)
    }

    fn action(&self, values: &[f64]) -> Action {
        Action::Output(Box::new(Gain(values[0])))
    }

    fn confused_with(&self) -> &'static [(&'static str, &'static str)] {
        &[
            (
                "input_gain",
                "with one input and one output of a linear plant both scale the output alike",
            ),
            (
                "mass_error",
                "far above the resonances the motion is in proportion to one over the mass",
            ),
        ]
    }

    fn experiment(&self) -> &'static str {
        "the sensor beside a calibrated one on the same point: the plant drops out of the comparison"
    }
}
