//! Whether a set explains the check records where it starts anew in every stretch of them.
//!
//! With play, sticking and stops a motion may hang on differences that no estimate resolves: over a whole record
//! the true model goes another way than the machine. Started anew from what was measured it follows for a while;
//! a wrong law does not.

use std::ops::Range;

use rayon::prelude::*;
use simgap_effects::Placed;
use simgap_estimate::{EstimateError, Problem, Weights};
use simgap_simulate::Run;

use crate::diagnosis::Gap;
use crate::gap::{gap, predict};
use crate::input_noise::input_noise;
use crate::jumps::gap_of_check_between;
use crate::unexplained::NOTHING_BUT_NOISE;

/// Stretches that a check record is cut into at the most, and samples of each at the least.
const MOST_STRETCHES: usize = 20;
const SHORTEST: usize = 128;
/// What a set leaves of the stretches, over what parameters alone leave, to have followed where they do not.
const FOLLOWS: f64 = 0.7;

/// The gap on the check records, cut into stretches of which every one has its own initial state, as given, with
/// re-estimated parameters and corrected; `None` where the corrected model does not follow them.
pub(crate) fn gap_followed_anew(
    check: &Problem,
    recalibrated: &[Placed],
    corrected: &[Placed],
    weights: &Weights,
) -> Result<Option<Gap>, EstimateError> {
    let cut = check.with_runs(check.runs.iter().flat_map(stretches).collect());
    let predictions = [&[], recalibrated, corrected]
        .into_par_iter()
        .map(|effects| predict(&cut, effects, weights))
        .collect::<Result<Vec<_>, _>>()?;
    let last = (corrected, &predictions[2]);
    // Over a stretch it drives the plant less far away than over a record.
    let driven = input_noise(&cut, corrected, weights, &check.runs)?;
    let gap = gap(&cut, &predictions[0], &predictions[1], last, &driven);
    let between = gap_of_check_between(&cut, (corrected, &predictions), &gap);
    let follows = follows(&between.as_ref().unwrap_or(&gap).over_all_noise(0.0));
    Ok(Some(gap).filter(|_| follows))
}

/// Whether the corrected model leaves nothing but noise of the stretches, and parameters alone more.
fn follows(gap: &Gap) -> bool {
    gap.corrected < NOTHING_BUT_NOISE * gap.noise_floor
        && gap.corrected < FOLLOWS * gap.recalibrated
}

/// The note on a set that follows the check records for a while, and then goes its own way.
pub(crate) fn told(gap: &Gap) -> String {
    format!(
        "over a whole check record the corrected model goes its own way: the motion hangs on differences that no estimate resolves; started anew in every stretch it leaves {:.3} of it, parameters alone {:.3}, noise {:.3}",
        gap.corrected,
        gap.recalibrated,
        gap.over_all_noise(0.0).noise_floor
    )
}

fn stretches(run: &Run) -> impl Iterator<Item = Run> + '_ {
    bounds(run.len, SHORTEST, MOST_STRETCHES)
        .into_iter()
        .map(|samples| run.slice(samples))
}

/// The samples of each stretch of a record, of `shortest` or more and `most` stretches or fewer.
pub(crate) fn bounds(len: usize, shortest: usize, most: usize) -> Vec<Range<usize>> {
    let count = (len / shortest).clamp(1, most);
    let bound = |k: usize| k * len / count;
    (0..count).map(|k| bound(k)..bound(k + 1)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn gap_of(recalibrated: f64, corrected: f64, noise_floor: f64) -> Gap {
        Gap {
            metric: "nrmse",
            nominal: 0.5,
            recalibrated,
            corrected,
            noise_floor,
            input_noise: 0.0,
            closed: 0.0,
            channels: vec![],
        }
    }

    #[test]
    fn a_set_follows_where_it_leaves_noise_and_parameters_alone_do_not() {
        assert!(follows(&gap_of(0.1, 0.0105, 0.01)));
        assert!(!follows(&gap_of(0.1, 0.02, 0.01)), "more than noise");
        assert!(!follows(&gap_of(0.01, 0.01, 0.01)), "both leave noise");
        assert!(!follows(&gap_of(0.009, 0.01, 0.01)), "worse");
    }

    #[test]
    fn stretches_cover_a_run_and_are_not_short() {
        for (len, count) in [
            (0, 1),
            (127, 1),
            (255, 1),
            (256, 2),
            (1210, 9),
            (90_000, 20),
        ] {
            let run = Run {
                name: "a".into(),
                start_s: 2.0,
                time_step_s: 0.5,
                len,
                first_index: 7,
                inputs: vec![vec![1.0; len]],
                measured: vec![None],
                mended: simgap_simulate::Mended::default(),
            };
            let cut: Vec<Run> = stretches(&run).collect();
            assert_eq!(cut.len(), count, "{len}");
            assert_eq!(cut.iter().map(|part| part.len).sum::<usize>(), len);
            assert!(len < SHORTEST || cut.iter().all(|part| part.len >= SHORTEST));
            let mut next = 7;
            for part in &cut {
                assert_eq!(part.first_index, next);
                next += part.len;
            }
        }
    }
}
