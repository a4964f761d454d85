//! A spring that hardens or softens with the cube of the displacement.

use simgap_integrate::exact::{ForceLaw, MemberMotion};
use simgap_integrate::lanes;

use crate::effect::{Action, Effect, Family, Parameter, SiteKind, SiteScale};

/// A spring that hardens or softens with the cube of the displacement.
///
/// ```text
/// F = k3 d^3
/// ```
pub(crate) struct CubicStiffness;

struct Law {
    factor: f64,
}

impl ForceLaw for Law {
    lanes!(factor);

    fn force(&self, motion: MemberMotion) -> f64 {
        self.factor * motion.displacement * motion.displacement * motion.displacement
    }
}

impl Effect for CubicStiffness {
    fn kind(&self) -> &'static str {
        "cubic_stiffness"
    }

    fn family(&self) -> Family {
        Family::Force
    }

    fn site(&self) -> SiteKind {
        SiteKind::Member
    }

    fn summary(&self) -> &'static str {
        "the spring hardens (or softens) with the cube of the displacement"
    }

    fn equation(&self) -> &'static str {
        "F = k3 d^3"
    }

    fn parameters(&self) -> &'static [Parameter] {
        &[Parameter {
            name: "cubic_stiffness_n_per_m3",
            unit: "N/m^3",
            lower: f64::NEG_INFINITY,
            upper: f64::INFINITY,
            neutral: Some(0.0),
            per_record: false,
        }]
    }

    fn starts(&self, scale: &SiteScale) -> Vec<Vec<f64>> {
        vec![vec![0.05 * scale.force_n / scale.displacement_m.powi(3)]]
    }

    fn action(&self, values: &[f64]) -> Action {
        Action::Force(Box::new(Law { factor: values[0] }))
    }

    fn experiment(&self) -> &'static str {
        "the same excitation at several amplitudes: the natural frequency moves with the amplitude"
    }
}
