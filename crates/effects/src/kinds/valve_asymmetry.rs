//! A valve passes more in one direction than in the other.

use super::hydraulic::valve_at;
use crate::effect::{Action, Effect, Family, Parameter, SiteKind, SiteScale};
use crate::prior::Prior;

/// A valve passes more in one direction than in the other.
///
/// ```text
/// K (1 + a) for x > 0, K (1 − a) for x < 0; a beside the asymmetry of the model
/// ```
///
/// Reference: `merritt1967`, chapter 5.
pub(crate) struct ValveAsymmetry;

impl Effect for ValveAsymmetry {
    fn kind(&self) -> &'static str {
        "valve_asymmetry"
    }

    fn family(&self) -> Family {
        Family::Force
    }

    fn site(&self) -> SiteKind {
        SiteKind::Spool
    }

    fn summary(&self) -> &'static str {
        "the valve passes more in one direction than in the other"
    }

    fn equation(&self) -> &'static str {
        "gain = K (1 + a) for x > 0, K (1 - a) for x < 0"
    }

    fn reference(&self) -> Option<&'static str> {
        Some("[merritt1967], chapter 5")
    }

    fn parameters(&self) -> &'static [Parameter] {
        const { &[Parameter::size("asymmetry_share", "1", -1.0, 1.0)] }
    }

    fn starts(&self, _: &SiteScale) -> Vec<Vec<f64>> {
        vec![vec![0.1], vec![-0.1]]
    }

    fn prior(&self, _: usize, _: &SiteScale) -> Prior {
        Prior::size(0.1)
    }

    fn action(&self, values: &[f64]) -> Action {
        let value = values[0];
        Action::Model(Box::new(move |model, at| {
            if let Some(valve) = valve_at(model, at) {
                valve.asymmetry = (valve.asymmetry + value).clamp(-1.0, 1.0);
            }
        }))
    }

    fn confused_with(&self) -> &'static [(&'static str, &'static str)] {
        &[(
            "input_gain",
            "the mean of the two directions is a gain of the command",
        )]
    }

    fn experiment(&self) -> &'static str {
        "the same stroke in both directions at several speeds"
    }
}
