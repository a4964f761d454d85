//! Samples are lost on the way.

use crate::effect::{Action, Effect, Family, Parameter, SiteKind, SiteScale};
use crate::signal_map::{Sampled, SignalMap};

/// Samples are lost on the way: in their place stands the last one that arrived, or zero.
///
/// ```text
/// y_measured,n = y_n   where sample n arrived,   else y_measured,m of the last arrival m, or 0
/// ```
///
/// Which samples were lost shows in the record: values that repeat exactly, or are exactly zero,
/// while the signal around them moves. There the map delivers what was measured, as the record
/// says nothing of the plant there.
///
/// A record also repeats itself where nothing was lost, which is told apart thus:
///
/// - at the ends of the range: clipping;
/// - on a lattice, by chance: expected are n pᵐ runs of m repeats, p from the changes by one or
///   two steps, and runs are only believed where there are many more;
/// - where the machine rests: it comes to rest and leaves it gently, by changes that shrink and
///   grow, whereas lost samples end in a jump.
///
/// Reference: \[BendatPiersol2010\], temporary signal dropouts.
pub(crate) struct Dropouts;

/// The step of a lattice is the smallest gap among so many values.
const SORTED: usize = 4096;
/// A gap may be this share of a step off the lattice, and this share of gaps may be off it.
const OFF_LATTICE: f64 = 0.05;
const OFF_SHARE: f64 = 0.02;
/// With fewer changes than this nothing can be said.
const LEAST_CHANGES: usize = 16;
/// On a lattice, a run of lost samples ends in a change of more steps than this.
const JUMP_STEPS: f64 = 2.5;
/// A single zero that a neighbour is closer to than this share of the mean change is a crossing.
const CROSSING: f64 = 0.05;
/// How many times more runs there must be than chance brings.
const OVER_CHANCE: f64 = 20.0;
/// A run is abrupt if a change beside it is so much larger than the change beyond that ...
const ABRUPT: f64 = 1.5;
/// ... and runs are losses if this share of them is abrupt: noise hides it in some, rest has none.
const ABRUPT_SHARE: f64 = 0.25;
/// A channel that loses more than this is no channel.
const MOST_LOST: f64 = 0.5;

/// Longest run that is generated, share of samples before which one starts.
const LONGEST: f64 = 20.0;
const RUNS_PER_SAMPLE: f64 = 0.004;

struct Losses {
    fewest: f64,
}

/// How the values of a record change.
struct Changes {
    low: f64,
    high: f64,
    /// Mean size of the changes that are not zero.
    mean: f64,
    /// Step of the lattice, zero without one.
    step: f64,
    /// Chance of a repeat on the lattice.
    repeat: f64,
    /// Chance of a zero on the lattice.
    zero: f64,
}

impl Changes {
    /// `None` where there are too few changes.
    fn of(values: &[f64]) -> Option<Changes> {
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        let (mut count, mut sum) = (0, 0.0);
        for pair in values.windows(2) {
            (low, high) = (low.min(pair[0]), high.max(pair[0]));
            sum += (pair[1] - pair[0]).abs();
            count += usize::from(pair[1] != pair[0]);
        }
        let last = values.last()?;
        (low, high) = (low.min(*last), high.max(*last));
        if count < LEAST_CHANGES {
            return None;
        }
        let mean = sum / count as f64;
        let step = lattice_step(values);
        // Of the sizes −2, −1, 0, 1 and 2 steps all are about as frequent.
        let chance = |sizes: &mut dyn Iterator<Item = f64>| -> f64 {
            let small = sizes
                .filter(|&size| size > 0.0 && size < 2.5 * step)
                .count();
            small as f64 / 4.0 / values.len() as f64
        };
        Some(Changes {
            low,
            high,
            mean,
            step,
            repeat: chance(&mut values.windows(2).map(|pair| (pair[1] - pair[0]).abs())),
            zero: chance(&mut values.iter().map(|value| value.abs())),
        })
    }
}

