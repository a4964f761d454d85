//! An input does not go beyond its limits.

use crate::effect::{Action, Effect, Family, Parameter, SiteKind, SiteScale};
use crate::signal_map::{Sampled, SignalMap};

/// An input does not go beyond its limits: a drive at its largest current, a valve fully open.
///
/// ```text
/// u_plant = min(max(u, u_low), u_high)
/// ```
pub(crate) struct InputSaturation;

/// How far inside the range of the input the limits start, as shares of that range.
const INSIDE: [f64; 2] = [0.05, 0.2];

struct Limits {
    low: f64,
    high: f64,
}

impl SignalMap for Limits {
    fn apply(&self, signal: Sampled<'_>) -> Vec<f64> {
        let values = signal.values.iter();
        values.map(|u| u.max(self.low).min(self.high)).collect()
    }
}

impl Effect for InputSaturation {
    fn kind(&self) -> &'static str {
        "input_saturation"
    }

    fn family(&self) -> Family {
        Family::Dynamics
    }

    fn site(&self) -> SiteKind {
        SiteKind::Input
    }

    fn summary(&self) -> &'static str {
        "the input reaches the plant cut off at limits, as of a drive at its largest current"
    }

    fn equation(&self) -> &'static str {
        "u_plant = min(max(u, u_low), u_high)"
    }

    fn parameters(&self) -> &'static [Parameter] {
        const LIMIT: Parameter = Parameter {
            lower: f64::NEG_INFINITY,
            ..Parameter::limit("upper_level", "unit of the input")
        };
        const {
            &[
                LIMIT,
                Parameter {
                    name: "lower_level",
                    neutral: Some(f64::NEG_INFINITY),
                    ..LIMIT
                },
            ]
        }
    }

    /// On both sides. A limit that is not reached is moved out of reach by the fit.
    fn starts(&self, scale: &SiteScale) -> Vec<Vec<f64>> {
        let [low, high] = scale.signal_range;
        let inside = |share: f64| share * (high - low);
        let starts = INSIDE.map(|share| vec![high - inside(share), low + inside(share)]);
        starts.to_vec()
    }

    /// The lower limit is not above the upper one.
    fn make_physical(&self, values: &mut [f64]) {
        values[1] = values[1].min(values[0]);
    }

    fn action(&self, values: &[f64]) -> Action {
        Action::Input(Box::new(Limits {
            high: values[0],
            low: values[1],
        }))
    }

    fn confused_with(&self) -> &'static [(&'static str, &'static str)] {
        &[
            (
                "input_gain",
                "of an input of one amplitude the fundamental of what is cut off is a smaller gain",
            ),
            (
                "input_rate_limit",
                "a limited rate lowers the peaks of fast inputs too, and delays them",
            ),
        ]
    }

    fn experiment(&self) -> &'static str {
        "the same input at half the amplitude, inside the limits: the model agrees again"
    }
}
