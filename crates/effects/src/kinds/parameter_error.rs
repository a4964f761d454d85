//! A parameter of a simulator differs from its nominal value by a factor.

use simgap_model::{Location, NominalQuantity};

use crate::effect::{Action, Effect, Family, Parameter, SiteKind, SiteScale};

/// Simulators divide by their parameters.
const LEAST: f64 = 0.01;

/// A parameter of a simulator of the user's differs from its nominal value by a factor.
pub(crate) struct ParameterError;

impl Effect for ParameterError {
    fn kind(&self) -> &'static str {
        "parameter_error"
    }

    fn family(&self) -> Family {
        Family::NominalParameter
    }

    fn site(&self) -> SiteKind {
        SiteKind::Parameter
    }

    fn summary(&self) -> &'static str {
        "a parameter of the simulator differs from its nominal value"
    }

    fn equation(&self) -> &'static str {
        "p = factor p_nominal"
    }

    fn parameters(&self) -> &'static [Parameter] {
        &[Parameter {
            name: "parameter_factor",
            unit: "1",
            lower: LEAST,
            upper: 1.0 / LEAST,
            neutral: Some(1.0),
            per_record: false,
        }]
    }

    fn starts(&self, _: &SiteScale) -> Vec<Vec<f64>> {
        vec![vec![1.05]]
    }

    fn nominal_quantity(&self) -> Option<NominalQuantity> {
        Some(NominalQuantity::PlantParameter)
    }

    fn action(&self, values: &[f64]) -> Action {
        let factor = values[0];
        Action::Model(Box::new(move |model, at| {
            if let Location::Parameter(name) = at {
                let here = model.plant_parameters.iter_mut();
                for parameter in here.filter(|parameter| &parameter.name == name) {
                    parameter.value *= factor;
                }
            }
        }))
    }

    fn experiment(&self) -> &'static str {
        "an experiment whose outcome hangs on this parameter more than on the others, or its measurement on the machine"
    }
}
