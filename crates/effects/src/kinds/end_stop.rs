//! A stop that the motion runs into.

use simgap_integrate::exact::{ForceLaw, MemberMotion};
use simgap_integrate::lanes;

use crate::effect::{Action, Effect, Family, Parameter, SiteKind, SiteScale};
use crate::equivalent::SOFT;

/// A stop that the motion runs into, on either side.
///
/// ```text
/// F = k_c max(0, d − s_u + τ v)  for d > s_u,   F = k_c min(0, d + s_l + τ v)  for d < −s_l,   else 0
/// ```
/// A spring and a damper `c_c = k_c τ` beside it that push and never pull. A stop on one side only has the
/// other beyond reach.
///
/// Reference: \[Worden2001\], chapter 1.
pub(crate) struct EndStop;

/// A contact whose damping force is below this share of its spring force has none to be seen.
const ELASTIC: f64 = 0.02;
/// Contact stiffnesses that a fit starts from, as multiples of the spring of the place.
const HARDER: [f64; 2] = [5.0, 20.0];
/// Damping ratio of the lighter mass on the contact that a fit starts from.
const CONTACT_DAMPING: f64 = 0.1;

struct Law {
    upper: f64,
    lower: f64,
    stiffness: f64,
    damping_time_s: f64,
}

impl ForceLaw for Law {
    lanes!(upper, lower, stiffness, damping_time_s);

    fn force(&self, motion: MemberMotion) -> f64 {
        let (above, below) = (
            motion.displacement - self.upper,
            motion.displacement + self.lower,
        );
        // The damper sets in with a jump.
        let held = |inside: f64| self.damping_time_s * motion.velocity * motion.set_in(inside);
        let upper = (above.max(0.0) + held(above)).max(0.0);
        let lower = (below.min(0.0) + held(-below)).min(0.0);
        self.stiffness * (upper + lower)
    }

    fn is_spread_over_steps(&self) -> bool {
        self.damping_time_s > 0.0
    }
}

impl Effect for EndStop {
    fn kind(&self) -> &'static str {
        "end_stop"
    }

    fn family(&self) -> Family {
        Family::Force
    }

    fn site(&self) -> SiteKind {
        SiteKind::Member
    }

    fn summary(&self) -> &'static str {
        "the motion runs into a stop"
    }

    fn equation(&self) -> &'static str {
        "F = k_c max(0, d - s_u + tau v) (d > s_u), k_c min(0, d + s_l + tau v) (d < -s_l)"
    }

    fn reference(&self) -> Option<&'static str> {
        Some("[Worden2001], chapter 1")
    }

    fn parameters(&self) -> &'static [Parameter] {
        const {
            &[
                Parameter::limit("upper_stop_m", "m"),
                Parameter::limit("lower_stop_m", "m"),
                Parameter::shape("contact_stiffness_n_per_m", "N/m", 0.0, f64::INFINITY),
                Parameter::shape("contact_damping_time_s", "s", 0.0, f64::INFINITY),
            ]
        }
    }

    /// On both sides and on each, at two shares of the range and two stiffnesses. A stop on one side
    /// stands within the range where that does not hold zero.
    fn starts(&self, scale: &SiteScale) -> Vec<Vec<f64>> {
        let [low, high] = scale.displacement_range_m;
        let half = 0.5 * (high - low);
        let reach = high.max(-low);
        let far = 20.0 * reach;
        // From the far end inwards, in a motion about zero the same share of either side.
        let inside = |end: f64, share: f64| end - (1.0 - share) * half.min(end);
        let mut starts = vec![];
        for harder in HARDER {
            let stiffness = harder * scale.stiffness_n_per_m;
            let held = 2.0 * CONTACT_DAMPING * (scale.mass_kg / stiffness).sqrt();
            let held = if held.is_finite() { held } else { 0.0 };
            for share in [0.5, 0.75, 0.85] {
                let stop = share * reach;
                starts.push(vec![stop, stop, stiffness, held]);
                if high > 0.0 {
                    starts.push(vec![inside(high, share), far, stiffness, held]);
                }
                if low < 0.0 {
                    starts.push(vec![far, inside(-low, share), stiffness, held]);
                }
            }
        }
        starts
    }

    fn left_out(&self, parameter: &str) -> Option<f64> {
        (parameter == "contact_damping_time_s").then_some(0.0)
    }

    fn action(&self, values: &[f64]) -> Action {
        Action::Force(Box::new(Law {
            upper: values[0],
            lower: values[1],
            stiffness: values[2],
            damping_time_s: values[3],
        }))
    }

    /// A contact softer than the spring of the place stops nothing; an elastic one on one side that is about as soft is a
    /// spring with two slopes.
    fn has_support(&self, values: &[f64], scale: &SiteScale) -> bool {
        let [low, high] = scale.displacement_range_m;
        let both_sides = values[0] < high && -values[1] > low;
        let held = values[3] * scale.velocity_m_per_s > ELASTIC * scale.displacement_m;
        let over_spring = values[2] / scale.stiffness_n_per_m;
        !scale.has_spring || over_spring >= SOFT || ((both_sides || held) && over_spring >= 1.0)
    }

    fn confused_with(&self) -> &'static [(&'static str, &'static str)] {
        &[
            (
                "cubic_stiffness",
                "a soft contact over a wide range of motion hardens like a cubic spring",
            ),
            (
                "bilinear_stiffness",
                "a soft stop is a spring that is stiffer beyond a point",
            ),
            (
                "clipping",
                "the displacement stays within limits under both, but a stop also brakes the machine, and gives way a little under the force",
            ),
        ]
    }

    fn experiment(&self) -> &'static str {
        "slow motion over the whole range: the force rises steeply at the stop"
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_soft_contact_on_one_side_is_a_spring() {
        let scale = SiteScale {
            stiffness_n_per_m: 1e4,
            has_spring: true,
            ..SiteScale::plain(1e-3, 0.1, 100.0)
        };
        let [_, high] = scale.displacement_range_m;
        let keeps = |lower: f64, contact: f64, damping_time_s: f64| {
            EndStop.has_support(&[0.5 * high, lower, contact, damping_time_s], &scale)
        };
        assert!(keeps(20.0 * high, 4e4, 0.0) && !keeps(20.0 * high, 2e4, 0.0));
        assert!(keeps(0.5 * high, 2e4, 0.0) && keeps(20.0 * high, 2e4, 1e-3));
        assert!(!keeps(0.5 * high, 9e3, 1e-3));
    }
}
