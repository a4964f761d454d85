//! A case before its records are written: where the effect sits, how large it is, whether it matters.

use std::f64::consts::PI;

use simgap_effects::{Effect, Family, Placed, find, sites};
use simgap_model::Model;

use crate::bench::Bench;
use crate::gap::{std, visible_gap};
use crate::plant::Plant;
use crate::random::Random;
use crate::size::{factor_for, instance, scaled, site_scale};
use crate::{BlindError, Recipe};

/// Smallest gap of an effect that matters, share of the channel's standard deviation.
pub const SMALLEST_GAP: f64 = 0.03;
/// Largest gap that is drawn.
pub const LARGEST_GAP: f64 = 0.6;
/// A gap must also be this many times the noise.
pub const GAP_OVER_NOISE: f64 = 3.0;
/// Gap of a foreign effect at least: what no catalogue entry explains must still be plain.
const SMALLEST_FOREIGN_GAP: f64 = 0.15;
/// Wrong parameters near a resonance make gaps above those drawn.
const LARGEST_PARAMETER_GAP: f64 = 1.2;
/// Halving the truth's step may move it by this share of the noise, or of the channel if larger:
/// no other program could predict a motion that depends on more.
const REPRODUCIBLE: [f64; 2] = [0.3, 0.002];

/// A case before its records are written.
pub(crate) struct Draft {
    pub(crate) plant: Plant,
    pub(crate) benches: Vec<Bench>,
    pub(crate) deviations: Vec<Placed>,
    pub(crate) effects: Vec<Placed>,
    pub(crate) gaps: Vec<f64>,
    pub(crate) noise_share: f64,
}

impl Draft {
    pub(crate) fn all(&self) -> Vec<Placed> {
        self.deviations
            .iter()
            .chain(&self.effects)
            .cloned()
            .collect()
    }
}

/// Nominal parameters as a drawing gives them: each off by at most the given share.
pub(crate) fn deviations(random: &mut Random, model: &Model, most: f64) -> Vec<Placed> {
    let mut placed = vec![];
    for effect in ["mass_error", "stiffness_error", "damping_error"]
        .iter()
        .filter_map(|kind| find(kind))
    {
        for at in sites(model, effect.site()) {
            placed.push(Placed::new(
                effect,
                at,
                vec![1.0 + random.uniform(-most, most)],
            ));
        }
    }
    placed
}

/// 8 to 30 % off, either way.
fn wrong_factor(random: &mut Random) -> f64 {
    let off = random.uniform(0.08, 0.30);
    if random.chance(0.5) {
        1.0 + off
    } else {
        1.0 / (1.0 + off)
    }
}

pub(crate) fn two_parameters(random: &mut Random, model: &Model) -> Option<Vec<Placed>> {
    let mut all: Vec<Placed> = deviations(random, model, 0.0);
    random.shuffle(&mut all);
    all.truncate(2);
    for placed in &mut all {
        placed.values = vec![wrong_factor(random)];
    }
    (all.len() == 2).then_some(all)
}

