//! An input reaches the plant through a first-order lag.

use std::f64::consts::TAU;

use super::sensor_lag::Lag;
use crate::effect::{Action, Effect, Family, Parameter, SiteKind, SiteScale};

/// An input reaches the plant through a first-order lag: a valve, a drive, an amplifier.
///
/// ```text
/// tau du_plant/dt + u_plant = u
/// ```
///
/// Exact for polynomials of degree five between samples, as the lag of a sensor is.
pub(crate) struct InputLag;

impl Effect for InputLag {
    fn kind(&self) -> &'static str {
        "input_lag"
    }

    fn family(&self) -> Family {
        Family::Dynamics
    }

    fn site(&self) -> SiteKind {
        SiteKind::Input
    }

    fn summary(&self) -> &'static str {
        "the input reaches the plant through a first-order lag"
    }

    fn equation(&self) -> &'static str {
        "tau du_plant/dt + u_plant = u"
    }

    fn parameters(&self) -> &'static [Parameter] {
        const { &[Parameter::size("time_constant_s", "s", 0.0, f64::INFINITY)] }
    }

    fn starts(&self, scale: &SiteScale) -> Vec<Vec<f64>> {
        let mut starts = vec![
            vec![2.0 * scale.time_step_s],
            vec![20.0 * scale.time_step_s],
        ];
        if scale.motion_hz[0] > 0.0 {
            starts.push(vec![1.0 / (TAU * scale.motion_hz[0])]);
        }
        starts
    }

    fn action(&self, values: &[f64]) -> Action {
        Action::Input(Box::new(Lag {
            time_constant_s: values[0],
            is_measured: false,
        }))
    }

    fn confused_with(&self) -> &'static [(&'static str, &'static str)] {
        &[
            (
                "input_delay",
                "well below the corner frequency a lag is a delay by its time constant",
            ),
            (
                "sensor_lag",
                "with one input and one output of a linear plant the lag may be at either end",
            ),
        ]
    }

    fn experiment(&self) -> &'static str {
        "measure what reaches the plant beside what is commanded, with broadband excitation"
    }
}
