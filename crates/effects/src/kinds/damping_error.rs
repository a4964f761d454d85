//! The dampers between two nodes differ from their nominal damping by a factor.

use simgap_model::{Location, NominalQuantity, same_pair};

use crate::effect::{Action, Effect, Family, Parameter, SiteKind, SiteScale};
use crate::prior::Prior;

/// The dampers between two nodes differ from their nominal damping by a factor.
pub(crate) struct DampingError;

impl Effect for DampingError {
    fn kind(&self) -> &'static str {
        "damping_error"
    }

    fn family(&self) -> Family {
        Family::NominalParameter
    }

    fn site(&self) -> SiteKind {
        SiteKind::Damper
    }

    fn summary(&self) -> &'static str {
        "the damper is stronger or weaker than its nominal value"
    }

    fn equation(&self) -> &'static str {
        "c = factor c_nominal"
    }

    fn parameters(&self) -> &'static [Parameter] {
        const { &[Parameter::factor("damping_factor")] }
    }

    fn starts(&self, _: &SiteScale) -> Vec<Vec<f64>> {
        vec![vec![1.05]]
    }

    /// A machine may lack the damper that its model was given for its friction.
    fn prior(&self, _: usize, _: &SiteScale) -> Prior {
        Prior::factor_or_nothing()
    }

    fn nominal_quantity(&self) -> Option<NominalQuantity> {
        Some(NominalQuantity::Damping)
    }

    fn action(&self, values: &[f64]) -> Action {
        let factor = values[0];
        Action::Model(Box::new(move |model, at| {
            if let Location::Between(pair) = at {
                for damper in model
                    .dampers
                    .iter_mut()
                    .filter(|d| same_pair(&d.between, pair))
                {
                    damper.damping *= factor;
                }
            }
        }))
    }

    fn experiment(&self) -> &'static str {
        "excitation at the natural frequency, at several amplitudes"
    }
}
