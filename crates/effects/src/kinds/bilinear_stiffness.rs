//! A spring that is stiffer on one side.

use simgap_integrate::exact::{ForceLaw, MemberMotion};
use simgap_integrate::lanes;

use crate::effect::{Action, Effect, Family, Parameter, SiteKind, SiteScale};
use crate::equivalent::SOFT;

/// A spring with two slopes: a crack that closes, a preload that is lost.
///
/// ```text
/// F = Δk max(d − b_u, 0) + Δk min(d + b_l, 0)   on top of the spring of the model
/// ```
/// A spring that changes on one side only has the other point beyond reach. Where the slope changes away from rest
/// and one side is several times as stiff as the other, it is called a stop.
///
/// Reference: \[Worden2001\], chapter 1.
pub(crate) struct BilinearStiffness;

/// A point of change within this share of the range of the motion is at rest.
const AT_REST: f64 = 0.05;
/// Points of change that a fit starts from, as shares of the farthest displacement.
const POINTS: [f64; 2] = [0.01, 0.3];

struct Law {
    change: f64,
    upper: f64,
    lower: f64,
}

impl ForceLaw for Law {
    lanes!(change, upper, lower);

    fn force(&self, motion: MemberMotion) -> f64 {
        let beyond = (motion.displacement - self.upper).max(0.0)
            + (motion.displacement + self.lower).min(0.0);
        self.change * beyond
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
        "the spring is stiffer on one side of a point than on the other"
    }

    fn equation(&self) -> &'static str {
        "F = dk max(d - b_u, 0) + dk min(d + b_l, 0)"
    }

    fn reference(&self) -> Option<&'static str> {
        Some("[Worden2001], chapter 1")
    }

    fn parameters(&self) -> &'static [Parameter] {
        const {
            &[
                Parameter::size(
                    "stiffness_change_n_per_m",
                    "N/m",
                    f64::NEG_INFINITY,
                    f64::INFINITY,
                ),
                Parameter::limit("upper_change_m", "m"),
                Parameter::limit("lower_change_m", "m"),
            ]
        }
    }

    /// On each side, at rest and away from it.
    fn starts(&self, scale: &SiteScale) -> Vec<Vec<f64>> {
        let change = 0.2 * scale.stiffness_n_per_m;
        let [low, high] = scale.displacement_range_m;
        let reach = high.max(-low);
        let far = 20.0 * reach;
        let at = POINTS.into_iter().map(|share| share * reach);
        at.flat_map(|at| [vec![change, at, far], vec![change, far, at]])
            .collect()
    }

    fn left_out(&self, parameter: &str) -> Option<f64> {
        match parameter {
            "upper_change_m" => Some(0.0),
            "lower_change_m" => Some(f64::MAX),
            _ => None,
        }
    }

    /// Alike on both sides, and beside a wrong stiffness, it is a law about rest, like a clearance, not one of two sides.
    fn coincidence(&self) -> Option<[usize; 2]> {
        Some([1, 2])
    }

    fn action(&self, values: &[f64]) -> Action {
        Action::Force(Box::new(Law {
            change: values[0],
            upper: values[1],
            lower: values[2],
        }))
    }

    fn has_support(&self, values: &[f64], scale: &SiteScale) -> bool {
        let [low, high] = scale.displacement_range_m;
        let sides = [scale.stiffness_n_per_m, scale.stiffness_n_per_m + values[0]];
        let (soft, stiff) = (sides[0].min(sides[1]), sides[0].max(sides[1]));
        values[1].min(values[2]) <= AT_REST * (high - low) || stiff <= (1.0 + SOFT) * soft
    }

    fn confused_with(&self) -> &'static [(&'static str, &'static str)] {
        &[
            (
                "quadratic_stiffness",
                "both are even in the displacement; only several amplitudes tell them apart",
            ),
            (
                "end_stop",
                "a soft stop is a spring that is stiffer beyond a point",
            ),
            (
                "stiffness_error",
                "the mean of the two sides is a stiffness error",
            ),
        ]
    }

    fn experiment(&self) -> &'static str {
        "slow loading over both signs of the displacement: the slope changes at a point"
    }
}
