//! Do values repeat the one before too often?

use super::finding::Defect;
use super::lattice::Lattice;

/// Fewest runs: one or two may be a machine at rest.
const LEAST_RUNS: usize = 3;
/// Fewest repeats that no crest explains.
const LEAST_UNEXPLAINED: usize = 3;
/// Least share of repeats worth telling.
const LEAST_FRACTION: f64 = 1e-3;
/// With fewer different values, it is a set of positions or a staircase.
const LEAST_LEVELS: usize = 6;
/// On a lattice the median change must be so many steps: else repeats are its nature.
const MEDIAN_CHANGE_STEPS: f64 = 4.0;
/// Standard deviations of the expected number of repeats that it must be exceeded by.
const EXCESS_DEVIATIONS: f64 = 5.0;

/// The defect, if any, of values of which some may be filled: a run that holds one of these is
/// explained. `held` are the levels of clipped edges, whose repeats are explained too.
pub(super) fn repeated(
    (values, filled): (&[f64], &[bool]),
    levels: &[(f64, usize)],
    lattice: Option<Lattice>,
    held: &[f64],
) -> Option<Defect> {
    if levels.len() < LEAST_LEVELS {
        return None;
    }
    let expected = match lattice {
        Some(lattice) => expected_repeats(values, lattice)?,
        None => 0.0,
    };
    let (mut runs, mut repeats, mut longest_run, mut unexplained) = (0, 0, 0, 0);
    let mut start = 0;
    for run in values.chunk_by(|a, b| a == b) {
        let end = start + run.len();
        let is_filled = filled.get(start..end).unwrap_or_default().contains(&true);
        if run.len() > 1 && !held.contains(&run[0]) && !is_filled {
            runs += 1;
            repeats += run.len() - 1;
            longest_run = longest_run.max(run.len() - 1);
            // A crest explains two equal samples beside it, and more than two on a lattice.
            let crest = start > 0
                && end < values.len()
                && (values[start - 1] < run[0]) == (values[end] < run[0]);
            if !crest || (lattice.is_none() && run.len() > 2) {
                unexplained += run.len() - 1;
            }
        }
        start = end;
    }
    let fraction = (repeats as f64 - expected) / (values.len() - 1) as f64;
    let excess = unexplained as f64 - expected;
    let told = runs >= LEAST_RUNS
        && unexplained >= LEAST_UNEXPLAINED
        && fraction >= LEAST_FRACTION
        && excess > EXCESS_DEVIATIONS * expected.sqrt();
    told.then_some(Defect::Repeated {
        fraction,
        runs,
        longest_run,
    })
}

/// Repeats to be expected on a lattice: where changes are spread over many steps, no change is as
/// frequent as a change by one step or two, up or down. `None` where they are not spread.
fn expected_repeats(values: &[f64], lattice: Lattice) -> Option<f64> {
    let mut changes: Vec<f64> = values
        .windows(2)
        .map(|pair| ((pair[1] - pair[0]) / lattice.step).abs().round())
        .collect();
    let small = changes
        .iter()
        .filter(|&&change| change == 1.0 || change == 2.0)
        .count();
    let middle = changes.len() / 2;
    let median = *changes.select_nth_unstable_by(middle, f64::total_cmp).1;
    (median >= MEDIAN_CHANGE_STEPS).then_some(small as f64 / 4.0)
}
