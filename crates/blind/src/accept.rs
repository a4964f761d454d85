//! Whether a draft is a case: its effects matter, go by their own names, and its truth can be reproduced.

use crate::BlindError;
use crate::draft::{Draft, largest, outputs};
use crate::explained::is_explained;
use crate::gap::{std, visible_gap};
use crate::size::rms;

/// Halving the truth's step may move it by this share of the noise, or of the channel if larger:
/// no other program could predict a motion that depends on more.
const REPRODUCIBLE: [f64; 2] = [0.3, 0.002];

/// Whether every effect matters over all records, beside the others, and goes by its own name, and
/// the truth is reproducible.
pub(crate) fn accept(draft: &mut Draft, base: &[Vec<Vec<f64>>]) -> Result<bool, BlindError> {
    if draft.effects.is_empty() {
        return Ok(true);
    }
    let with = outputs(draft, &draft.all(), 1)?;
    if !with.iter().flatten().flatten().all(|y| y.is_finite()) {
        return Ok(false);
    }
    let [lower, upper] = draft.level.gap();
    for i in 0..draft.effects.len() {
        let mut others = draft.all();
        others.remove(draft.deviations.len() + i);
        let without = if draft.effects.len() == 1 {
            base.to_vec()
        } else {
            outputs(draft, &others, 1)?
        };
        let gap = gap_over_records(draft, &with, &without)?;
        if !(lower..=upper).contains(&gap) || is_explained(draft, i, &with, &without)? {
            return Ok(false);
        }
        draft.gaps.push(gap);
    }
    reproducible(draft, &with)
}

/// On the channel that shows it most, the root mean square of the gaps of the records.
fn gap_over_records(
    draft: &Draft,
    with: &[Vec<Vec<f64>>],
    without: &[Vec<Vec<f64>>],
) -> Result<f64, BlindError> {
    let model = &draft.plant.model;
    let mut square = vec![0.0; model.outputs.len()];
    for (bench, (with, without)) in draft.benches.iter().zip(with.iter().zip(without)) {
        let gaps = visible_gap(
            with,
            without,
            &bench.free_responses(model, &draft.deviations)?,
        );
        for (sum, gap) in square.iter_mut().zip(gaps) {
            *sum += gap * gap / draft.benches.len() as f64;
        }
    }
    Ok(largest(&square).sqrt())
}

fn reproducible(draft: &Draft, with: &[Vec<Vec<f64>>]) -> Result<bool, BlindError> {
    let finer = outputs(draft, &draft.all(), 2)?;
    let allowed = f64::max(REPRODUCIBLE[0] * draft.noise_share, REPRODUCIBLE[1]);
    Ok(with
        .iter()
        .flatten()
        .zip(finer.iter().flatten())
        .all(|(once, again)| {
            let moved: Vec<f64> = once.iter().zip(again).map(|(a, b)| a - b).collect();
            rms(&moved) <= allowed * std(once)
        }))
}
