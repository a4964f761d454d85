//! An input reaches the plant in held values.

use crate::effect::{Action, Effect, Family, Parameter, SiteKind, SiteScale, usual_prior};
use crate::prior::Prior;
use crate::signal_map::{Retiming, Sampled};

/// An input reaches the plant in held values: a set point that a controller or a bus renews only every T, and
/// holds in between.
///
/// ```text
/// u_plant(t) = u(t_k),   t_k = t₀ + T ⌊(t − t₀)/T⌋,   t from the first sample of the record
/// ```
///
/// Seen by a slow plant this is a delay by half of T; lines at multiples of 1/T, less and plus the frequency of the
/// input, tell it from one.
///
/// Reference: \[Franklin1998\], section 4.3.
pub(crate) struct HeldInput;

/// Numbers of samples of which every place of the first one is tried.
const SHORT: [usize; 4] = [2, 3, 4, 5];
/// Longer ones, with the first one at quarters of them.
const LONG: [usize; 4] = [8, 10, 20, 50];
const QUARTERS: usize = 4;
/// Share of a hold by which a time that falls on its begin may be rounded down.
const ROUNDING: f64 = 1e-9;

struct Hold {
    time_s: f64,
    start_s: f64,
}

impl Retiming for Hold {
    fn position(&self, signal: &Sampled<'_>, i: usize) -> f64 {
        let first = signal.first_index as f64;
        let since_s = (first + i as f64) * signal.time_step_s - self.start_s;
        let count = (since_s / self.time_s + ROUNDING).floor();
        let held_s = self.start_s + count * self.time_s;
        let position = held_s / signal.time_step_s - first;
        // No hold, or one of no length.
        if position.is_finite() {
            position
        } else {
            i as f64
        }
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
        "the input reaches the plant in held values: a set point that is renewed only every so often"
    }

    fn equation(&self) -> &'static str {
        "u_plant(t) = u(t_k), t_k = t_0 + T floor((t - t_0)/T)"
    }

    fn reference(&self) -> Option<&'static str> {
        Some("[Franklin1998], section 4.3")
    }

    fn parameters(&self) -> &'static [Parameter] {
        const {
            &[
                Parameter::size("hold_time_s", "s", 0.0, f64::INFINITY),
                Parameter::shape("hold_start_s", "s", 0.0, f64::INFINITY),
            ]
        }
    }

    /// The holds begin anywhere within the first of them.
    fn prior(&self, place: usize, scale: &SiteScale) -> Prior {
        let longest = LONG.iter().copied().max().unwrap_or(1) as f64;
        match place {
            1 => Prior::Uniform {
                width: longest * scale.time_step_s,
            },
            _ => usual_prior(self, place, scale),
        }
    }

    /// Whole numbers of samples.
    fn starts(&self, scale: &SiteScale) -> Vec<Vec<f64>> {
        let start = |samples: usize, first: usize| {
            [samples, first]
                .map(|count| count as f64 * scale.time_step_s)
                .to_vec()
        };
        let mut starts = vec![];
        for samples in SHORT {
            starts.extend((0..samples).map(|first| start(samples, first)));
        }
        for samples in LONG {
            let quarters = (0..QUARTERS).map(|quarter| quarter * samples / QUARTERS);
            starts.extend(quarters.map(|first| start(samples, first)));
        }
        starts
    }

    /// What moves the begin of the holds by less than a sample changes nothing but at jumps.
    fn is_chosen(&self, place: usize) -> bool {
        place == 1
    }

    fn left_out(&self, parameter: &str) -> Option<f64> {
        (parameter == "hold_start_s").then_some(0.0)
    }

    fn action(&self, values: &[f64]) -> Action {
        Action::Input(Box::new(Hold {
            time_s: values[0],
            start_s: values[1],
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
