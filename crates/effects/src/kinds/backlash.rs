//! Play in a spring.

use simgap_integrate::exact::{ForceLaw, MemberMotion};
use simgap_integrate::lanes;

use super::members;
use crate::effect::{Action, Effect, Family, Parameter, SiteKind, SiteScale};

/// Play in a spring of the model: it carries nothing until the play is used up.
///
/// ```text
/// F = k dz(d) instead of k d,   dz(d) = d − clamp(d, −g/2, g/2)          (1)
/// ΔF = −k clamp(d, −g/2, g/2)                   on top of the spring      (2)
/// ```
/// k is the stiffness of the springs of the model at the place; dampers there keep acting.
///
/// Reference: \[Nordin2002\].
pub(crate) struct Backlash;

struct Law {
    stiffness: f64,
    half_gap: f64,
}

impl ForceLaw for Law {
    lanes!(stiffness, half_gap);

    fn force(&self, motion: MemberMotion) -> f64 {
        -self.stiffness * motion.displacement.max(-self.half_gap).min(self.half_gap)
    }
}

impl Effect for Backlash {
    fn kind(&self) -> &'static str {
        "backlash"
    }

    fn family(&self) -> Family {
        Family::Force
    }

    fn site(&self) -> SiteKind {
        SiteKind::Spring
    }

    fn summary(&self) -> &'static str {
        "there is play in the spring: it carries nothing until the play is used up"
    }

    fn equation(&self) -> &'static str {
        "F = k (d - clamp(d, -g/2, g/2))"
    }

    fn reference(&self) -> Option<&'static str> {
        Some("[Nordin2002]")
    }

    fn parameters(&self) -> &'static [Parameter] {
        const { &[Parameter::size("gap_m", "m", 0.0, f64::INFINITY)] }
    }

    /// The force grows in proportion to a small play only: larger ones have starts of their own. What a stiff spring gives way is no
    /// measure of its play, which may be many times as wide.
    fn starts(&self, scale: &SiteScale) -> Vec<Vec<f64>> {
        [0.05, 0.2, 0.8, 3.0, 12.0, 50.0]
            .map(|share| vec![share * scale.displacement_m])
            .to_vec()
    }

    fn grows_in_proportion(&self) -> bool {
        false
    }

    fn action(&self, values: &[f64]) -> Action {
        let half_gap = 0.5 * values[0];
        Action::Member(Box::new(move |model, at| {
            let [stiffness, _] = members::stiffness_and_damping(model, at);
            Box::new(Law {
                stiffness,
                half_gap,
            })
        }))
    }

    fn confused_with(&self) -> &'static [(&'static str, &'static str)] {
        &[
            (
                "stiffness_error",
                "where the play is small against the motion the spring only seems softer",
            ),
            (
                "coulomb_friction",
                "a small play takes off a constant force that changes sign with the displacement, not the velocity",
            ),
        ]
    }

    fn experiment(&self) -> &'static str {
        "slow loading through zero in both directions: the displacement jumps by the play at zero force"
    }
}
