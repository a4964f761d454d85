//! Friction that gives like a spring before it slides (Dahl).

use simgap_integrate::exact::{Followed, ForceLaw, MemberMotion, elementary};
use simgap_integrate::lanes;

use crate::effect::{Action, Effect, Family, Parameter, SiteKind, SiteScale};

/// Friction that gives like a spring before it slides (Dahl).
///
/// ```text
/// dF/dd = (F_c / d_p) (1 − (F / F_c) sgn ḋ)                                         (1)
/// ```
///
/// Over a monotone move Δd, (1) is solved exactly:
///
/// ```text
/// F₁ = s F_c + (F₀ − s F_c) exp(−|Δd| / d_p),   s = sgn Δd                          (2)
/// ```
///
/// The stiffness before sliding is σ = F_c / d_p. The presliding displacement d_p shapes the loop, the
/// friction F_c sizes it.
///
/// Reference: \[Dahl1968\].
pub(crate) struct PreslidingFriction;

struct Law {
    friction: f64,
    displacement: f64,
    start: f64,
}

impl ForceLaw for Law {
    lanes!(friction, displacement, start);

    fn force(&self, _: MemberMotion) -> f64 {
        self.start * self.friction
    }

    fn remembers(&self) -> bool {
        true
    }

    fn first_memory(&self) -> f64 {
        self.start * self.friction
    }

    /// (2); the memory is the force.
    // Without exits, so that it becomes vector instructions.
    #[inline(always)]
    fn follow_step(&self, memory: f64, _: f64, from: MemberMotion, to: MemberMotion) -> Followed {
        let moved = to.displacement - from.displacement;
        let level = self.friction.copysign(moved);
        let decay = elementary::exp(-moved.abs() / self.displacement);
        let pulled = level + (memory - level) * decay;
        let held = if moved == 0.0 { memory } else { pulled };
        let force = if self.friction > 0.0 { held } else { 0.0 };
        Followed::arrived(force, force)
    }
}

impl Effect for PreslidingFriction {
    fn kind(&self) -> &'static str {
        "presliding_friction"
    }

    fn family(&self) -> Family {
        Family::Force
    }

    fn site(&self) -> SiteKind {
        SiteKind::Member
    }

    fn summary(&self) -> &'static str {
        "friction gives like a spring before it slides"
    }

    fn equation(&self) -> &'static str {
        "dF/dd = (F_c / d_p) (1 - (F / F_c) sgn d')"
    }

    fn reference(&self) -> Option<&'static str> {
        Some("[Dahl1968]")
    }

    fn parameters(&self) -> &'static [Parameter] {
        const {
            &[
                Parameter::size("friction_force_n", "N", 0.0, f64::INFINITY),
                Parameter::shape("presliding_displacement_m", "m", 0.0, f64::INFINITY),
                Parameter::size("start_share", "1", -1.0, 1.0).of_record(),
            ]
        }
    }

    fn starts(&self, scale: &SiteScale) -> Vec<Vec<f64>> {
        let friction = 0.1 * scale.force_n;
        [0.02, 0.15, 0.8]
            .map(|share| vec![friction, share * scale.displacement_m, 0.0])
            .to_vec()
    }

    fn contains(&self) -> &'static [&'static str] {
        &["coulomb_friction"]
    }

    fn grown_from(&self, _kind: &str, values: &[f64], scale: &SiteScale) -> Vec<Vec<f64>> {
        [0.02, 0.15, 0.8]
            .map(|share| vec![values[0], share * scale.displacement_m, 0.0])
            .to_vec()
    }

    fn action(&self, values: &[f64]) -> Action {
        Action::Force(Box::new(Law {
            friction: values[0],
            displacement: values[1],
            start: values[2],
        }))
    }

    fn confused_with(&self) -> &'static [(&'static str, &'static str)] {
        &[
            (
                "coulomb_friction",
                "where the motion is large against the presliding displacement",
            ),
            (
                "hysteresis",
                "Dahl friction is a Bouc-Wen hysteresis with n = 1 and gamma = 0",
            ),
        ]
    }

    fn experiment(&self) -> &'static str {
        "small reversals after large ones: before it slides the member moves in proportion to the force"
    }
}
