//! Oil leaves the chambers of a cylinder.

use super::hydraulic::cylinder_at;
use crate::effect::{Action, Effect, Family, Parameter, SiteKind, SiteScale};
use crate::prior::Prior;

/// About one litre a minute at 10 MPa, m³/(s Pa).
const LEAKAGE: f64 = 2e-12;

/// Oil leaves the chambers of a cylinder.
///
/// ```text
/// Q = C p out of each chamber, beside the leakage of the model
/// ```
///
/// Reference: `merritt1967`, chapter 6.
pub(crate) struct ExternalLeakage;

impl Effect for ExternalLeakage {
    fn kind(&self) -> &'static str {
        "external_leakage"
    }

    fn family(&self) -> Family {
        Family::Force
    }

    fn site(&self) -> SiteKind {
        SiteKind::Chambers
    }

    fn summary(&self) -> &'static str {
        "oil leaks out of the chambers past the seal of the rod"
    }

    fn equation(&self) -> &'static str {
        "Q = C p out of each chamber"
    }

    fn reference(&self) -> Option<&'static str> {
        Some("[merritt1967], chapter 6")
    }

    fn parameters(&self) -> &'static [Parameter] {
        const {
            &[Parameter::size(
                "leakage_m3_per_s_per_pa",
                "m^3/s/Pa",
                0.0,
                1e-6,
            )]
        }
    }

    fn starts(&self, _: &SiteScale) -> Vec<Vec<f64>> {
        vec![vec![1e-12], vec![1e-11]]
    }

    fn prior(&self, _: usize, _: &SiteScale) -> Prior {
        Prior::size(LEAKAGE)
    }

    fn action(&self, values: &[f64]) -> Action {
        let value = values[0];
        Action::Model(Box::new(move |model, at| {
            if let Some(cylinder) = cylinder_at(model, at) {
                cylinder.external_leakage += value;
            }
        }))
    }

    fn confused_with(&self) -> &'static [(&'static str, &'static str)] {
        &[(
            "internal_leakage",
            "both damp the resonance of the oil; they differ in the sum of the two pressures",
        )]
    }

    fn experiment(&self) -> &'static str {
        "the valve shut and the rod held: both pressures fall"
    }
}
