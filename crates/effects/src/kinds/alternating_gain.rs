//! Every other sample is read too large and the rest too small.

use crate::effect::{Action, Effect, Family, Parameter, SiteKind, SiteScale};
use crate::signal_map::{Sampled, SignalMap};

/// Every other sample is read too large and the rest too small.
///
/// ```text
/// y_n = (1 + (-1)^n g) y(t_n)
/// ```
pub(crate) struct AlternatingGain;

struct Alternation {
    gain: f64,
}

impl SignalMap for Alternation {
    fn apply(&self, signal: Sampled<'_>) -> Vec<f64> {
        let sign = |i: usize| {
            if (signal.first_index + i).is_multiple_of(2) {
                self.gain
            } else {
                -self.gain
            }
        };
        let values = signal.values.iter().enumerate();
        values.map(|(i, value)| (1.0 + sign(i)) * value).collect()
    }
}

impl Effect for AlternatingGain {
    fn kind(&self) -> &'static str {
        "alternating_gain"
    }

    fn family(&self) -> Family {
        Family::Measurement
    }

    fn site(&self) -> SiteKind {
        SiteKind::Channel
    }

    fn summary(&self) -> &'static str {
        "every other sample is read too large and the rest too small"
    }

    fn equation(&self) -> &'static str {
        "y_n = (1 + (-1)^n g) y(t_n)"
    }

    fn parameters(&self) -> &'static [Parameter] {
        &[Parameter {
            name: "gain_difference",
            unit: "1",
            lower: -1.0,
            upper: 1.0,
            neutral: Some(0.0),
            per_record: false,
        }]
    }

    fn starts(&self, _: &SiteScale) -> Vec<Vec<f64>> {
        vec![vec![0.02]]
    }

    fn action(&self, values: &[f64]) -> Action {
        Action::Sampling(Box::new(Alternation { gain: values[0] }))
    }

    fn experiment(&self) -> &'static str {
        "the same motion at several frequencies: the line at half the sample rate minus f keeps its share of the amplitude"
    }
}
