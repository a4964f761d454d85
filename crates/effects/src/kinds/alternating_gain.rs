//! Every other sample is read with another gain than the rest.

use crate::effect::{Action, Effect, Family, Parameter, SiteKind, SiteScale};
use crate::signal_map::{Sampled, SignalMap};

/// Every other sample is read with another gain than the rest.
///
/// ```text
/// y_n = (1 + 2 s g) y(t_n)         n even
/// y_n = (1 − 2 (1 − s) g) y(t_n)   n odd
/// ```
/// The two gains are 2 g apart. With s = 1/2 the even samples are too large by as much as the odd ones are too
/// small, with s = 0 the even ones are right, with s = 1 the odd ones are.
pub(crate) struct AlternatingGain;

/// Share of an alternation that is on the even samples: both halves are off, or one of them is.
pub(super) const EVEN_SHARES: [f64; 3] = [0.5, 0.0, 1.0];

struct Alternation {
    even: f64,
    odd: f64,
}

impl SignalMap for Alternation {
    fn apply(&self, signal: Sampled<'_>) -> Vec<f64> {
        let error = |i: usize| {
            if (signal.first_index + i).is_multiple_of(2) {
                self.even
            } else {
                self.odd
            }
        };
        let values = signal.values.iter().enumerate();
        values.map(|(i, value)| (1.0 + error(i)) * value).collect()
    }

    fn lives_in_single_samples(&self) -> bool {
        true
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
        "every other sample is read with another gain than the rest"
    }

    fn equation(&self) -> &'static str {
        "y_n = (1 + 2 s g) y(t_n) (n even), (1 - 2 (1 - s) g) y(t_n) (n odd)"
    }

    fn parameters(&self) -> &'static [Parameter] {
        const {
            &[
                Parameter::size("gain_difference", "1", -1.0, 1.0),
                Parameter::shape("even_share", "1", 0.0, 1.0),
            ]
        }
    }

    fn starts(&self, _: &SiteScale) -> Vec<Vec<f64>> {
        EVEN_SHARES.map(|share| vec![0.02, share]).to_vec()
    }

    /// Both halves are off, or one of them: what lies between is another fault besides.
    fn is_chosen(&self, place: usize) -> bool {
        place == 1
    }

    fn left_out(&self, parameter: &str) -> Option<f64> {
        (parameter == "even_share").then_some(0.5)
    }

    fn action(&self, values: &[f64]) -> Action {
        let difference = 2.0 * values[0];
        Action::Sampling(Box::new(Alternation {
            even: values[1] * difference,
            odd: (values[1] - 1.0) * difference,
        }))
    }

    fn experiment(&self) -> &'static str {
        "the same motion at several frequencies: the line at half the sample rate minus f keeps its share of the amplitude"
    }
}
