//! Friction that gives like a spring before it slides (Dahl, LuGre).

use simgap_integrate::exact::{Followed, ForceLaw, MemberMotion, elementary};
use simgap_integrate::lanes;

use super::slid;
use crate::effect::{Action, Effect, Family, Parameter, SiteKind, SiteScale};

/// Friction that gives like a spring, with a damper beside it, before it slides.
///
/// ```text
/// F = F_e + τ dF_e/dt,   dF_e/dd = (F_c / d_p) (1 − (F_e / F_c) sgn ḋ)              (1)
/// ```
///
/// Over a monotone move Δd, (1) is solved exactly:
///
/// ```text
/// F_e1 = s F_c + (F_e0 − s F_c) exp(−|Δd| / d_p),   s = sgn Δd                      (2)
/// ```
///
/// The stiffness before sliding is σ₀ = F_c / d_p. The presliding displacement d_p shapes the loop, the
/// friction F_c sizes it. With τ = 0 it is Dahl's law; with the bristle deflection z = F_e / σ₀ and the
/// bristle damping σ₁ = τ σ₀ it is the LuGre law F = σ₀ z + σ₁ ż whose Stribeck curve is flat. In full sliding the damper
/// rests. What grows with the speed there (σ₂ ḋ) is viscous damping.
///
/// Reference: \[Dahl1968\], \[CanudasDeWit1995\].
pub(crate) struct PreslidingFriction;

/// Presliding displacements to start from, as shares of the motion.
const SHARES: [f64; 3] = [0.02, 0.15, 0.8];
/// Damping ratio of the mass on the stiffness before sliding, to start from.
const DAMPING: f64 = 0.1;

struct Law {
    friction: f64,
    displacement: f64,
    damping_time_s: f64,
    start: f64,
}

impl Law {
    /// τ dF_e/dt by (1) where F_e is `force`.
    #[inline(always)]
    fn damped(&self, force: f64, velocity: f64) -> f64 {
        let rate = (self.friction * velocity - force * velocity.abs()) / self.displacement;
        let damped = self.damping_time_s * rate;
        // What gives way by nothing has no bristles.
        if self.displacement > 0.0 { damped } else { 0.0 }
    }
}

impl ForceLaw for Law {
    lanes!(friction, displacement, damping_time_s, start);

    fn force(&self, motion: MemberMotion) -> f64 {
        let elastic = self.start * self.friction;
        elastic + self.damped(elastic, motion.velocity)
    }

    fn remembers(&self) -> bool {
        true
    }

    fn first_memory(&self) -> f64 {
        self.start * self.friction
    }

    /// (2); the memory is F_e.
    // Without exits, so that it becomes vector instructions.
    #[inline(always)]
    fn follow_step(&self, memory: f64, _: f64, from: MemberMotion, to: MemberMotion) -> Followed {
        let moved = to.displacement - from.displacement;
        let level = self.friction.copysign(moved);
        let decay = elementary::exp(-moved.abs() / self.displacement);
        let pulled = level + (memory - level) * decay;
        let held = if moved == 0.0 { memory } else { pulled };
        let elastic = if self.friction > 0.0 { held } else { 0.0 };
        Followed::arrived(elastic + self.damped(elastic, to.velocity), elastic)
    }
}

/// Of a friction that may follow from the presliding displacement.
fn starts(friction: impl Fn(f64) -> f64, scale: &SiteScale) -> Vec<Vec<f64>> {
    let start = |share: f64| {
        let displacement = share * scale.displacement_m;
        let friction = friction(displacement);
        let damping_time = 2.0 * DAMPING * (scale.mass_kg * displacement / friction).sqrt();
        // A place without a mass has the time scale of its motion.
        let of_motion = DAMPING * scale.displacement_m / scale.velocity_m_per_s;
        let known = damping_time.is_finite() && damping_time > 0.0;
        let damping_time = if known { damping_time } else { of_motion };
        vec![friction, displacement, damping_time, 0.0]
    };
    SHARES.map(start).to_vec()
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
        "F = F_e + tau dF_e/dt, dF_e/dd = (F_c / d_p) (1 - (F_e / F_c) sgn d')"
    }

    fn reference(&self) -> Option<&'static str> {
        Some("[Dahl1968], [CanudasDeWit1995]")
    }

    fn parameters(&self) -> &'static [Parameter] {
        const {
            &[
                Parameter::size("friction_force_n", "N", 0.0, f64::INFINITY),
                Parameter::shape("presliding_displacement_m", "m", 0.0, f64::INFINITY),
                Parameter::shape("damping_time_s", "s", 0.0, f64::INFINITY),
                Parameter::size("start_share", "1", -1.0, 1.0).of_record(),
            ]
        }
    }

    fn starts(&self, scale: &SiteScale) -> Vec<Vec<f64>> {
        starts(|_| 0.1 * scale.force_n, scale)
    }

    fn contains(&self) -> &'static [&'static str] {
        &["coulomb_friction"]
    }

    /// It slides along the travel of a record: what never does is a spring with another origin in each record.
    fn has_support(&self, values: &[f64], scale: &SiteScale) -> bool {
        values[1] <= scale.travel_m
    }

    /// Short of the presliding displacement it is a spring.
    fn turns_into(&self) -> &'static [&'static str] {
        &["linear_stiffness"]
    }

    fn grown_from(&self, kind: &str, values: &[f64], scale: &SiteScale) -> Vec<Vec<f64>> {
        match kind {
            "coulomb_friction" => starts(|_| values[0], scale),
            _ if values[0] > 0.0 => starts(|displacement| values[0] * displacement, scale),
            _ => vec![],
        }
    }

    fn shrunk_to(&self, kind: &str, values: &[f64], _: &SiteScale) -> Option<Vec<f64>> {
        (kind == "linear_stiffness").then(|| vec![values[0] / values[1]])
    }

    fn left_out(&self, parameter: &str) -> Option<f64> {
        (parameter == "damping_time_s").then_some(0.0)
    }

    fn own_starts(&self, values: &[f64]) -> Vec<Vec<f64>> {
        slid::starts(values, 3)
    }

    fn action(&self, values: &[f64]) -> Action {
        Action::Force(Box::new(Law {
            friction: values[0],
            displacement: values[1],
            damping_time_s: values[2],
            start: values[3],
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
                "without damping it is a Bouc-Wen hysteresis with n = 1 and gamma = 0",
            ),
        ]
    }

    fn experiment(&self) -> &'static str {
        "small reversals after large ones: before it slides the member moves in proportion to the force"
    }
}
