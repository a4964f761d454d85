//! Damping that differs between the two directions of motion.

use simgap_integrate::exact::{ForceLaw, MemberMotion};
use simgap_integrate::lanes;

use crate::effect::{Action, Effect, Family, Parameter, SiteKind, SiteScale};

/// Damping that differs between the two directions of motion, on top of the damper of the model.
///
/// ```text
/// F = c_f v  for v > 0,   F = c_b v  for v < 0
/// ```
///
/// Reference: \[Janot2019\], for a positioning axis.
pub(crate) struct AsymmetricDamping;

/// Dampings whose intervals overlap and that are apart by less than this share of the larger are one.
const ONE_DAMPING: f64 = 0.05;

/// How far apart two dampings are whose intervals overlap, as a share of the larger; `None` where they do not.
fn overlap(ci95: &[[f64; 2]]) -> Option<f64> {
    let &[[low, high], [other_low, other_high]] = ci95 else {
        return None;
    };
    let middles = [0.5 * (low + high), 0.5 * (other_low + other_high)];
    let apart = (middles[0] - middles[1]).abs() / middles[0].abs().max(middles[1].abs());
    (low <= other_high && other_low <= high).then_some(apart)
}

struct Law {
    forward: f64,
    backward: f64,
}

impl ForceLaw for Law {
    lanes!(forward, backward);

    fn force(&self, motion: MemberMotion) -> f64 {
        let damping = if motion.velocity > 0.0 {
            self.forward
        } else {
            self.backward
        };
        damping * motion.velocity
    }
}

impl Effect for AsymmetricDamping {
    fn kind(&self) -> &'static str {
        "asymmetric_damping"
    }

    fn family(&self) -> Family {
        Family::Force
    }

    fn site(&self) -> SiteKind {
        SiteKind::Member
    }

    fn summary(&self) -> &'static str {
        "the damping differs between the two directions of motion"
    }

    fn equation(&self) -> &'static str {
        "F = c_f v (v > 0), c_b v (v < 0)"
    }

    fn reference(&self) -> Option<&'static str> {
        Some("[Janot2019], for a positioning axis")
    }

    fn parameters(&self) -> &'static [Parameter] {
        const {
            &[
                Parameter::size(
                    "damping_forward_n_s_per_m",
                    "N s/m",
                    f64::NEG_INFINITY,
                    f64::INFINITY,
                ),
                Parameter::size(
                    "damping_backward_n_s_per_m",
                    "N s/m",
                    f64::NEG_INFINITY,
                    f64::INFINITY,
                ),
            ]
        }
    }

    /// One start is enough: both sizes, of either sign, follow from it in proportion.
    fn starts(&self, scale: &SiteScale) -> Vec<Vec<f64>> {
        let damping = 0.1 * scale.force_n / scale.velocity_m_per_s;
        vec![vec![damping, -damping]]
    }

    fn contains(&self) -> &'static [&'static str] {
        &["viscous_damping"]
    }

    fn grown_from(&self, _: &str, values: &[f64], _: &SiteScale) -> Vec<Vec<f64>> {
        vec![vec![values[0], values[0]]]
    }

    fn action(&self, values: &[f64]) -> Action {
        Action::Force(Box::new(Law {
            forward: values[0],
            backward: values[1],
        }))
    }

    fn doubt(&self, ci95: &[[f64; 2]], _: &SiteScale) -> Option<&'static str> {
        overlap(ci95)
            .is_some()
            .then_some("the intervals of its two dampings overlap: one damping may do")
    }

    fn misnomer(&self, ci95: &[[f64; 2]], _: &SiteScale) -> Option<&'static str> {
        // Where only the two together are known badly, wide intervals overlap however far they are apart.
        overlap(ci95).filter(|apart| *apart < ONE_DAMPING)?;
        Some(
            "one damping would do in the place of its two, which are the same but for their intervals",
        )
    }

    fn confused_with(&self) -> &'static [(&'static str, &'static str)] {
        &[(
            "quadratic_damping",
            "over one range of speeds in one direction both only change the slope",
        )]
    }

    fn experiment(&self) -> &'static str {
        "constant speeds in both directions: the force against the speed has another slope on each side"
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_dampings_that_are_one_are_no_asymmetry() {
        let scale = SiteScale::plain(1e-3, 0.1, 100.0);
        let misnomer = |ci95: [[f64; 2]; 2]| AsymmetricDamping.misnomer(&ci95, &scale).is_some();
        assert!(misnomer([[140.0, 177.0], [138.0, 175.0]]));
        assert!(misnomer([[-3.05, -2.38], [-3.03, -2.36]]));
        assert!(!misnomer([[100.0, 101.0], [103.0, 104.0]]));
        // Apart; and apart by more than either is known, the two together known badly.
        assert!(!misnomer([[140.0, 150.0], [160.0, 170.0]]));
        assert!(!misnomer([[-6.6, 4.8], [-0.9, 10.6]]));
        assert!(!misnomer([[35.0, 45.0], [-45.0, -35.0]]));
        // In doubt all the same.
        let doubt = |ci95: [[f64; 2]; 2]| AsymmetricDamping.doubt(&ci95, &scale).is_some();
        assert!(doubt([[-6.6, 4.8], [-0.9, 10.6]]) && !doubt([[140.0, 150.0], [160.0, 170.0]]));
    }
}
