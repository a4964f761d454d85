//! Small values of an input do not reach the plant.

use crate::effect::{Action, Effect, Family, Parameter, SiteKind, SiteScale};
use crate::signal_map::{Sampled, SignalMap};

/// Small values of an input do not reach the plant: a valve with overlap, a drive below its threshold.
///
/// ```text
/// u_plant = u − δ   for u > δ,   u + δ   for u < −δ,   0   between
/// ```
///
/// Reference: \[Tao1996\], chapter 2.
pub(crate) struct InputDeadZone;

/// Half widths that a fit starts from, as shares of the rms of the input.
const STARTS: [f64; 2] = [0.1, 0.5];

struct DeadZone {
    half_width: f64,
}

impl SignalMap for DeadZone {
    fn apply(&self, signal: Sampled<'_>) -> Vec<f64> {
        let beyond = |&u: &f64| u - u.clamp(-self.half_width, self.half_width);
        signal.values.iter().map(beyond).collect()
    }
}

impl Effect for InputDeadZone {
    fn kind(&self) -> &'static str {
        "input_dead_zone"
    }

    fn family(&self) -> Family {
        Family::Dynamics
    }

    fn site(&self) -> SiteKind {
        SiteKind::Input
    }

    fn summary(&self) -> &'static str {
        "small values of the input do not reach the plant, larger ones by so much less"
    }

    fn equation(&self) -> &'static str {
        "u_plant = u - delta (u > delta), u + delta (u < -delta), 0 between"
    }

    fn reference(&self) -> Option<&'static str> {
        Some("[Tao1996], chapter 2")
    }

    fn parameters(&self) -> &'static [Parameter] {
        const {
            &[Parameter::size(
                "half_width",
                "unit of the input",
                0.0,
                f64::INFINITY,
            )]
        }
    }

    fn starts(&self, scale: &SiteScale) -> Vec<Vec<f64>> {
        STARTS.map(|share| vec![share * scale.signal]).to_vec()
    }

    fn action(&self, values: &[f64]) -> Action {
        Action::Input(Box::new(DeadZone {
            half_width: values[0].max(0.0),
        }))
    }

    fn confused_with(&self) -> &'static [(&'static str, &'static str)] {
        &[
            (
                "input_gain",
                "of an input of one amplitude a dead zone takes a part as a smaller gain does",
            ),
            (
                "coulomb_friction",
                "what a force has to overcome before anything moves may be friction",
            ),
        ]
    }

    fn experiment(&self) -> &'static str {
        "a slow triangle of the input through zero: the plant stands still while the input is small"
    }
}
