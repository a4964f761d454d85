//! The gravity torque of an arm differs from its nominal value by a factor.

use simgap_model::{Location, NominalQuantity};

use crate::effect::{Action, Effect, Family, Parameter, SiteKind, SiteScale};

/// The gravity torque of an arm, `m g l sin(angle)`, differs from its nominal value by a factor.
pub(crate) struct PendulumError;

impl Effect for PendulumError {
    fn kind(&self) -> &'static str {
        "pendulum_error"
    }

    fn family(&self) -> Family {
        Family::NominalParameter
    }

    fn site(&self) -> SiteKind {
        SiteKind::Pendulum
    }

    fn summary(&self) -> &'static str {
        "the gravity torque of the arm differs from its nominal value"
    }

    fn equation(&self) -> &'static str {
        "m g l = factor (m g l)_nominal"
    }

    fn parameters(&self) -> &'static [Parameter] {
        const { &[Parameter::factor("pendulum_factor")] }
    }

    fn starts(&self, _: &SiteScale) -> Vec<Vec<f64>> {
        vec![vec![1.05]]
    }

    fn nominal_quantity(&self) -> Option<NominalQuantity> {
        Some(NominalQuantity::Pendulum)
    }

    fn action(&self, values: &[f64]) -> Action {
        let factor = values[0];
        Action::Model(Box::new(move |model, at| {
            if let Location::Mass(name) = at {
                let here = model.pendulums.iter_mut();
                here.filter(|arm| &arm.at == name)
                    .for_each(|arm| arm.value *= factor);
            }
        }))
    }

    fn confused_with(&self) -> &'static [(&'static str, &'static str)] {
        &[
            (
                "mass_error",
                "a free arm shows only the ratio of its torque to its inertia",
            ),
            (
                "linear_stiffness",
                "at small angles the gravity torque is a spring",
            ),
        ]
    }

    fn experiment(&self) -> &'static str {
        "a known torque that holds the arm at several angles: at rest its inertia has no part"
    }
}