/// The step of the lattice that the values lie on; zero where they lie on none.
fn lattice_step(values: &[f64]) -> f64 {
    let stride = values.len().div_ceil(SORTED).max(1);
    let mut sorted: Vec<f64> = values.iter().step_by(stride).copied().collect();
    sorted.sort_unstable_by(f64::total_cmp);
    sorted.dedup();
    let range = sorted[sorted.len() - 1] - sorted[0];
    let gaps = || {
        let gaps = sorted.windows(2).map(|pair| pair[1] - pair[0]);
        gaps.filter(move |&gap| gap > 1e-12 * range)
    };
    let step = gaps().fold(f64::INFINITY, f64::min);
    let (mut off, mut count) = (0, 0);
    for steps in gaps().map(|gap| gap / step) {
        off += usize::from((steps - steps.round()).abs() > OFF_LATTICE);
        count += 1;
    }
    let is_lattice = step.is_finite() && off as f64 <= OFF_SHARE * f64::from(count);
    if is_lattice { step } else { 0.0 }
}

/// A run of samples that may have been lost.
struct Run {
    /// Lost samples: a held value itself arrived, a zero did not.
    lost: std::ops::Range<usize>,
    is_zero: bool,
    is_abrupt: bool,
}

/// The run of equal values `start..end`, where it may be a loss.
fn run(values: &[f64], start: usize, end: usize, changes: &Changes) -> Option<Run> {
    let value = values[start];
    let is_zero = value == 0.0;
    let lost = if is_zero { start..end } else { start + 1..end };
    if lost.is_empty() || start < 2 || end + 1 >= values.len() {
        return None;
    }
    let change = |i: usize| (values[i] - values[i - 1]).abs();
    let (before, into, out, after) = (
        change(start - 1),
        change(start),
        change(end),
        change(end + 1),
    );
    let is_abrupt = out > ABRUPT * after || into > ABRUPT * before;
    let gentle = JUMP_STEPS * changes.step;
    let excluded = if is_zero {
        let near = into.min(out);
        let opposite = values[start - 1] * values[end] < 0.0;
        let crossing = near <= CROSSING * changes.mean || (opposite && changes.step > 0.0);
        (changes.step > 0.0 && near <= gentle) || (lost.len() == 1 && crossing)
    } else {
        let edge = value == changes.low || value == changes.high;
        edge || out <= gentle
    };
    (!excluded).then_some(Run {
        lost,
        is_zero,
        is_abrupt,
    })
}

/// The samples that were lost, in runs of at least `fewest`.
fn losses(values: &[f64], fewest: usize) -> Vec<std::ops::Range<usize>> {
    // Most records have no repeats at all.
    if !values
        .windows(2)
        .any(|pair| pair[0] == pair[1] || pair[0] == 0.0)
    {
        return vec![];
    }
    let Some(changes) = Changes::of(values) else {
        return vec![];
    };
    let mut runs = Vec::new();
    let mut start = 0;
    for equal in values.chunk_by(|a, b| a == b) {
        let end = start + equal.len();
        if equal.len() > 1 || equal[0] == 0.0 {
            runs.extend(run(values, start, end, &changes));
        }
        start = end;
    }
    let (zeros, held): (Vec<Run>, Vec<Run>) = runs.into_iter().partition(|run| run.is_zero);
    let zeros = believed(
        zeros,
        fewest,
        |m| changes.zero * changes.repeat.powi(m - 1),
        values.len(),
    );
    let held = believed(held, fewest, |m| changes.repeat.powi(m), values.len());
    zeros.into_iter().chain(held).collect()
}

