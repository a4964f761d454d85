//! An input reaches the plant late.

use super::sensor_delay::{Delay, long_delay, short_delays};
use crate::effect::{Action, Effect, Family, Parameter, SiteKind, SiteScale};

/// An input reaches the plant late: a bus, a controller cycle.
///
/// ```text
/// u_plant(t) = u(t - tau)
/// ```
pub(crate) struct InputDelay;

impl Effect for InputDelay {
    fn kind(&self) -> &'static str {
        "input_delay"
    }

    fn family(&self) -> Family {
        Family::Dynamics
    }

    fn site(&self) -> SiteKind {
        SiteKind::Input
    }

    fn summary(&self) -> &'static str {
        "the input reaches the plant late"
    }

    fn equation(&self) -> &'static str {
        "u_plant(t) = u(t - tau)"
    }

    fn parameters(&self) -> &'static [Parameter] {
        const { &[Parameter::size("delay_s", "s", 0.0, f64::INFINITY)] }
    }

    fn starts(&self, scale: &SiteScale) -> Vec<Vec<f64>> {
        short_delays(scale)
    }

    fn pointed_at(&self, scale: &SiteScale) -> Vec<Vec<f64>> {
        long_delay(scale)
    }

    fn action(&self, values: &[f64]) -> Action {
        Action::Input(Box::new(Delay { delay_s: values[0] }))
    }

    fn confused_with(&self) -> &'static [(&'static str, &'static str)] {
        &[(
            "sensor_delay",
            "with one input and one output of a linear plant only their sum counts",
        )]
    }

    fn experiment(&self) -> &'static str {
        "measure what reaches the plant beside what is commanded: the two are shifted or they are not"
    }
}
