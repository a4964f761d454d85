//! A valve passes nothing about its middle.

use super::hydraulic::valve_at;
use crate::effect::{Action, Effect, Family, Parameter, SiteKind, SiteScale};
use crate::prior::Prior;

/// A valve passes nothing about its middle.
///
/// ```text
/// o = x less d either way, nothing between; d beside the overlap of the model
/// ```
///
/// Reference: `merritt1967`, chapter 5.
pub(crate) struct ValveDeadBand;

impl Effect for ValveDeadBand {
    fn kind(&self) -> &'static str {
        "valve_dead_band"
    }

    fn family(&self) -> Family {
        Family::Force
    }

    fn site(&self) -> SiteKind {
        SiteKind::Spool
    }

    fn summary(&self) -> &'static str {
        "the spool overlaps its edges: a small opening passes nothing"
    }

    fn equation(&self) -> &'static str {
        "o = x - d sgn(x) where |x| > d, else 0"
    }

    fn reference(&self) -> Option<&'static str> {
        Some("[merritt1967], chapter 5")
    }

    fn parameters(&self) -> &'static [Parameter] {
        const { &[Parameter::size("dead_band_share", "1", 0.0, 1.0)] }
    }

    fn starts(&self, _: &SiteScale) -> Vec<Vec<f64>> {
        vec![vec![0.02]]
    }

    fn prior(&self, _: usize, _: &SiteScale) -> Prior {
        Prior::size(0.02)
    }

    fn action(&self, values: &[f64]) -> Action {
        let value = values[0];
        Action::Model(Box::new(move |model, at| {
            if let Some(valve) = valve_at(model, at) {
                valve.overlap = (valve.overlap + value).min(1.0);
            }
        }))
    }

    fn confused_with(&self) -> &'static [(&'static str, &'static str)] {
        &[(
            "input_dead_zone",
            "a command that does nothing about zero; the position of the spool tells them apart",
        )]
    }

    fn experiment(&self) -> &'static str {
        "slow motion of small amplitude about the middle of the valve"
    }
}