/// Puts each effect at a random legal place, at a size that matters on the first record.
pub(crate) fn place(
    random: &mut Random,
    draft: &Draft,
    recipe: &Recipe,
    wanted: &[&'static dyn Effect],
    base: &[Vec<Vec<f64>>],
) -> Result<Option<Vec<Placed>>, BlindError> {
    let model = &draft.plant.model;
    let bench = &draft.benches[0];
    let free = bench.free_responses(model, &draft.deviations)?;
    let mut effects = vec![];
    for &effect in wanted {
        let sites = sites(model, effect.site());
        let Some(at) = random.pick(&sites).cloned() else {
            return Ok(None);
        };
        let mut placed = Placed::new(effect, at, vec![wrong_factor(random)]);
        if effect.family() != Family::NominalParameter {
            let mut scale = site_scale(model, bench, &placed.at)?;
            let [from_hz, to_hz] = draft.plant.band_hz;
            let highest = (3.0 * to_hz).min(0.35 / bench.time_step_s);
            scale
                .lines_hz
                .fill(random.log_uniform(0.5 * from_hz, highest));
            scale.motion_hz[0] = random.log_uniform(from_hz, to_hz);
            let instance = instance(random, effect, &scale);
            placed.of_record = own_values(random, &placed, draft.benches.len());
            let smallest = smallest_gap(recipe, draft.noise_share) * 1.2;
            let target = random.log_uniform(smallest, LARGEST_GAP / 1.2);
            let factor = factor_for(target, |factor| {
                let mut all = draft.deviations.clone();
                all.push(Placed {
                    values: scaled(effect, &instance, factor),
                    ..placed.clone()
                });
                let with = bench.outputs(model, &all, 1, None)?;
                Ok(largest(&visible_gap(&with, &base[0], &free)))
            })?;
            let Some(factor) = factor else {
                return Ok(None);
            };
            placed.values = scaled(effect, &instance, factor);
        }
        effects.push(placed);
    }
    Ok(Some(effects))
}

/// The phases that the clock of an effect has in each record; what else a record has of its own is
/// at rest.
fn own_values(random: &mut Random, placed: &Placed, records: usize) -> Vec<Vec<f64>> {
    let places = placed.own_places();
    let clock = placed.effect.clock();
    let mut value = |place: usize| match clock {
        Some(clock) if clock.phase == place => random.uniform(-PI, PI),
        _ => placed.effect.parameters()[place].neutral.unwrap_or(0.0),
    };
    if places.is_empty() {
        return vec![];
    }
    let of_record = |_| places.iter().map(|&place| value(place)).collect();
    (0..records).map(of_record).collect()
}

fn smallest_gap(recipe: &Recipe, noise_share: f64) -> f64 {
    let matters = f64::max(SMALLEST_GAP, GAP_OVER_NOISE * noise_share);
    match recipe {
        Recipe::Foreign(_) => matters.max(SMALLEST_FOREIGN_GAP),
        _ => matters,
    }
}

fn largest(gaps: &[f64]) -> f64 {
    // A NaN among them must not be overlooked.
    gaps.iter()
        .fold(0.0, |m, &g| if g.is_nan() || g > m { g } else { m })
}

/// Outputs of every bench.
pub(crate) fn outputs(
    draft: &Draft,
    effects: &[Placed],
    refinement: usize,
) -> Result<Vec<Vec<Vec<f64>>>, BlindError> {
    draft
        .benches
        .iter()
        .map(|bench| bench.outputs(&draft.plant.model, effects, refinement, None))
        .collect()
}

/// Whether every effect matters over all records, beside the others, and the truth is reproducible.
pub(crate) fn accept(
    draft: &mut Draft,
    recipe: &Recipe,
    base: &[Vec<Vec<f64>>],
) -> Result<bool, BlindError> {
    if draft.effects.is_empty() {
        return Ok(true);
    }
    let with = outputs(draft, &draft.all(), 1)?;
    if !with.iter().flatten().flatten().all(|y| y.is_finite()) {
        return Ok(false);
    }
    let upper = match recipe {
        Recipe::Kind(kind) if is_nominal(kind) => LARGEST_PARAMETER_GAP,
        Recipe::TwoParameters => LARGEST_PARAMETER_GAP,
        _ => LARGEST_GAP,
    };
    let lower = smallest_gap(recipe, draft.noise_share);
    for i in 0..draft.effects.len() {
        let mut others = draft.all();
        others.remove(draft.deviations.len() + i);
        let without = if draft.effects.len() == 1 {
            base.to_vec()
        } else {
            outputs(draft, &others, 1)?
        };
        let gap = gap_over_records(draft, &with, &without)?;
        if !(lower..=upper).contains(&gap) {
            return Ok(false);
        }
        for simpler in simpler(&draft.effects[i]) {
            let mut instead = others.clone();
            instead.push(simpler);
            let apart = gap_over_records(draft, &with, &outputs(draft, &instead, 1)?)?;
            if apart.is_nan() || apart < lower {
                return Ok(false);
            }
        }
        draft.gaps.push(gap);
    }
    reproducible(draft, &with)
}

/// Simpler laws of which the effect is a refinement: what it adds to them must matter too, or the
/// simpler name would be the better answer.
fn simpler(placed: &Placed) -> Vec<Placed> {
    let coulomb = match placed.effect.kind() {
        "stribeck_friction" => find("coulomb_friction"),
        _ => None,
    };
    let levels = coulomb.map(|effect| {
        let [sliding, breakaway] = [placed.values[0], placed.values[1]];
        [sliding, 0.5 * (sliding + breakaway)]
            .map(|level| Placed::new(effect, placed.at.clone(), vec![level]))
    });
    levels.into_iter().flatten().collect()
}

fn is_nominal(kind: &str) -> bool {
    find(kind).is_some_and(|effect| effect.family() == Family::NominalParameter)
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
            let rms = crate::size::rms(&moved);
            rms <= allowed * std(once)
        }))
}
