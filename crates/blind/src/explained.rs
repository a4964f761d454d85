//! Whether a simpler name would do.
//!
//! A recipe asks for a kind; the draw must not be one that deserves another name. Where a single
//! wrong nominal parameter, or a simpler law at the same place, leaves nothing of what the effect
//! does, that would be the right answer.

use simgap_effects::{Family, Placed, find, sites};

use crate::BlindError;
use crate::bench::Bench;
use crate::draft::{Draft, largest};
use crate::gap::visible_gap;

/// What is left by something simpler counts from this share of the noise: over two thousand samples
/// that is a log-likelihood of 90.
const PLAIN: f64 = 0.3;
/// Nor does less of the channel count: the sampling of the inputs errs by a few thousandths.
const ACCURACY: f64 = 0.005;
/// Step of a nominal parameter, whose response is taken as proportional to it.
const STEP: f64 = 0.01;

/// Outputs of every bench: bench, output, sample.
type Outputs = Vec<Vec<Vec<f64>>>;

/// Whether something simpler than effect number `i` explains it.
pub(crate) fn is_explained(
    draft: &Draft,
    i: usize,
    with: &[Vec<Vec<f64>>],
    without: &[Vec<Vec<f64>>],
) -> Result<bool, BlindError> {
    let placed = &draft.effects[i];
    if placed.effect.family() == Family::NominalParameter {
        return Ok(false);
    }
    let mut others = draft.all();
    others.remove(draft.deviations.len() + i);
    let beside = |one: Placed| -> Result<Outputs, BlindError> {
        let mut all = others.clone();
        all.push(one);
        outputs(draft, &all)
    };
    let least = f64::max(PLAIN * draft.noise_share, ACCURACY);
    for simpler in special_cases(placed) {
        let instead = beside(simpler)?;
        if left(draft, with, &instead, None)? < least
            || left(draft, with, without, Some(&instead))? < least
        {
            return Ok(true);
        }
    }
    for parameter in single_parameters(draft) {
        let moved = beside(parameter)?;
        if left(draft, with, without, Some(&moved))? < least {
            return Ok(true);
        }
    }
    Ok(false)
}

fn outputs(draft: &Draft, effects: &[Placed]) -> Result<Outputs, BlindError> {
    let model = &draft.plant.model;
    let benches = draft.benches.iter();
    benches
        .map(|bench| bench.outputs(model, effects, 1, None))
        .collect()
}

/// The laws that the effect contains, at its place and with its values; of Stribeck's also Coulomb's
/// between the two levels.
fn special_cases(placed: &Placed) -> Vec<Placed> {
    let mut cases = vec![];
    for effect in placed
        .effect
        .contains()
        .iter()
        .filter_map(|kind| find(kind))
    {
        let count = effect.parameters().len();
        let values = placed.values[..count].to_vec();
        cases.push(Placed::new(effect, placed.at.clone(), values));
        if placed.effect.kind() == "stribeck_friction" {
            let middle = 0.5 * (placed.values[0] + placed.values[1]);
            cases.push(Placed::new(effect, placed.at.clone(), vec![middle]));
        }
    }
    cases
}

fn single_parameters(draft: &Draft) -> Vec<Placed> {
    let kinds = ["mass_error", "stiffness_error", "damping_error"];
    let effects = kinds.iter().filter_map(|kind| find(kind));
    effects
        .flat_map(|effect| {
            let places = sites(&draft.plant.model, effect.site()).into_iter();
            places.map(move |at| Placed::new(effect, at, vec![1.0 + STEP]))
        })
        .collect()
}

/// What is left of the gap on the channel that shows it most, over all records, after the initial
/// state and a share of what `direction` does are taken out. Each record may take another share, so
/// that this is less than what one value for all records would leave.
fn left(
    draft: &Draft,
    with: &[Vec<Vec<f64>>],
    without: &[Vec<Vec<f64>>],
    direction: Option<&Outputs>,
) -> Result<f64, BlindError> {
    let mut square = vec![0.0; draft.plant.model.outputs.len()];
    for (b, bench) in draft.benches.iter().enumerate() {
        let mut columns = free_responses(draft, bench)?;
        columns.extend(direction.map(|moved| difference(&moved[b], &without[b])));
        let gaps = visible_gap(&with[b], &without[b], &columns);
        for (sum, gap) in square.iter_mut().zip(gaps) {
            *sum += gap * gap / draft.benches.len() as f64;
        }
    }
    Ok(largest(&square).sqrt())
}

fn free_responses(draft: &Draft, bench: &Bench) -> Result<Vec<Vec<Vec<f64>>>, BlindError> {
    bench.free_responses(&draft.plant.model, &draft.deviations)
}

fn difference(a: &[Vec<f64>], b: &[Vec<f64>]) -> Vec<Vec<f64>> {
    a.iter()
        .zip(b)
        .map(|(a, b)| a.iter().zip(b).map(|(a, b)| a - b).collect())
        .collect()
}
