//! The clock of a channel runs fast or slow.

use crate::effect::{Action, Effect, Family, Parameter, SiteKind, SiteScale};
use crate::signal_map::{Retiming, Sampled};

/// The clock of a channel runs fast or slow against that of the others: its samples come from
/// later and later, or earlier and earlier.
///
/// ```text
/// y_measured,n = y((1 + s) n Δt),   n from the start of the record
/// ```
///
/// What lies beyond the end of the record is not known: there its last value is held.
pub(crate) struct ClockSkew;

/// Shift at the end of the longest record to start from, in periods of the strongest line of the
/// motion: a fit finds its way over half a period, and not over several.
const SHIFTS: [f64; 3] = [0.1, 1.0, -1.0];
/// Clocks are no worse than this.
const WORST: f64 = 0.05;

struct Skew(f64);

impl Retiming for Skew {
    fn position(&self, signal: &Sampled<'_>, i: usize) -> f64 {
        // A slice of a record begins with the shift that has come together by then.
        i as f64 + self.0 * (signal.first_index + i) as f64
    }

    fn counts_samples(&self) -> bool {
        true
    }
}

impl Effect for ClockSkew {
    fn kind(&self) -> &'static str {
        "clock_skew"
    }

    fn family(&self) -> Family {
        Family::Measurement
    }

    fn site(&self) -> SiteKind {
        SiteKind::Channel
    }

    fn summary(&self) -> &'static str {
        "the clock of the channel runs fast or slow: it comes more and more early or late"
    }

    fn equation(&self) -> &'static str {
        "y_measured(t) = y((1 + s) t), t from the start of the record"
    }

    fn parameters(&self) -> &'static [Parameter] {
        const { &[Parameter::size("skew", "1", -WORST, WORST)] }
    }

    fn starts(&self, scale: &SiteScale) -> Vec<Vec<f64>> {
        let line = scale.motion_hz[0];
        let period_s = if line > 0.0 {
            1.0 / line
        } else {
            20.0 * scale.time_step_s
        };
        let skew = |shift: f64| (shift * period_s / scale.duration_s).clamp(-WORST, WORST);
        SHIFTS.iter().map(|&shift| vec![skew(shift)]).collect()
    }

    fn action(&self, values: &[f64]) -> Action {
        Action::Sampling(Box::new(Skew(values[0])))
    }

    fn confused_with(&self) -> &'static [(&'static str, &'static str)] {
        &[
            (
                "sensor_delay",
                "in a short record the shift has hardly changed from beginning to end",
            ),
            (
                "stiffness_error",
                "in a free decay a stretched time axis is another natural frequency",
            ),
        ]
    }

    fn experiment(&self) -> &'static str {
        "a sharp event at the beginning and at the end of a long record: the time between them differs from channel to channel"
    }
}
