//! Damping that grows with the square of the speed.

use simgap_integrate::exact::{ForceLaw, MemberMotion};
use simgap_integrate::lanes;

use crate::effect::{Action, Effect, Family, Parameter, SiteKind, SiteScale};

/// Damping that grows with the square of the speed.
///
/// ```text
/// F = q |v| v
/// ```
pub(crate) struct QuadraticDamping;

struct Law {
    factor: f64,
}

impl ForceLaw for Law {
    lanes!(factor);

    fn force(&self, motion: MemberMotion) -> f64 {
        self.factor * motion.velocity.abs() * motion.velocity
    }
}

impl Effect for QuadraticDamping {
    fn kind(&self) -> &'static str {
        "quadratic_damping"
    }

    fn family(&self) -> Family {
        Family::Force
    }

    fn site(&self) -> SiteKind {
        SiteKind::Member
    }

    fn summary(&self) -> &'static str {
        "damping grows with the square of the speed"
    }

    fn equation(&self) -> &'static str {
        "F = q |v| v"
    }

    fn parameters(&self) -> &'static [Parameter] {
        &[Parameter {
            name: "quadratic_damping_n_s2_per_m2",
            unit: "N s^2/m^2",
            lower: 0.0,
            upper: f64::INFINITY,
            neutral: Some(0.0),
            per_record: false,
        }]
    }

    fn is_loss_term(&self) -> bool {
        true
    }

    fn starts(&self, scale: &SiteScale) -> Vec<Vec<f64>> {
        vec![vec![0.05 * scale.force_n / scale.velocity_m_per_s.powi(2)]]
    }

    fn action(&self, values: &[f64]) -> Action {
        Action::Force(Box::new(Law { factor: values[0] }))
    }

    fn experiment(&self) -> &'static str {
        "the same motion at three times the speed: quadratic damping grows ninefold"
    }
}
