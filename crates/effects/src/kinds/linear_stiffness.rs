//! A spring the model lacks altogether.

use simgap_model::{Location, Spring};

use crate::effect::{Action, Effect, Family, Parameter, SiteKind, SiteScale};

/// A spring the model lacks altogether.
///
/// ```text
/// F = k d
/// ```
pub(crate) struct LinearStiffness;

impl Effect for LinearStiffness {
    fn kind(&self) -> &'static str {
        "linear_stiffness"
    }

    fn family(&self) -> Family {
        Family::Force
    }

    fn site(&self) -> SiteKind {
        SiteKind::NoSpring
    }

    fn summary(&self) -> &'static str {
        "a spring acts where the model has none"
    }

    fn equation(&self) -> &'static str {
        "F = k d"
    }

    fn parameters(&self) -> &'static [Parameter] {
        &[Parameter {
            name: "stiffness_n_per_m",
            unit: "N/m",
            lower: f64::NEG_INFINITY,
            upper: f64::INFINITY,
            neutral: Some(0.0),
            per_record: false,
        }]
    }

    fn starts(&self, scale: &SiteScale) -> Vec<Vec<f64>> {
        vec![vec![0.05 * scale.force_n / scale.displacement_m]]
    }

    fn action(&self, values: &[f64]) -> Action {
        let stiffness = values[0];
        Action::Model(Box::new(move |model, at| {
            if let Location::Between(between) = at {
                model.springs.push(Spring {
                    name: format!("linear_stiffness {}", model.springs.len() + 1),
                    between: between.clone(),
                    stiffness,
                    uncertainty: None,
                });
            }
        }))
    }

    fn experiment(&self) -> &'static str {
        "slow loading at several positions: the force grows with the position alone"
    }
}
