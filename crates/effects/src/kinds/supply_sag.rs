//! The supply pressure falls while a valve draws oil.

use super::hydraulic::valve_at;
use crate::effect::{Action, Effect, Family, Parameter, SiteKind, SiteScale};
use crate::prior::Prior;

/// About 2 MPa at sixty litres a minute, Pa s/m³.
const DROOP: f64 = 2e9;

/// The supply pressure falls while a valve draws oil.
///
/// ```text
/// p_s = p_s0 − R Q, with Q what the valve draws; R beside the droop of the model
/// ```
///
/// Reference: `merritt1967`, chapter 3.
pub(crate) struct SupplySag;

impl Effect for SupplySag {
    fn kind(&self) -> &'static str {
        "supply_sag"
    }

    fn family(&self) -> Family {
        Family::Force
    }

    fn site(&self) -> SiteKind {
        SiteKind::Spool
    }

    fn summary(&self) -> &'static str {
        "the supply pressure falls while the valve draws oil"
    }

    fn equation(&self) -> &'static str {
        "p_s = p_s0 - R Q"
    }

    fn reference(&self) -> Option<&'static str> {
        Some("[merritt1967], chapter 3")
    }

    fn parameters(&self) -> &'static [Parameter] {
        const { &[Parameter::size("droop_pa_s_per_m3", "Pa s/m^3", 0.0, 1e15)] }
    }

    fn starts(&self, _: &SiteScale) -> Vec<Vec<f64>> {
        vec![vec![1e9], vec![1e10]]
    }

    fn prior(&self, _: usize, _: &SiteScale) -> Prior {
        Prior::size(DROOP)
    }

    fn action(&self, values: &[f64]) -> Action {
        let value = values[0];
        Action::Model(Box::new(move |model, at| {
            if let Some(valve) = valve_at(model, at) {
                valve.supply_droop += value;
            }
        }))
    }

    fn confused_with(&self) -> &'static [(&'static str, &'static str)] {
        &[(
            "valve_asymmetry",
            "a supply that falls takes flow from the filling edge only",
        )]
    }

    fn experiment(&self) -> &'static str {
        "the same motion at several speeds: the loss grows with the flow"
    }
}
