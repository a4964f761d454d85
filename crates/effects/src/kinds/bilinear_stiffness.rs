//! A spring that is stiffer on one side.

use simgap_integrate::exact::{ForceLaw, MemberMotion};
use simgap_integrate::lanes;

use crate::effect::{Action, Effect, Family, Parameter, SiteKind, SiteScale};

/// A spring that is stiffer on one side: a crack that closes, a preload that is lost.
///
/// ```text
/// F = Δk max(d, 0)   on top of the spring of the model
/// ```
///
/// Reference: \[Worden2001\], chapter 1.
pub(crate) struct BilinearStiffness;

struct Law {
    change: f64,
}

impl ForceLaw for Law {
    lanes!(change);

    fn force(&self, motion: MemberMotion) -> f64 {
        self.change * motion.displacement.max(0.0)
    }
}

impl Effect for BilinearStiffness {
    fn kind(&self) -> &'static str {
        "bilinear_stiffness"
    }

    fn family(&self) -> Family {
        Family::Force
    }

    fn site(&self) -> SiteKind {
        SiteKind::Spring
    }

    fn summary(&self) -> &'static str {
        "the spring is stiffer on one side of zero than on the other"
    }

    fn equation(&self) -> &'static str {
        "F = dk max(d, 0)"
    }

    fn reference(&self) -> Option<&'static str> {
        Some("[Worden2001], chapter 1")
    }

    fn parameters(&self) -> &'static [Parameter] {
        const {
            &[Parameter::size(
                "stiffness_change_n_per_m",
                "N/m",
                f64::NEG_INFINITY,
                f64::INFINITY,
            )]
        }
    }

    fn starts(&self, scale: &SiteScale) -> Vec<Vec<f64>> {
        vec![vec![0.2 * scale.stiffness_n_per_m]]
    }

    fn action(&self, values: &[f64]) -> Action {
        Action::Force(Box::new(Law { change: values[0] }))
    }

    fn confused_with(&self) -> &'static [(&'static str, &'static str)] {
        &[
            (
                "quadratic_stiffness",
                "both are even in the displacement; only several amplitudes tell them apart",
            ),
            (
                "stiffness_error",
                "the mean of the two sides is a stiffness error",
            ),
        ]
    }

    fn experiment(&self) -> &'static str {
        "slow loading over both signs of the displacement: the slope changes at zero"
    }
}
