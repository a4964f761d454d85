//! Single samples are far off.

use std::ops::Range;

use crate::effect::{Action, Effect, Family, Parameter, SiteKind, SiteScale};
use crate::signal_map::{Sampled, SignalMap};

/// Single samples, or two or three in a row, are far off: disturbed transmission, loose contacts.
///
/// ```text
/// y_measured,n = y_n + spike   at a few samples n,   else y_n
/// ```
///
/// Which they are shows in the record. A group of one to three samples is a spike where every one
/// of them stands off both neighbours of the group, b and c, to the same side by more than the
/// threshold T times the spread S of the record there:
///
/// ```text
/// min(|y − b|, |y − c|) > T S for every y of the group             (1)
/// S = max(σ, s_b, s_c, q/2)                                        (2)
/// σ = 1.4826/√6 median |yₙ₋₁ − 2 yₙ + yₙ₊₁| over the record        (3)
/// s = ⅔ of the third largest of the nine changes on one side       (4)
/// ```
///
/// Here q is the smallest change in the record. In white noise both σ and s are about its deviation.
/// A smooth, stepping or ringing signal changes beside a group as it does within, so that (4) keeps
/// it out of (1); two of the nine changes may belong to another spike. Near an end of the record the
/// side with fewer than four samples is left out. At a spike the map delivers
/// what was measured, as the record says nothing of the plant there.
///
/// Reference: \[BendatPiersol2010\], intermittent noise spikes.
pub(crate) struct Outliers;

/// Thresholds to start from, in spreads: out of reach for Gaussian noise, and for noise of wider
/// tails.
const THRESHOLDS: [f64; 2] = [7.0, 12.0];
/// Longest group.
const LONGEST: usize = 3;
/// Changes looked at on each side, least of them.
const SIDE: usize = 9;
const LEAST_SIDE: usize = 3;
/// The third largest of nine changes of white noise of deviation 1.
const THIRD_LARGEST: f64 = 1.5;
/// Normal distribution: standard deviation over median magnitude.
const DEVIATION_PER_MEDIAN: f64 = 1.482_602_218_505_602;
/// Deviation of a second difference of white noise of deviation 1: √(1 + 4 + 1).
const SECOND_DIFFERENCE_GAIN: f64 = 2.449_489_742_783_178;
/// More than this share of the samples are no exceptions.
const MOST_SPIKES: f64 = 0.1;

/// Share of samples that are struck in generated cases, and how far in deviations of the signal.
const STRUCK: [f64; 2] = [0.002, 0.01];
const HEIGHT: [f64; 2] = [4.0, 12.0];

struct Spikes {
    threshold: f64,
}

/// The part of (2) that holds for the whole record.
fn spread(values: &[f64]) -> f64 {
    let mut bends: Vec<f64> = values
        .windows(3)
        .map(|y| (y[0] - 2.0 * y[1] + y[2]).abs())
        .collect();
    let middle = bends.len() / 2;
    let median = *bends.select_nth_unstable_by(middle, f64::total_cmp).1;
    let deviation = median * DEVIATION_PER_MEDIAN / SECOND_DIFFERENCE_GAIN; // (3)
    let changes = values.windows(2).map(|pair| (pair[1] - pair[0]).abs());
    let smallest = changes
        .filter(|&change| change > 0.0)
        .fold(f64::INFINITY, f64::min);
    deviation.max(0.5 * smallest)
}

/// (4), of the changes in a stretch.
fn side(values: &[f64]) -> f64 {
    let mut largest = [0.0_f64; 3];
    for pair in values.windows(2) {
        let change = (pair[1] - pair[0]).abs();
        if change > largest[2] {
            largest[2] = change;
            if change > largest[1] {
                largest.swap(1, 2);
            }
            if change > largest[0] {
                largest.swap(0, 1);
            }
        }
    }
    largest[2] / THIRD_LARGEST
}

/// The spikes of a record, as groups of samples.
fn spikes(values: &[f64], threshold: f64) -> Vec<Range<usize>> {
    let count = values.len();
    if count < 2 * (LEAST_SIDE + 1) + 1 {
        return vec![];
    }
    let level = threshold * spread(values);
    let mut groups = Vec::new();
    let mut first = 1;
    while first + 1 < count {
        let jump = (values[first] - values[first - 1]).abs();
        // The least of three changes is below the third largest of nine: most samples end here.
        let calm = values[first.saturating_sub(LEAST_SIDE + 1)..first]
            .windows(2)
            .map(|pair| (pair[1] - pair[0]).abs())
            .fold(f64::INFINITY, f64::min);
        let calm = if first > LEAST_SIDE { calm } else { 0.0 };
        if jump <= level.max(threshold * calm / THIRD_LARGEST) {
            first += 1;
            continue;
        }
        // The longest first: of two unlike spikes in a row, one would hide the other.
        let longest = LONGEST.min(count - 1 - first);
        let group = (1..=longest)
            .rev()
            .map(|length| first..first + length)
            .find(|group| stands_off(values, group, level, threshold));
        match group {
            Some(group) => {
                // The sample behind it is an ordinary one, even between two spikes.
                first = group.end + 1;
                groups.push(group);
            }
            None => first += 1,
        }
    }
    let struck: usize = groups.iter().map(Range::len).sum();
    if struck as f64 > MOST_SPIKES * count as f64 {
        return vec![];
    }
    groups
}

