//! An input reaches the plant in held samples.

use crate::effect::{Action, Effect, Family, Parameter, SiteKind, SiteScale};
use crate::signal_map::{Sampled, SignalMap};

/// An input reaches the plant in held samples: a set point that a controller or a bus renews only every N
/// samples of the record, and holds in between.
///
/// ```text
/// u_plant,n = u_m,   m = n − ((n − n₀) mod N),   n counted from the first sample of the record
/// ```
///
/// Seen by a slow plant this is a delay by half of N samples; lines at multiples of 1/(N Δt), less and plus the
/// frequency of the input, tell it from one.
///
/// Reference: \[Franklin1998\], section 4.3.
pub(crate) struct HeldInput;

/// Numbers of samples of which every place of the first one is tried.
const SHORT: [usize; 4] = [2, 3, 4, 5];
/// Longer ones, with the first one at quarters of them.
const LONG: [usize; 4] = [8, 10, 20, 50];
const QUARTERS: usize = 4;
/// Longest hold, samples.
const MOST: f64 = 1e6;

struct Hold {
    samples: usize,
    first: usize,
}

impl SignalMap for Hold {
    fn apply(&self, signal: Sampled<'_>) -> Vec<f64> {
        let held = |n: usize| {
            let clock = signal.first_index + n;
            // n₀ may lie after the first sample: count from one hold earlier.
            let since = (clock + self.samples - self.first) % self.samples;
            // What was held before the record is not in it.
            signal.values[n.saturating_sub(since)]
        };
        (0..signal.values.len()).map(held).collect()
    }
}

impl Effect for HeldInput {
    fn kind(&self) -> &'static str {
        "held_input"
    }

    fn family(&self) -> Family {
        Family::Dynamics
    }

    fn site(&self) -> SiteKind {
        SiteKind::Input
    }

    fn summary(&self) -> &'static str {
        "the input reaches the plant in held samples: it is renewed only every so many samples of the record"
    }

    fn equation(&self) -> &'static str {
        "u_plant,n = u_m, m = n - ((n - n_0) mod N)"
    }

    fn reference(&self) -> Option<&'static str> {
        Some("[Franklin1998], section 4.3")
    }

    /// Whole numbers.
    fn parameters(&self) -> &'static [Parameter] {
        const {
            &[
                Parameter {
                    lower: 1.0,
                    neutral: Some(1.0),
                    ..Parameter::shape("hold_samples", "1", 1.0, MOST)
                },
                Parameter::shape("first_sample", "1", 0.0, MOST),
            ]
        }
    }

    fn starts(&self, _: &SiteScale) -> Vec<Vec<f64>> {
        let mut starts = vec![];
        for samples in SHORT {
            starts.extend((0..samples).map(|first| vec![samples as f64, first as f64]));
        }
        for samples in LONG {
            let quarters = (0..QUARTERS).map(|quarter| quarter * samples / QUARTERS);
            starts.extend(quarters.map(|first| vec![samples as f64, first as f64]));
        }
        starts
    }

    /// Whole numbers, the first sample within the first hold.
    fn make_physical(&self, values: &mut [f64]) {
        values[0] = values[0].clamp(1.0, MOST).round();
        values[1] = values[1].clamp(0.0, MOST).round().rem_euclid(values[0]);
    }

    /// Whole numbers: no fit moves them.
    fn is_chosen(&self, _: usize) -> bool {
        true
    }

    fn left_out(&self, parameter: &str) -> Option<f64> {
        (parameter == "first_sample").then_some(0.0)
    }

    fn action(&self, values: &[f64]) -> Action {
        let mut whole = [values[0], values[1]];
        self.make_physical(&mut whole);
        Action::Input(Box::new(Hold {
            samples: whole[0] as usize,
            first: whole[1] as usize,
        }))
    }

    fn confused_with(&self) -> &'static [(&'static str, &'static str)] {
        &[
            (
                "input_delay",
                "a plant that is slow beside the hold sees a delay by half of it",
            ),
            (
                "input_lag",
                "a plant that is slow beside the hold sees a delay, and so it does of a short lag",
            ),
        ]
    }

    fn experiment(&self) -> &'static str {
        "measure what reaches the plant beside what is commanded: it goes in steps or it does not"
    }
}
