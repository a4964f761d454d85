//! A mass differs from its nominal value by a factor.

use simgap_model::{Location, NominalQuantity};

use crate::effect::{Action, Effect, Family, Parameter, SiteKind, SiteScale};

/// A mass of zero would make the mass matrix singular; a millionth of it is gone for every purpose.
const SMALLEST_MASS_FACTOR: f64 = 1e-6;

/// A mass differs from its nominal value by a factor.
pub(crate) struct MassError;

impl Effect for MassError {
    fn kind(&self) -> &'static str {
        "mass_error"
    }

    fn family(&self) -> Family {
        Family::NominalParameter
    }

    fn site(&self) -> SiteKind {
        SiteKind::Mass
    }

    fn summary(&self) -> &'static str {
        "the mass differs from its nominal value"
    }

    fn equation(&self) -> &'static str {
        "m = factor m_nominal"
    }

    fn parameters(&self) -> &'static [Parameter] {
        const { &[Parameter::factor("mass_factor")] }
    }

    fn starts(&self, _: &SiteScale) -> Vec<Vec<f64>> {
        vec![vec![1.05]]
    }

    fn nominal_quantity(&self) -> Option<NominalQuantity> {
        Some(NominalQuantity::Mass)
    }

    fn action(&self, values: &[f64]) -> Action {
        let factor = values[0];
        Action::Model(Box::new(move |model, at| {
            if let Location::Mass(name) = at {
                for mass in model.masses.iter_mut().filter(|mass| &mass.name == name) {
                    mass.value *= factor.max(SMALLEST_MASS_FACTOR);
                }
            }
        }))
    }

    fn experiment(&self) -> &'static str {
        "broadband excitation well above the natural frequency, where inertia dominates"
    }
}
