//! An input drives the plant with another gain than assumed.

use crate::Prior;
use crate::effect::{Action, Effect, Family, Parameter, SiteKind, SiteScale};
use crate::signal_map::{Sampled, SignalMap};
use simgap_model::NominalQuantity;

/// An input drives the plant with another gain than assumed.
pub(crate) struct InputGain;

struct Gain(f64);

impl SignalMap for Gain {
    fn apply(&self, signal: Sampled<'_>) -> Vec<f64> {
        signal.values.iter().map(|value| value * self.0).collect()
    }
}

impl Effect for InputGain {
    fn kind(&self) -> &'static str {
        "input_gain"
    }

    fn family(&self) -> Family {
        Family::NominalParameter
    }

    fn site(&self) -> SiteKind {
        SiteKind::Input
    }

    fn summary(&self) -> &'static str {
        "the input acts with another gain than the model assumes"
    }

    fn equation(&self) -> &'static str {
        "u = factor u_measured"
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
        Some(NominalQuantity::InputGain)
    }

    fn action(&self, values: &[f64]) -> Action {
        let factor = values[0];
        Action::Input(Box::new(Gain(factor)))
    }

    fn experiment(&self) -> &'static str {
        "a static calibration of the input against a reference"
    }
}
