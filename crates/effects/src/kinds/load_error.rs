//! A known constant force differs from its nominal value by a factor.

use simgap_model::{Location, NominalQuantity};

use crate::effect::{Action, Effect, Family, Parameter, SiteKind, SiteScale};

/// A known constant force on a mass, such as its weight, differs from its nominal value by a factor.
pub(crate) struct LoadError;

impl Effect for LoadError {
    fn kind(&self) -> &'static str {
        "load_error"
    }

    fn family(&self) -> Family {
        Family::NominalParameter
    }

    fn site(&self) -> SiteKind {
        SiteKind::Load
    }

    fn summary(&self) -> &'static str {
        "the known constant force on the mass differs from its nominal value"
    }

    fn equation(&self) -> &'static str {
        "F = factor F_nominal"
    }

    fn parameters(&self) -> &'static [Parameter] {
        const { &[Parameter::factor("load_factor")] }
    }

    fn starts(&self, _: &SiteScale) -> Vec<Vec<f64>> {
        vec![vec![1.05]]
    }

    fn nominal_quantity(&self) -> Option<NominalQuantity> {
        Some(NominalQuantity::Load)
    }

    fn action(&self, values: &[f64]) -> Action {
        let factor = values[0];
        Action::Model(Box::new(move |model, at| {
            if let Location::Mass(name) = at {
                for load in model.loads.iter_mut().filter(|load| &load.at == name) {
                    load.value *= factor;
                }
            }
        }))
    }

    fn confused_with(&self) -> &'static [(&'static str, &'static str)] {
        &[
            (
                "constant_force",
                "a load that is off by a factor is a further constant force",
            ),
            (
                "sensor_bias",
                "a constant force shifts the rest position, and so does a sensor that reads an offset",
            ),
        ]
    }

    fn experiment(&self) -> &'static str {
        "the machine at rest with and without the load, or with a known weight added"
    }
}
