//! The members of a place carry no more than so much.

use simgap_integrate::exact::{ForceLaw, MemberMotion};
use simgap_integrate::lanes;
use simgap_model::{Location, Model};

use super::members;
use crate::effect::{Action, Effect, Family, Parameter, SiteKind, SiteScale};

/// The springs and dampers of a place carry no more than a limit: the position loop of a servo at its largest torque, a clutch that
/// slips, a relief valve.
///
/// ```text
/// F = min(max(k d + c v, −F_l), F_u) instead of k d + c v                  (1)
/// ΔF = min(max(k d + c v, −F_l), F_u) − (k d + c v)   on top of them       (2)
/// ```
/// k and c are those of the springs and dampers of the model at the place. What slips comes back to where it was: the law has no memory. A
/// limit on one side only has the other beyond reach.
///
/// Reference: \[HuLin2001\], chapter 1.
pub(crate) struct ForceLimit;

/// Limits that a fit starts from, as shares of the largest force of the spring.
const SHARES: [f64; 4] = [0.05, 0.2, 0.5, 0.8];

struct Law {
    stiffness: f64,
    damping: f64,
    upper: f64,
    lower: f64,
}

impl ForceLaw for Law {
    lanes!(stiffness, damping, upper, lower);

    fn force(&self, motion: MemberMotion) -> f64 {
        let carried = self.stiffness * motion.displacement + self.damping * motion.velocity;
        carried.max(-self.lower).min(self.upper) - carried
    }
}

impl Effect for ForceLimit {
    fn kind(&self) -> &'static str {
        "force_limit"
    }

    fn family(&self) -> Family {
        Family::Force
    }

    fn site(&self) -> SiteKind {
        SiteKind::Spring
    }

    fn summary(&self) -> &'static str {
        "the spring, with the damper beside it, carries no more than a limit, as of a servo at its largest torque or a clutch that slips"
    }

    fn equation(&self) -> &'static str {
        "F = min(max(k d + c v, -F_l), F_u)"
    }

    fn reference(&self) -> Option<&'static str> {
        Some("[HuLin2001], chapter 1")
    }

    fn parameters(&self) -> &'static [Parameter] {
        const {
            &[
                Parameter::limit("upper_limit_n", "N"),
                Parameter::limit("lower_limit_n", "N"),
            ]
        }
    }

    /// The same on both sides. A limit that is not reached is moved out of reach by the fit.
    fn starts(&self, scale: &SiteScale) -> Vec<Vec<f64>> {
        let [low, high] = scale.displacement_range_m;
        let largest = scale.stiffness_n_per_m * high.max(-low);
        SHARES.map(|share| vec![share * largest; 2]).to_vec()
    }

    /// A spring that is slack beyond a point on either side carries hardly more there.
    fn resembles(&self) -> &'static [&'static str] {
        &["bilinear_stiffness"]
    }

    fn grown_from(&self, _kind: &str, values: &[f64], scale: &SiteScale) -> Vec<Vec<f64>> {
        let limits = [1, 2].map(|side| scale.stiffness_n_per_m * values[side]);
        let is_slack = values[0] < 0.0 && limits.iter().all(|limit| *limit > 0.0);
        is_slack.then(|| limits.to_vec()).into_iter().collect()
    }

    fn action(&self, values: &[f64]) -> Action {
        let [upper, lower] = [values[0], values[1]];
        Action::Member(Box::new(move |model: &Model, at: &Location| {
            let [stiffness, damping] = members::stiffness_and_damping(model, at);
            Box::new(Law {
                stiffness,
                damping,
                upper,
                lower,
            })
        }))
    }

    fn confused_with(&self) -> &'static [(&'static str, &'static str)] {
        &[
            (
                "stiffness_error",
                "of a motion of one amplitude the fundamental of a limited force is that of a softer spring",
            ),
            (
                "cubic_stiffness",
                "a force that levels off only a little is that of a softening spring",
            ),
            (
                "input_saturation",
                "what drives the place may be limited, not what it carries; a load then moves it further",
            ),
            (
                "hysteresis",
                "both level off, but a limit without memory lets go along the same line",
            ),
        ]
    }

    fn experiment(&self) -> &'static str {
        "the same motion at a tenth of the amplitude, inside the limits: the model agrees again"
    }
}
