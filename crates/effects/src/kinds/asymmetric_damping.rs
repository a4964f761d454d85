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

/// Density of the prior at values that give energy in one direction, as a share of that at the others.
const DRIVEN: f64 = 0.05;

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

/// Damping in each direction, that of the model included.
fn total(values: &[f64], scale: &SiteScale) -> [f64; 2] {
    let damper = match scale.has_damper {
        true => scale.damping_n_s_per_m,
        false => 0.0,
    };
    [0, 1].map(|direction| damper + values[direction])
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

    /// A damper of the model that is off damps alike in both directions.
    fn contains(&self) -> &'static [&'static str] {
        &["viscous_damping", "damping_error"]
    }

    fn grown_from(&self, kind: &str, values: &[f64], scale: &SiteScale) -> Vec<Vec<f64>> {
        match kind {
            "viscous_damping" => vec![vec![values[0], values[0]]],
            _ => self.starts(scale),
        }
    }

    /// The mean of both directions.
    fn shrunk_to(&self, kind: &str, values: &[f64], scale: &SiteScale) -> Option<Vec<f64>> {
        let mean = 0.5 * (values[0] + values[1]);
        match kind {
            "damping_error" => Some(vec![1.0 + mean / scale.damping_n_s_per_m]),
            _ => Some(vec![mean]),
        }
    }

    /// Together with the damper of the model it takes energy on the whole of a way there and back.
    fn has_support(&self, values: &[f64], scale: &SiteScale) -> bool {
        let [forward, backward] = total(values, scale);
        forward + backward >= 0.0
    }

    /// It takes energy in both directions, as every damper does, unless something drives the motion.
    fn weight(&self, values: &[f64], scale: &SiteScale) -> f64 {
        match total(values, scale).iter().all(|damping| *damping >= 0.0) {
            true => 1.0,
            false => DRIVEN,
        }
    }

    fn coincidence(&self) -> Option<[usize; 2]> {
        Some([0, 1])
    }

    fn action(&self, values: &[f64]) -> Action {
        Action::Force(Box::new(Law {
            forward: values[0],
            backward: values[1],
        }))
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
