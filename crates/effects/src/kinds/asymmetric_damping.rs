//! Viscous damping that differs by the direction of motion, in addition to the nominal damper.

use simgap_integrate::exact::{ForceLaw, MemberMotion};

use crate::effect::{Action, Effect, Family, Parameter, SiteKind, SiteScale};

/// Viscous damping that differs by the direction of motion, in addition to the nominal damper.
///
/// ```text
/// F = c_forward v for v > 0, c_backward v for v < 0
/// ```
pub(crate) struct AsymmetricDamping;

struct Law {
    forward: f64,
    backward: f64,
}

impl ForceLaw for Law {
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
        "damping differs by the direction of motion"
    }

    fn equation(&self) -> &'static str {
        "F = c_forward v for v > 0, c_backward v for v < 0"
    }

    fn parameters(&self) -> &'static [Parameter] {
        &[
            Parameter {
                name: "forward_damping_n_s_per_m",
                unit: "N s/m",
                lower: f64::NEG_INFINITY,
                upper: f64::INFINITY,
                neutral: Some(0.0),
            },
            Parameter {
                name: "backward_damping_n_s_per_m",
                unit: "N s/m",
                lower: f64::NEG_INFINITY,
                upper: f64::INFINITY,
                neutral: Some(0.0),
            },
        ]
    }

    fn starts(&self, scale: &SiteScale) -> Vec<Vec<f64>> {
        {
            let damping = 0.05 * scale.force_n / scale.velocity_m_per_s;
            vec![vec![damping, -damping]]
        }
    }

    fn action(&self, values: &[f64]) -> Action {
        Action::Force(Box::new(Law {
            forward: values[0],
            backward: values[1],
        }))
    }

    fn experiment(&self) -> &'static str {
        "constant speed forwards and back, at several speeds"
    }
}
