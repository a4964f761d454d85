//! An input reaches the plant in held values.

use std::ops::Range;

use crate::effect::{Action, Effect, Family, Parameter, SiteKind, SiteScale, usual_prior};
use crate::prior::Prior;
use crate::signal_map::{Sampled, SignalMap};

/// An input reaches the plant in held values: a set point that a controller or a bus renews only every T, by a clock that knows nothing of
/// when a record begins, and holds in between.
///
/// ```text
/// u_plant(t) = u(t_k),   t_k = t₀ + T ⌊(t − t₀)/T⌋,   t from the first sample of the record      (1)
/// ```
///
/// A sample is the mean of (1) over the sampling interval about it: of one that a renewal falls into, the old and the
/// new value each have their share.
///
/// Seen by a slow plant this is a delay by half of T; lines at multiples of 1/T, less and plus the frequency of the
/// input, tell it from one.
///
/// Reference: \[Franklin1998\], section 4.3.
pub(crate) struct HeldInput;

/// Numbers of samples that holds are looked for with, and longer ones as they are met with.
const SHORT: [usize; 4] = [2, 3, 4, 5];
const LONG: [usize; 4] = [8, 10, 20, 50];
/// Holds that lines of what is left tell, and how many places of the first one are tried in each record.
const CARRIERS: usize = 2;
const PLACES: usize = 8;
/// How far twice a fitted delay is from the hold that it stands for, as a share.
const FROM_DELAY: f64 = 0.015;
/// Share of a hold by which the last of a record slips from one of those to the next.
const SLIP: f64 = 0.25;

/// Holds of numbers of samples.
fn of_samples<'a>(
    samples: impl IntoIterator<Item = usize> + 'a,
    scale: &'a SiteScale,
) -> impl Iterator<Item = Vec<f64>> + 'a {
    let counts = samples.into_iter();
    counts.map(|count| vec![count as f64 * scale.time_step_s, 0.0])
}

struct Hold {
    time_s: f64,
    start_s: f64,
}

/// The last renewal before the end of the interval about a sample, and the one before it.
struct Renewals {
    /// In samples, the earlier first.
    at: [f64; 2],
    /// Share of the later one in the mean over the sampling interval.
    share: f64,
}

impl Hold {
    /// `None` of a hold without end.
    fn renewals(&self, signal: &Sampled<'_>, i: usize) -> Option<Renewals> {
        let step_s = signal.time_step_s;
        if self.time_s <= step_s {
            // Renewed more than once in each interval: late by half of a hold.
            let late = i as f64 - 0.5 * self.time_s / step_s;
            return Some(Renewals {
                at: [late; 2],
                share: 1.0,
            });
        }
        // To the end of the interval about the sample.
        let until_s = (signal.first_index as f64 + i as f64 + 0.5) * step_s;
        let count = ((until_s - self.start_s) / self.time_s).floor();
        let later_s = self.start_s + count * self.time_s;
        let first = signal.first_index as f64;
        let at = [later_s - self.time_s, later_s].map(|time_s| time_s / step_s - first);
        let share = ((until_s - later_s) / step_s).min(1.0);
        at[0].is_finite().then_some(Renewals { at, share })
    }
}

impl SignalMap for Hold {
    fn apply(&self, signal: Sampled<'_>) -> Vec<f64> {
        let held = |i: usize| match self.renewals(&signal, i) {
            Some(Renewals { at, share }) if share < 1.0 => {
                let [old, new] = at.map(|position| signal.at(position));
                old + share * (new - old)
            }
            Some(Renewals { at, .. }) => signal.at(at[1]),
            None => signal.values[i],
        };
        (0..signal.values.len()).map(held).collect()
    }

    fn reach(&self, signal: Sampled<'_>) -> Range<usize> {
        signal.on_record(|i| match self.renewals(&signal, i) {
            Some(Renewals { at, share }) => at[usize::from(share >= 1.0)],
            None => i as f64,
        })
    }

    fn interpolates(&self) -> bool {
        true
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
                Parameter::shape("hold_start_s", "s", f64::NEG_INFINITY, f64::INFINITY).of_record(),
            ]
        }
    }

    /// The holds begin anywhere within the first of them.
    fn prior(&self, place: usize, scale: &SiteScale) -> Prior {
        match place {
            1 => Prior::Uniform {
                width: LONG[LONG.len() - 1] as f64 * scale.time_step_s,
            },
            _ => usual_prior(self, place, scale),
        }
    }

    /// Few samples, and the times of carriers of what is left.
    fn starts(&self, scale: &SiteScale) -> Vec<Vec<f64>> {
        let carriers = scale.carriers_hz.into_iter().filter(|freq| *freq > 0.0);
        let of_carriers = carriers.take(CARRIERS).map(|freq| vec![freq.recip(), 0.0]);
        of_samples(SHORT, scale).chain(of_carriers).collect()
    }

    /// Whole numbers of samples.
    fn usual(&self, scale: &SiteScale) -> Vec<Vec<f64>> {
        of_samples(SHORT.into_iter().chain(LONG), scale).collect()
    }

    fn own_starts(&self, values: &[f64]) -> Vec<Vec<f64>> {
        let share = |place: usize| (place as f64 + 0.5) / PLACES as f64;
        let places = (0..PLACES).map(|place| vec![values[0], share(place) * values[0]]);
        places.collect()
    }

    /// A plant that is slow beside the hold sees a delay by half of it.
    fn resembles(&self) -> &'static [&'static str] {
        &["input_delay"]
    }

    /// Holds about twice a delay, by steps over which the last of a record slips by a quarter of a hold.
    fn grown_from(&self, kind: &str, values: &[f64], scale: &SiteScale) -> Vec<Vec<f64>> {
        let about_s = 2.0 * values[0];
        if kind != "input_delay" || about_s <= scale.time_step_s {
            return vec![];
        }
        let step_s = SLIP * about_s * (about_s / scale.duration_s).min(1.0);
        let steps = (FROM_DELAY * about_s / step_s).ceil() as i32;
        let times_s = (-steps..=steps).map(|k| about_s + f64::from(k) * step_s);
        times_s.map(|time_s| vec![time_s, 0.0]).collect()
    }

    /// A part of a hold is another hold, and none where it is shorter than a sample.
    fn grows_in_proportion(&self) -> bool {
        false
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
