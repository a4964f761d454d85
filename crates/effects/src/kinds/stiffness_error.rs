//! The springs between two nodes differ from their nominal stiffness by a factor.

use simgap_model::{Location, NominalQuantity, same_pair};

use crate::effect::{Action, Effect, Family, Parameter, SiteKind, SiteScale};

/// The springs between two nodes differ from their nominal stiffness by a factor.
pub(crate) struct StiffnessError;

impl Effect for StiffnessError {
    fn kind(&self) -> &'static str {
        "stiffness_error"
    }

    fn family(&self) -> Family {
        Family::NominalParameter
    }

    fn site(&self) -> SiteKind {
        SiteKind::Spring
    }

    fn summary(&self) -> &'static str {
        "the spring is stiffer or softer than its nominal value"
    }

    fn equation(&self) -> &'static str {
        "k = factor k_nominal"
    }

    fn parameters(&self) -> &'static [Parameter] {
        const { &[Parameter::factor("stiffness_factor")] }
    }

    fn starts(&self, _: &SiteScale) -> Vec<Vec<f64>> {
        vec![vec![1.05]]
    }

    fn nominal_quantity(&self) -> Option<NominalQuantity> {
        Some(NominalQuantity::Stiffness)
    }

    fn action(&self, values: &[f64]) -> Action {
        let factor = values[0];
        Action::Model(Box::new(move |model, at| {
            if let Location::Between(pair) = at {
                for spring in model
                    .springs
                    .iter_mut()
                    .filter(|s| same_pair(&s.between, pair))
                {
                    spring.stiffness *= factor;
                }
            }
        }))
    }

    fn experiment(&self) -> &'static str {
        "slow or static loading, where the spring carries the force alone"
    }
}
