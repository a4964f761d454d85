//! Whether a set explains the check records where it starts anew in every stretch of them.
//!
//! With play, sticking and stops a motion may hang on differences that no estimate resolves: over a whole record
//! the true model goes another way than the machine. Started anew from what was measured it follows for a while;
//! a wrong law does not.

use rayon::prelude::*;
use simgap_effects::Placed;
use simgap_estimate::{EstimateError, Problem, Weights};
use simgap_simulate::Run;

use crate::answer::{NOTHING_BUT_NOISE, leaves_much};
use crate::diagnosis::Gap;
use crate::gap::{gap, predict};

/// Stretches that a check record is cut into, and samples of each at the least.
const MOST_STRETCHES: usize = 20;
const SHORTEST: usize = 60;

/// The gap on the check records, cut into stretches of which every one has its own initial state, as given, with
/// re-estimated parameters and corrected.
pub(crate) fn gap_started_anew(
    check: &Problem,
    recalibrated: &[Placed],
    corrected: &[Placed],
    weights: &Weights,
) -> Result<Gap, EstimateError> {
    let cut = check.with_runs(check.runs.iter().flat_map(stretches).collect());
    let predictions = [&[], recalibrated, corrected]
        .into_par_iter()
        .map(|effects| predict(&cut, effects, weights))
        .collect::<Result<Vec<_>, _>>()?;
    let last = (corrected, &predictions[2]);
    Ok(gap(&cut, &predictions[0], &predictions[1], last))
}

/// Whether the corrected model leaves nothing but noise of the stretches, and parameters alone more.
pub(crate) fn follows(gap: &Gap) -> bool {
    gap.corrected < NOTHING_BUT_NOISE * gap.noise_floor && !leaves_much(gap)
}

/// The note on a set that follows the check records for a while, and then goes its own way.
pub(crate) fn told(gap: &Gap) -> String {
    format!(
        "over a whole check record the corrected model goes its own way: the motion hangs on differences that no estimate resolves; started anew in every stretch it leaves {:.3} of it, parameters alone {:.3}, noise {:.3}",
        gap.corrected, gap.recalibrated, gap.noise_floor
    )
}

fn stretches(run: &Run) -> Vec<Run> {
    let count = (run.len / SHORTEST).clamp(1, MOST_STRETCHES);
    let bounds = |k: usize| k * run.len / count;
    let each = 0..count;
    each.map(|k| run.slice(bounds(k)..bounds(k + 1))).collect()
}