/// (1) for one group.
fn stands_off(values: &[f64], group: &Range<usize>, level: f64, threshold: f64) -> bool {
    let (before, after) = (values[group.start - 1], values[group.end]);
    let mut height = f64::INFINITY;
    for value in &values[group.clone()] {
        let (from, to) = (value - before, value - after);
        if from * to <= 0.0 {
            return false;
        }
        height = height.min(from.abs()).min(to.abs());
    }
    if height <= level {
        return false;
    }
    let left = &values[group.start.saturating_sub(SIDE + 1)..group.start];
    let right = &values[group.end..(group.end + SIDE + 1).min(values.len())];
    // Near an end of the record one side alone has to tell.
    let seen = [left, right].into_iter();
    let mut seen = seen.filter(|stretch| stretch.len() > LEAST_SIDE).peekable();
    seen.peek().is_some() && seen.all(|stretch| height > threshold * side(stretch))
}

impl SignalMap for Spikes {
    fn apply(&self, signal: Sampled<'_>) -> Vec<f64> {
        let mut delivered = signal.values.to_vec();
        let measured = signal.measured.filter(|m| m.len() == delivered.len());
        let (Some(measured), true) = (measured, self.threshold.is_finite()) else {
            return delivered;
        };
        // Whole numbers count: a fit that tries 7.001 changes nothing.
        for group in spikes(measured, self.threshold.round()) {
            delivered[group.clone()].copy_from_slice(&measured[group]);
        }
        delivered
    }

    fn is_lossy(&self) -> bool {
        true
    }

    fn lives_in_single_samples(&self) -> bool {
        true
    }
}

impl Effect for Outliers {
    fn kind(&self) -> &'static str {
        "outliers"
    }

    fn family(&self) -> Family {
        Family::Measurement
    }

    fn site(&self) -> SiteKind {
        SiteKind::Channel
    }

    fn summary(&self) -> &'static str {
        "single samples are far off, as from a disturbed transmission or a loose contact"
    }

    fn equation(&self) -> &'static str {
        "y_measured = y + spike at a few samples"
    }

    /// In spreads of the record; a whole number that no fit moves. Below the lower bound it would
    /// take noise for spikes.
    fn parameters(&self) -> &'static [Parameter] {
        const {
            &[Parameter {
                lower: 6.0,
                ..Parameter::limit("threshold", "1")
            }]
        }
    }

    fn starts(&self, _: &SiteScale) -> Vec<Vec<f64>> {
        THRESHOLDS
            .iter()
            .map(|&threshold| vec![threshold])
            .collect()
    }

    fn strike(
        &self,
        values: &[f64],
        signal: &[f64],
        random: &mut dyn FnMut() -> f64,
    ) -> Option<Vec<f64>> {
        let mut struck = signal.to_vec();
        if !values[0].is_finite() || signal.is_empty() {
            return Some(struck);
        }
        let count = signal.len() as f64;
        let mean = signal.iter().sum::<f64>() / count;
        let square: f64 = signal.iter().map(|y| (y - mean).powi(2)).sum();
        let deviation = (square / count).sqrt();
        let mut between = |[low, high]: [f64; 2]| low + (high - low) * random();
        let rate = between(STRUCK);
        // Gaps as between random events; one spike at least.
        let mut at = (-(1.0 - between([0.0, 1.0])).ln() / rate).min(0.5 * count);
        while (at as usize) < struck.len() {
            // Mostly one, seldom two or three in a row.
            let length = match between([0.0, 1.0]) {
                u if u < 0.8 => 1,
                u if u < 0.95 => 2,
                _ => LONGEST,
            };
            let sign = if between([0.0, 1.0]) < 0.5 { -1.0 } else { 1.0 };
            let end = (at as usize + length).min(struck.len());
            for value in &mut struck[at as usize..end] {
                *value += sign * deviation * between(HEIGHT);
            }
            at = end as f64 + 1.0 - (1.0 - between([0.0, 1.0])).ln() / rate;
        }
        Some(struck)
    }

    fn action(&self, values: &[f64]) -> Action {
        Action::Sampling(Box::new(Spikes {
            threshold: values[0],
        }))
    }

    fn confused_with(&self) -> &'static [(&'static str, &'static str)] {
        &[
            (
                "dropouts",
                "a single sample lost and read as zero is a spike",
            ),
            (
                "backlash",
                "impacts shorter than three samples look like spikes, but ring afterwards",
            ),
        ]
    }

    fn experiment(&self) -> &'static str {
        "the same motion again: spikes come at other times, impacts at the same ones"
    }
}
