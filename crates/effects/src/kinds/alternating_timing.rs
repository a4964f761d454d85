//! Every other sample is taken at another time than the rest.

use super::alternating_gain::EVEN_SHARES;
use crate::effect::{Action, Effect, Family, Parameter, SiteKind, SiteScale};
use crate::signal_map::{Retiming, Sampled};

/// Every other sample is taken at another time than the rest.
///
/// ```text
/// y_n = y(t_n + 2 s τ)         n even
/// y_n = y(t_n − 2 (1 − s) τ)   n odd
/// ```
/// The two halves are 2 τ apart from where they belong. With s = 1/2 one is as late as the other is early, with
/// s = 0 the even samples are in time, with s = 1 the odd ones are.
pub(crate) struct AlternatingTiming;

struct Alternation {
    even_s: f64,
    odd_s: f64,
}

impl Retiming for Alternation {
    fn position(&self, signal: &Sampled<'_>, i: usize) -> f64 {
        let is_even = (signal.first_index + i).is_multiple_of(2);
        let shift_s = if is_even { self.even_s } else { self.odd_s };
        i as f64 + shift_s / signal.time_step_s
    }

    fn counts_samples(&self) -> bool {
        true
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
        "every other sample is taken at another time than the rest (a line at half the sample rate minus f)"
    }

    fn equation(&self) -> &'static str {
        "y_n = y(t_n + 2 s tau) (n even), y(t_n - 2 (1 - s) tau) (n odd)"
    }

    fn parameters(&self) -> &'static [Parameter] {
        const {
            &[
                Parameter::size("timing_s", "s", f64::NEG_INFINITY, f64::INFINITY),
                Parameter::shape("even_share", "1", 0.0, 1.0),
            ]
        }
    }

    fn starts(&self, scale: &SiteScale) -> Vec<Vec<f64>> {
        let timing_s = 0.05 * scale.time_step_s;
        let both_ways = [timing_s, -timing_s].into_iter();
        let starts = both_ways.flat_map(|timing_s| EVEN_SHARES.map(|share| vec![timing_s, share]));
        starts.collect()
    }

    /// Both halves are off, or one of them: what lies between is another fault besides.
    fn is_chosen(&self, place: usize) -> bool {
        place == 1
    }

    fn left_out(&self, parameter: &str) -> Option<f64> {
        (parameter == "even_share").then_some(0.5)
    }

    fn action(&self, values: &[f64]) -> Action {
        let apart_s = 2.0 * values[0];
        Action::Sampling(Box::new(Alternation {
            even_s: values[1] * apart_s,
            odd_s: (values[1] - 1.0) * apart_s,
        }))
    }

    fn experiment(&self) -> &'static str {
        "the same motion sampled two and a half times as fast: an alternation moves to the new half sample rate, a mechanical line stays"
    }
}
