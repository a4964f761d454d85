//! A channel is cut off at the ends of its range.

use crate::effect::{Action, Effect, Family, Parameter, SiteKind, SiteScale};
use crate::signal_map::{Sampled, SignalMap};

/// A channel is cut off at the ends of its range.
///
/// ```text
/// y_measured = min(max(y, y_low), y_high)
/// ```
///
/// Reference: \[BendatPiersol2010\], signal clipping.
pub(crate) struct Clipping;

/// How far inside the range of the record the levels start, as shares of that range: at the edges
/// of a record clipped last; deeper where noise was added after the clipping.
const INSIDE: [f64; 2] = [0.01, 0.1];

struct Limits {
    low: f64,
    high: f64,
}

impl SignalMap for Limits {
    fn apply(&self, signal: Sampled<'_>) -> Vec<f64> {
        let values = signal.values.iter();
        values
            .map(|value| value.max(self.low).min(self.high))
            .collect()
    }

    fn range(&self) -> Option<[f64; 2]> {
        Some([self.low, self.high])
    }

    fn is_lossy(&self) -> bool {
        true
    }
}

impl Effect for Clipping {
    fn kind(&self) -> &'static str {
        "clipping"
    }

    fn family(&self) -> Family {
        Family::Measurement
    }

    fn site(&self) -> SiteKind {
        SiteKind::Channel
    }

    fn summary(&self) -> &'static str {
        "the channel is cut off at the ends of its range: flat tops where the signal is larger"
    }

    fn equation(&self) -> &'static str {
        "y_measured = min(max(y, y_low), y_high)"
    }

    fn reference(&self) -> Option<&'static str> {
        Some("[BendatPiersol2010], signal clipping")
    }

    fn parameters(&self) -> &'static [Parameter] {
        const LIMIT: Parameter = Parameter {
            lower: f64::NEG_INFINITY,
            ..Parameter::limit("upper_level", "unit of the output")
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

    /// A side that is not cut off has its level moved out of reach by the fit.
    fn starts(&self, scale: &SiteScale) -> Vec<Vec<f64>> {
        let [low, high] = scale.signal_range;
        let inside = |share: f64| share * (high - low);
        INSIDE
            .iter()
            .map(|&share| vec![high - inside(share), low + inside(share)])
            .collect()
    }

    /// The lower level is not above the upper one.
    fn make_physical(&self, values: &mut [f64]) {
        values[1] = values[1].min(values[0]);
    }

    fn action(&self, values: &[f64]) -> Action {
        Action::Sampling(Box::new(Limits {
            high: values[0],
            low: values[1],
        }))
    }

    fn confused_with(&self) -> &'static [(&'static str, &'static str)] {
        &[
            (
                "end_stop",
                "a stop cuts off the displacement too, but the machine recoils from it, every channel sees it, and it gives way a little under the force where a sensor at its limit shows noise alone",
            ),
            (
                "sensor_gain",
                "at one amplitude the clipped fundamental is a smaller gain",
            ),
        ]
    }

    fn experiment(&self) -> &'static str {
        "the same motion at half the amplitude, inside the range: a clipped channel agrees again"
    }
}
