//! Predictions of several steps from what was measured.
//!
//! With play, sticking and stops a motion may depend on differences that no estimate resolves: over a whole record
//! the true model departs from the machine. Started anew in every stretch from what was measured it follows for a while;
//! a wrong law does not.

use simgap_effects::Placed;
use simgap_estimate::{EstimateError, FitOptions, Problem};
use simgap_inference::bounds;
use simgap_simulate::Run;

use crate::gap::{predict, total};

/// Stretches that a check record is cut into at the most, and samples of each at the least.
const MOST_STRETCHES: usize = 20;
const SHORTEST: usize = 128;

/// What a corrected model leaves of stretches of the check records, each from an initial state of its own, over what re-estimated
/// parameters leave of them; `None` where records cannot be cut, or with a clock: set anew in every stretch it would follow anything.
pub(crate) fn left(
    check: &Problem,
    recalibrated: &[Placed],
    corrected: &[Placed],
    options: &FitOptions,
) -> Result<Option<f64>, EstimateError> {
    let has_clock = corrected
        .iter()
        .any(|placed| placed.effect.clock().is_some());
    if has_clock || !check.may_cut() {
        return Ok(None);
    }
    let cut = check.with_runs(check.runs.iter().flat_map(stretches).collect());
    let left = |placed: &[Placed]| -> Result<f64, EstimateError> {
        Ok(total(&predict(&cut, placed, options)?.nrmse))
    };
    Ok(Some(left(corrected)? / left(recalibrated)?))
}

fn stretches(run: &Run) -> impl Iterator<Item = Run> + '_ {
    let bounds = bounds(run.len, SHORTEST, MOST_STRETCHES).into_iter();
    bounds.map(|samples| run.slice(samples))
}

#[cfg(test)]
mod tests {
    use super::*;

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
                mended: simgap_simulate::Mended::default(),
                inputs: vec![vec![1.0; len]],
                measured: vec![None],
            };
            let cut: Vec<Run> = stretches(&run).collect();
            assert_eq!(cut.len(), count, "{len}");
            assert_eq!(cut.iter().map(|part| part.len).sum::<usize>(), len);
            assert!(len < SHORTEST || cut.iter().all(|part| part.len >= SHORTEST));
        }
    }
}
