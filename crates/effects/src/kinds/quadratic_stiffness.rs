//! A spring force that grows with the square of the displacement, the same way on both sides.

use simgap_integrate::exact::{ForceLaw, MemberMotion};
use simgap_integrate::lanes;

use crate::effect::{Action, Effect, Family, Parameter, SiteKind, SiteScale};

/// A spring force that grows with the square of the displacement, the same way on both sides.
///
/// ```text
/// F = k2 d^2
/// ```
pub(crate) struct QuadraticStiffness;

struct Law {
    factor: f64,
}

impl ForceLaw for Law {
    lanes!(factor);

    fn force(&self, motion: MemberMotion) -> f64 {
        self.factor * motion.displacement * motion.displacement
    }
}

impl Effect for QuadraticStiffness {
    fn kind(&self) -> &'static str {
        "quadratic_stiffness"
    }

    fn family(&self) -> Family {
        Family::Force
    }

    fn site(&self) -> SiteKind {
        SiteKind::Member
    }

    fn summary(&self) -> &'static str {
        "the spring is stiffer on one side than on the other, growing with the displacement"
    }

    fn equation(&self) -> &'static str {
        "F = k2 d^2"
    }

    fn parameters(&self) -> &'static [Parameter] {
        &[Parameter {
            name: "quadratic_stiffness_n_per_m2",
            unit: "N/m^2",
            lower: f64::NEG_INFINITY,
            upper: f64::INFINITY,
            neutral: Some(0.0),
            per_record: false,
        }]
    }

    fn starts(&self, scale: &SiteScale) -> Vec<Vec<f64>> {
        vec![vec![0.05 * scale.force_n / scale.displacement_m.powi(2)]]
    }

    fn action(&self, values: &[f64]) -> Action {
        Action::Force(Box::new(Law { factor: values[0] }))
    }

    fn experiment(&self) -> &'static str {
        "slow loading to both sides of the rest position"
    }
}
