//! The part of long records that is searched in.
//!
//! Laws are told apart by motions of different size: of each long record the stretch of most energy and the one of least
//! are taken, in equal parts, each with an initial state of its own.

use simgap_estimate::Start;
use simgap_simulate::Run;

/// Samples the search may use; more make it slower, not wiser.
const SEARCH_SAMPLES: usize = 12_000;

/// Stretches of records.
pub(crate) struct Excerpt {
    /// The stretches.
    pub(crate) runs: Vec<Run>,
    /// The record of each.
    record: Vec<usize>,
}

impl Excerpt {
    /// Whole records where they are short.
    pub(crate) fn of(records: &[Run]) -> Excerpt {
        let total: usize = records.iter().map(|run| run.len).sum();
        let share = SEARCH_SAMPLES as f64 / total.max(1) as f64;
        let mut excerpt = Excerpt {
            runs: vec![],
            record: vec![],
        };
        for (index, run) in records.iter().enumerate() {
            let stretches = match share < 1.0 {
                true => stretches(run, share),
                false => vec![run.clone()],
            };
            excerpt.record.extend(stretches.iter().map(|_| index));
            excerpt.runs.extend(stretches);
        }
        excerpt
    }

    /// What was fitted to the stretches, with the values of each record's first stretch as those of the record.
    pub(crate) fn to_records(&self, found: &Start) -> Start {
        let firsts: Vec<usize> = (0..self.record.len())
            .filter(|&k| k == 0 || self.record[k] != self.record[k - 1])
            .collect();
        let of_firsts = |list: &[Vec<f64>]| -> Vec<Vec<f64>> {
            let each = firsts.iter();
            each.filter_map(|k| list.get(*k).cloned()).collect()
        };
        let mut start = found.clone();
        for placed in start.effects.iter_mut().chain(&mut start.nominal) {
            placed.of_record = of_firsts(&placed.of_record);
        }
        start.initial = of_firsts(&found.initial);
        start
    }
}

/// The stretch of most energy and the one of least, in the order of time; one stretch where these overlap.
fn stretches(run: &Run, share: f64) -> Vec<Run> {
    let half = ((0.5 * run.len as f64 * share) as usize).clamp(1, run.len);
    let sums = sums_of_energy(run);
    let energy = |start: &usize| sums[start + half] - sums[*start];
    let all = 0..=(run.len - half);
    let by_energy = |a: &usize, b: &usize| energy(a).total_cmp(&energy(b));
    let most = all.clone().max_by(by_energy).unwrap_or(0);
    let apart = all.filter(|start| start.abs_diff(most) >= half);
    match apart.min_by(by_energy) {
        Some(least) => {
            let (first, last) = (most.min(least), most.max(least));
            [first, last].map(|start| run.slice(start..start + half)).into()
        }
        None => {
            let start = most.min(run.len.saturating_sub(2 * half));
            vec![run.slice(start..(start + 2 * half).min(run.len))]
        }
    }
}

/// Running sums of the squared outputs about their means, each output by its variance.
fn sums_of_energy(run: &Run) -> Vec<f64> {
    let mut energy = vec![0.0; run.len];
    for values in run.measured.iter().flatten() {
        let mean = values.iter().sum::<f64>() / values.len().max(1) as f64;
        let scale: f64 = values.iter().map(|v| (v - mean) * (v - mean)).sum();
        for (sum, value) in energy.iter_mut().zip(values) {
            *sum += (value - mean) * (value - mean) / scale.max(f64::MIN_POSITIVE);
        }
    }
    let mut sums = vec![0.0; run.len + 1];
    for (n, energy) in energy.iter().enumerate() {
        sums[n + 1] = sums[n] + energy;
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run(values: Vec<f64>) -> Run {
        Run {
            name: "a".into(),
            start_s: 0.0,
            time_step_s: 1.0,
            len: values.len(),
            first_index: 0,
            inputs: vec![],
            measured: vec![Some(values)],
        }
    }

    #[test]
    fn long_records_give_their_largest_and_their_smallest_motion() {
        let sign = |n: usize| if n.is_multiple_of(2) { 1.0 } else { -1.0 };
        let decay = |n: usize| sign(n) * (-1e-4 * n as f64).exp();
        let long = run((0..30_000).map(decay).collect());
        let found = Excerpt::of(&[long.clone(), run(vec![1.0, -1.0, 0.5])]);
        assert_eq!(found.record, [0, 0, 1]);
        assert_eq!(found.runs[0].first_index, 0);
        assert!(found.runs[1].first_index + found.runs[1].len >= 29_990);
        let whole = Excerpt::of(&[run(vec![1.0, -1.0, 0.5])]);
        assert_eq!((whole.runs.len(), whole.runs[0].len), (1, 3));
    }
}
