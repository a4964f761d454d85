//! A constant force on a mass.

use simgap_integrate::exact::{ForceLaw, MemberMotion};
use simgap_integrate::lanes;

use crate::effect::{Action, Effect, Family, Parameter, SiteKind, SiteScale};
use crate::line::Line;

/// A constant force on a mass.
///
/// ```text
/// F = F0
/// ```
pub(crate) struct ConstantForce;

struct Law {
    force: f64,
}

impl ForceLaw for Law {
    lanes!(force);

    /// A force on the mass is one its tie to the ground carries with the opposite sign.
    fn force(&self, _: MemberMotion) -> f64 {
        -self.force
    }
}

impl Effect for ConstantForce {
    fn kind(&self) -> &'static str {
        "constant_force"
    }

    fn family(&self) -> Family {
        Family::Force
    }

    fn site(&self) -> SiteKind {
        SiteKind::Mass
    }

    fn summary(&self) -> &'static str {
        "a constant force acts that the model lacks"
    }

    fn equation(&self) -> &'static str {
        "F = F0"
    }

    fn parameters(&self) -> &'static [Parameter] {
        &[Parameter {
            name: "force_n",
            unit: "N",
            lower: f64::NEG_INFINITY,
            upper: f64::INFINITY,
            neutral: Some(0.0),
            per_record: false,
        }]
    }

    fn starts(&self, scale: &SiteScale) -> Vec<Vec<f64>> {
        vec![vec![0.05 * scale.force_n]]
    }

    fn line(&self, values: &[f64]) -> Option<Line> {
        Some(Line::constant(values[0]))
    }

    fn action(&self, values: &[f64]) -> Action {
        Action::Force(Box::new(Law { force: values[0] }))
    }

    fn experiment(&self) -> &'static str {
        "a record at rest with the drive off, beside one with the sensor on a fixed reference"
    }
}
