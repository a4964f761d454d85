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

    /// Of a damper that loses as much, where the motion is a sine; of a drive that does nothing below as much, where it moves one way.
    fn resembles(&self) -> &'static [&'static str] {
        &["damping_error", "input_dead_zone"]
    }

    /// A damper c that loses as much in a cycle of a sine as friction F: π c ω X² = 4 F X, or F = π/(2√2) c v with v the rms of the
    /// velocity (\[DenHartog1956\], chapter 8). A dead zone takes its half width from a force.
    fn grown_from(&self, kind: &str, values: &[f64], scale: &SiteScale) -> Vec<Vec<f64>> {
        let friction = match kind {
            "damping_error" => {
                let damping = values[0] * scale.damping_n_s_per_m;
                PI / (2.0 * SQRT_2) * damping * scale.velocity_m_per_s
            }
            "input_dead_zone" => values[0],
            _ => return vec![],
        };
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verify_friction_grown_from_a_damper_loses_as_much_in_a_cycle() {
        let (damping, speed, steps) = (30.0, 0.4_f64, 100_000);
        let scale = SiteScale::plain(1.0, speed / SQRT_2, 1.0).with_members(1.0, damping);
        let grown = CoulombFriction.grown_from("damping_error", &[0.5], &scale);
        let velocity = |n: usize| speed * (2.0 * PI * n as f64 / steps as f64).sin();
        let damper: f64 = (0..steps)
            .map(|n| 0.5 * damping * velocity(n).powi(2))
            .sum();
        let friction: f64 = (0..steps).map(|n| grown[0][0] * velocity(n).abs()).sum();
        assert!(
            (friction / damper - 1.0).abs() < 1e-6,
            "{friction} {damper}"
        );
        assert!(
            CoulombFriction
                .grown_from("stiffness_error", &[0.5], &scale)
                .is_empty()
        );
        assert!(
            CoulombFriction
                .grown_from("damping_error", &[0.0], &scale)
                .is_empty()
        );
    }
}