/// The runs of one sort that are many more than chance brings, and end abruptly.
fn believed(
    mut runs: Vec<Run>,
    fewest: usize,
    chance: impl Fn(i32) -> f64,
    count: usize,
) -> Vec<std::ops::Range<usize>> {
    let mut least = fewest;
    loop {
        runs.retain(|run| run.lost.len() >= least);
        let by_chance = count as f64 * chance(i32::try_from(least).unwrap_or(i32::MAX));
        if runs.is_empty() || runs.len() as f64 >= OVER_CHANCE * by_chance {
            break;
        }
        least += 1;
    }
    let abrupt = runs.iter().filter(|run| run.is_abrupt).count();
    let lost: usize = runs.iter().map(|run| run.lost.len()).sum();
    if (abrupt as f64) < ABRUPT_SHARE * runs.len() as f64 || lost as f64 > MOST_LOST * count as f64
    {
        return vec![];
    }
    runs.into_iter().map(|run| run.lost).collect()
}

impl SignalMap for Losses {
    fn apply(&self, signal: Sampled<'_>) -> Vec<f64> {
        let mut delivered = signal.values.to_vec();
        let measured = signal.measured.filter(|m| m.len() == delivered.len());
        let (Some(measured), true) = (measured, self.fewest.is_finite()) else {
            return delivered;
        };
        // Whole numbers count: a fit that tries 1.0001 changes nothing.
        let fewest = self.fewest.round().max(1.0) as usize;
        for lost in losses(measured, fewest) {
            delivered[lost.clone()].copy_from_slice(&measured[lost]);
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

impl Effect for Dropouts {
    fn kind(&self) -> &'static str {
        "dropouts"
    }

    fn family(&self) -> Family {
        Family::Measurement
    }

    fn site(&self) -> SiteKind {
        SiteKind::Channel
    }

    fn summary(&self) -> &'static str {
        "samples are lost: the last value is repeated, or zero stands in their place"
    }

    fn equation(&self) -> &'static str {
        "y_measured = y where the sample arrived, else the last one that did, or 0"
    }

    fn reference(&self) -> Option<&'static str> {
        Some("[BendatPiersol2010], temporary signal dropouts")
    }

    /// Fewest samples in a row that are taken for a loss; a whole number that no fit moves.
    fn parameters(&self) -> &'static [Parameter] {
        const {
            &[Parameter {
                lower: 1.0,
                ..Parameter::limit("fewest_repeats", "1")
            }]
        }
    }

    fn starts(&self, _: &SiteScale) -> Vec<Vec<f64>> {
        vec![vec![1.0]]
    }

    fn strike(
        &self,
        values: &[f64],
        signal: &[f64],
        random: &mut dyn FnMut() -> f64,
    ) -> Option<Vec<f64>> {
        let mut struck = signal.to_vec();
        let fewest = values[0].round().max(1.0);
        if !fewest.is_finite() || signal.is_empty() {
            return Some(struck);
        }
        let is_held = random() < 0.5;
        let spread = (LONGEST - fewest).max(0.0) + 1.0;
        let rate = RUNS_PER_SAMPLE * (1.0 + random());
        // Gaps between runs as between random events; one run at least.
        let gap = |random: &mut dyn FnMut() -> f64| -(1.0 - random()).ln() / rate;
        let latest = 0.5 * signal.len() as f64;
        let mut at = 1.0 + gap(random).min(latest);
        while (at as usize) < struck.len() {
            let first = at as usize;
            let length = (fewest + (random() * spread).floor()) as usize;
            let end = (first + length).min(struck.len());
            let stored = if is_held && first > 0 {
                struck[first - 1]
            } else {
                0.0
            };
            struck[first..end].fill(stored);
            // Two arrive at least before the next loss.
            at = end as f64 + 2.0 + gap(random);
        }
        Some(struck)
    }

    fn action(&self, values: &[f64]) -> Action {
        Action::Sampling(Box::new(Losses { fewest: values[0] }))
    }

    fn confused_with(&self) -> &'static [(&'static str, &'static str)] {
        &[
            (
                "outliers",
                "a single sample lost and read as zero is a spike",
            ),
            (
                "quantisation",
                "a slow signal stored in steps repeats its values as a held sample does",
            ),
        ]
    }

    fn experiment(&self) -> &'static str {
        "two sensors of the same motion on separate cables: losses strike one of them at a time"
    }
}
