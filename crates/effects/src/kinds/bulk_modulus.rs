//! The oil of a cylinder is softer or stiffer than the model says.

use super::hydraulic::cylinder_at;
use crate::effect::{Action, Effect, Family, Parameter, SiteKind, SiteScale};
use crate::prior::Prior;

/// The oil of a cylinder is softer or stiffer than the model says.
///
/// ```text
/// β = factor β_nominal
/// ```
///
/// Air in the oil makes it softer: 1.4 to 1.7 GPa without, 0.7 to 1.0 GPa with it (`merritt1967`, chapter 2).
pub(crate) struct BulkModulus;

impl Effect for BulkModulus {
    fn kind(&self) -> &'static str {
        "bulk_modulus"
    }

    fn family(&self) -> Family {
        Family::Dynamics
    }

    fn site(&self) -> SiteKind {
        SiteKind::Chambers
    }

    fn summary(&self) -> &'static str {
        "the oil is softer than the model says, as with air in it"
    }

    fn equation(&self) -> &'static str {
        "beta = factor beta_nominal"
    }

    fn reference(&self) -> Option<&'static str> {
        Some("[merritt1967], chapter 2")
    }

    fn parameters(&self) -> &'static [Parameter] {
        const {
            &[Parameter {
                lower: 0.01,
                ..Parameter::factor("bulk_modulus_factor")
            }]
        }
    }

    fn starts(&self, _: &SiteScale) -> Vec<Vec<f64>> {
        vec![vec![0.8]]
    }

    fn prior(&self, _: usize, _: &SiteScale) -> Prior {
        Prior::factor()
    }

    fn action(&self, values: &[f64]) -> Action {
        let value = values[0];
        Action::Model(Box::new(move |model, at| {
            if let Some(cylinder) = cylinder_at(model, at) {
                cylinder.bulk_modulus *= value;
            }
        }))
    }

    fn confused_with(&self) -> &'static [(&'static str, &'static str)] {
        &[(
            "mass_error",
            "both move the resonance of the oil; the pressures for the same acceleration tell them apart",
        )]
    }

    fn experiment(&self) -> &'static str {
        "excitation about the resonance of the oil, with the pressures measured"
    }
}
