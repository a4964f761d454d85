//! Every other sample is taken late and the rest early.

use crate::effect::{Action, Effect, Family, Parameter, SiteKind, SiteScale};
use crate::signal_map::{Retiming, Sampled};

/// Every other sample is taken late and the rest early.
///
/// ```text
/// y_n = y(t_n + (-1)^n tau)
/// ```
pub(crate) struct AlternatingTiming;

struct Alternation {
    timing_s: f64,
}

impl Retiming for Alternation {
    fn position(&self, signal: &Sampled<'_>, i: usize) -> f64 {
        let shift = self.timing_s / signal.time_step_s;
        let is_even = (signal.first_index + i).is_multiple_of(2);
        i as f64 + if is_even { shift } else { -shift }
    }
}

impl Effect for AlternatingTiming {
    fn kind(&self) -> &'static str {
        "alternating_timing"
    }

    fn family(&self) -> Family {
        Family::Measurement
    }

    fn site(&self) -> SiteKind {
        SiteKind::Channel
    }

    fn summary(&self) -> &'static str {
        "every other sample is taken late and the rest early (a line at half the sample rate minus f)"
    }

    fn equation(&self) -> &'static str {
        "y_n = y(t_n + (-1)^n tau)"
    }

    fn parameters(&self) -> &'static [Parameter] {
        &[Parameter {
            name: "timing_s",
            unit: "s",
            lower: f64::NEG_INFINITY,
            upper: f64::INFINITY,
            neutral: Some(0.0),
            per_record: false,
        }]
    }

    fn starts(&self, scale: &SiteScale) -> Vec<Vec<f64>> {
        vec![
            vec![0.05 * scale.time_step_s],
            vec![-0.05 * scale.time_step_s],
        ]
    }

    fn action(&self, values: &[f64]) -> Action {
        Action::Sampling(Box::new(Alternation {
            timing_s: values[0],
        }))
    }

    fn experiment(&self) -> &'static str {
        "the same motion sampled two and a half times as fast: an alternation moves to the new half sample rate, a mechanical line stays"
    }
}
