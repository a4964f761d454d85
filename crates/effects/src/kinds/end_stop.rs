//! A stop that the motion runs into.

use simgap_integrate::exact::{ForceLaw, MemberMotion};
use simgap_integrate::lanes;

use crate::effect::{Action, Effect, Family, Parameter, SiteKind, SiteScale};

/// A stop that the motion runs into, on either side.
///
/// ```text
/// F = k_c (d − s_u)  for d > s_u,   F = k_c (d + s_l)  for d < −s_l,   else 0
/// ```
/// A stop on one side only has the other beyond reach.
///
/// Reference: \[Worden2001\], chapter 1.
pub(crate) struct EndStop;

/// A gap below this share of the range of the motion is none.
const NO_GAP: f64 = 0.01;

struct Law {
    upper: f64,
    lower: f64,
    stiffness: f64,
}

impl ForceLaw for Law {
    lanes!(upper, lower, stiffness);

    fn force(&self, motion: MemberMotion) -> f64 {
        let beyond = (motion.displacement - self.upper).max(0.0)
            + (motion.displacement + self.lower).min(0.0);
        self.stiffness * beyond
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
        "F = k_c (d - s_u) (d > s_u), k_c (d + s_l) (d < -s_l)"
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
        for harder in [2.0, 20.0] {
            let stiffness = harder * scale.stiffness_n_per_m;
            for share in [0.5, 0.75] {
                let stop = share * reach;
                starts.push(vec![stop, stop, stiffness]);
                if high > 0.0 {
                    starts.push(vec![inside(high, share), far, stiffness]);
                }
                if low < 0.0 {
                    starts.push(vec![far, inside(-low, share), stiffness]);
                }
            }
        }
        starts
    }

    fn action(&self, values: &[f64]) -> Action {
        Action::Force(Box::new(Law {
            upper: values[0],
            lower: values[1],
            stiffness: values[2],
        }))
    }

    fn misnomer(&self, ci95: &[[f64; 2]], scale: &SiteScale) -> Option<&'static str> {
        let [low, high] = scale.displacement_range_m;
        let nothing = NO_GAP * (high - low);
        let mut gaps = ci95.iter().take(2);
        let has_none = gaps.any(|[least, most]| *least <= 0.0 && *most < nothing);
        // Where the model has no spring, a bumper that is touched at rest has no other name.
        (has_none && scale.has_spring)
            .then_some("a stop without a gap is a spring that is stiffer on that side")
    }

    fn confused_with(&self) -> &'static [(&'static str, &'static str)] {
        &[
            (
                "cubic_stiffness",
                "a soft contact over a wide range of motion hardens like a cubic spring",
            ),
            (
                "clipping",
                "the displacement stays within limits under both, but a stop also brakes the machine",
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
    fn a_stop_without_a_gap_is_misnamed() {
        let scale = SiteScale::plain(1e-3, 0.1, 100.0);
        let range = scale.displacement_range_m[1] - scale.displacement_range_m[0];
        let of = |upper: [f64; 2]| EndStop.misnomer(&[upper, [5e-4, 6e-4], [1e4, 2e4]], &scale);
        assert!(of([0.0, 1e-3 * range]).is_some());
        // A wide interval that holds zero says nothing about the gap; one away from zero says that there is one.
        assert!(of([0.0, 0.1 * range]).is_none());
        assert!(of([1e-3 * range, 2e-3 * range]).is_none());
        let free = SiteScale {
            has_spring: false,
            ..scale
        };
        let bumper = EndStop.misnomer(&[[0.0, 1e-3 * range], [5e-4, 6e-4], [1e4, 2e4]], &free);
        assert!(bumper.is_none());
    }
}
