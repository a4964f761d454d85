//! Dry friction of constant level.

use std::f64::consts::{PI, SQRT_2};

use simgap_integrate::exact::{ForceLaw, MemberMotion};
use simgap_integrate::lanes;

use crate::effect::{Action, Effect, Family, Parameter, SiteKind, SiteScale};

/// Dry friction of constant level.
///
/// ```text
/// F = Fc sgn(v), |F| <= Fc at rest
/// ```
pub(crate) struct CoulombFriction;

struct Law {
    level: f64,
}

impl ForceLaw for Law {
    lanes!(level);

    fn force(&self, _: MemberMotion) -> f64 {
        0.0
    }

    fn dry_level(&self, _: f64) -> Option<f64> {
        Some(self.level)
    }
}

impl Effect for CoulombFriction {
    fn kind(&self) -> &'static str {
        "coulomb_friction"
    }

    fn family(&self) -> Family {
        Family::Force
    }

    fn site(&self) -> SiteKind {
        SiteKind::Member
    }

    fn summary(&self) -> &'static str {
        "dry friction of constant level opposes the motion"
    }

    fn equation(&self) -> &'static str {
        "F = Fc sgn(v), |F| <= Fc at rest"
    }

    fn parameters(&self) -> &'static [Parameter] {
        &[Parameter {
            name: "friction_force_n",
            unit: "N",
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
        vec![vec![0.1 * scale.force_n]]
    }

    /// Of a damper that loses as much, where the motion is a sine.
    fn resembles(&self) -> &'static [&'static str] {
        &["damping_error"]
    }

    /// A damper c that loses as much in a cycle of a sine as friction F: π c ω X² = 4 F X, or F = π/(2√2) c v with v the rms of the
    /// velocity ([Inman2014], section 2.7).
    fn grown_from(&self, kind: &str, values: &[f64], scale: &SiteScale) -> Vec<Vec<f64>> {
        if !self.resembles().contains(&kind) {
            return vec![];
        }
        let damping = values[0] * scale.damping_n_s_per_m;
        let friction = PI / (2.0 * SQRT_2) * damping * scale.velocity_m_per_s;
        let is_start = friction > 0.0 && friction.is_finite();
        is_start.then(|| vec![friction]).into_iter().collect()
    }

    fn action(&self, values: &[f64]) -> Action {
        Action::Force(Box::new(Law { level: values[0] }))
    }

    fn experiment(&self) -> &'static str {
        "the same motion at a tenth of the amplitude: friction of constant level then dominates"
    }
}
