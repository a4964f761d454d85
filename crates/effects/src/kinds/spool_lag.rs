//! The spool of a valve follows more slowly than the model says.

use super::hydraulic::valve_at;
use crate::effect::{Action, Effect, Family, Parameter, SiteKind, SiteScale};
use crate::prior::Prior;

/// The spool of a valve follows more slowly than the model says.
///
/// ```text
/// f₀ = factor f₀_nominal
/// ```
///
/// Reference: `merritt1967`, chapter 7.
pub(crate) struct SpoolLag;

impl Effect for SpoolLag {
    fn kind(&self) -> &'static str {
        "spool_lag"
    }

    fn family(&self) -> Family {
        Family::Dynamics
    }

    fn site(&self) -> SiteKind {
        SiteKind::Spool
    }

    fn summary(&self) -> &'static str {
        "the spool follows its command more slowly than the model says"
    }

    fn equation(&self) -> &'static str {
        "f0 = factor f0_nominal"
    }

    fn reference(&self) -> Option<&'static str> {
        Some("[merritt1967], chapter 7")
    }

    fn parameters(&self) -> &'static [Parameter] {
        const {
            &[Parameter {
                lower: 0.01,
                ..Parameter::factor("natural_freq_factor")
            }]
        }
    }

    fn starts(&self, _: &SiteScale) -> Vec<Vec<f64>> {
        vec![vec![0.8]]
    }

    fn prior(&self, _: usize, _: &SiteScale) -> Prior {
        Prior::factor()
    }

    fn action(&self, values: &[f64]) -> Action {
        let value = values[0];
        Action::Model(Box::new(move |model, at| {
            if let Some(valve) = valve_at(model, at) {
                valve.natural_freq *= value;
            }
        }))
    }

    fn confused_with(&self) -> &'static [(&'static str, &'static str)] {
        &[(
            "input_lag",
            "well below its natural frequency a spool is a lag of its command",
        )]
    }

    fn experiment(&self) -> &'static str {
        "commands up to the natural frequency of the spool, its position measured"
    }
}
