//! A case before its records are written: where the effect sits, how large it is, whether it matters.

use std::f64::consts::PI;

use simgap_effects::{Effect, Family, Placed, equivalents, find, same_place, sites};
use simgap_model::{Location, Model};

use crate::bench::Bench;
use crate::gap::visible_gap;
use crate::plant::Plant;
use crate::random::Random;
use crate::size::{factor_for, instance, scaled, site_scale};
use crate::{BlindError, Level};

/// Share of the wanted range of gaps that is kept free at either end: the size is found on the first
/// record and judged over all.
const MARGIN: f64 = 1.2;
/// Gap of a record stored in steps of 0.7 of its deviation, √12 gaps each: six values or so. From
/// fewer nobody reads how the record began, the true model does not either.
const COARSEST: f64 = 0.2;

/// A case before its records are written.
pub(crate) struct Draft {
    pub(crate) plant: Plant,
    pub(crate) benches: Vec<Bench>,
    pub(crate) deviations: Vec<Placed>,
    pub(crate) effects: Vec<Placed>,
    pub(crate) gaps: Vec<f64>,
    pub(crate) noise_share: f64,
    pub(crate) level: Level,
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

/// A nominal parameter that is the cause: well off, either way.
fn wrong_factor(random: &mut Random, level: Level) -> f64 {
    let [least, most] = level.wrong();
    let off = random.uniform(least, most);
    if random.chance(0.5) {
        1.0 + off
    } else {
        1.0 / (1.0 + off)
    }
}

/// Puts two nominal parameters well off; whether there are two.
pub(crate) fn two_parameters(random: &mut Random, draft: &mut Draft) -> bool {
    let mut all: Vec<Placed> = deviations(random, &draft.plant.model, 0.0);
    random.shuffle(&mut all);
    all.truncate(2);
    for placed in &mut all {
        placed.values = vec![wrong_factor(random, draft.level)];
    }
    draft.effects = all;
    draft.effects.len() == 2
}

/// Puts each effect at a random legal place, at a size that matters on the first record; whether
/// there is such a place and size.
pub(crate) fn place(
    random: &mut Random,
    draft: &mut Draft,
    wanted: &[&'static dyn Effect],
    base: &[Vec<Vec<f64>>],
) -> Result<bool, BlindError> {
    for &effect in wanted {
        let model = &draft.plant.model;
        let sites = sites(model, effect.site());
        let Some(at) = random.pick(&sites).cloned() else {
            return Ok(false);
        };
        let mut known = draft.effects.iter();
        if known.any(|known| are_one(known, effect, &at, model)) {
            return Ok(false);
        }
        let mut placed = Placed::new(effect, at, vec![wrong_factor(random, draft.level)]);
        if effect.family() != Family::NominalParameter && !sized(random, draft, &mut placed, base)?
        {
            return Ok(false);
        }
        draft.effects.push(placed);
    }
    Ok(true)
}

/// Draws an instance of the effect and finds the size at which its gap on the first record is one
/// that is drawn; whether there is such a size. What strikes at random does so more or less often.
fn sized(
    random: &mut Random,
    draft: &mut Draft,
    placed: &mut Placed,
    base: &[Vec<Vec<f64>>],
) -> Result<bool, BlindError> {
    let (model, effect) = (&draft.plant.model, placed.effect);
    let mut bench = draft.benches[0].clone();
    let mut scale = site_scale(model, &bench, &placed.at)?;
    let [from_hz, to_hz] = draft.plant.band_hz;
    let highest = (3.0 * to_hz).min(0.35 / bench.time_step_s);
    scale
        .lines_hz
        .fill(random.log_uniform(0.5 * from_hz, highest));
    scale.motion_hz[0] = random.log_uniform(from_hz, to_hz);
    let instance = instance(random, effect, &scale);
    if instance.is_empty() {
        return Ok(false);
    }
    placed.of_record = own_values(random, placed, draft.benches.len());
    let [smallest, most] = draft.level.gap();
    let most = match effect.kind() {
        "quantisation" => most.min(COARSEST),
        _ => most,
    };
    let target = random.log_uniform(smallest * MARGIN, most / MARGIN);
    let free = bench.free_responses(model, &draft.deviations)?;
    let strikes = effect.strike(&instance, &[0.0, 1.0], &mut || 0.5).is_some();
    let values = |factor: f64| {
        if strikes {
            instance.clone()
        } else {
            scaled(effect, &instance, factor)
        }
    };
    let factor = factor_for(target, |factor| {
        bench.struck_share = factor;
        let mut all = draft.deviations.clone();
        all.push(Placed {
            values: values(factor),
            ..placed.clone()
        });
        let with = bench.outputs(model, &all, 1, None)?;
        Ok(largest(&visible_gap(&with, &base[0], &free)))
    })?;
    let Some(factor) = factor else {
        return Ok(false);
    };
    placed.values = values(factor);
    // What the catalogue knows of no machine is in no case.
    if !effect.has_support(&placed.values, &scale) {
        return Ok(false);
    }
    if strikes {
        let benches = draft.benches.iter_mut();
        benches.for_each(|bench| bench.struck_share = factor);
    }
    Ok(true)
}

/// Whether two effects of a pair would be one: a law beside a special case of it, or two that no data
/// tell apart, of which only the sum counts.
fn are_one(known: &Placed, effect: &dyn Effect, at: &Location, model: &Model) -> bool {
    let [a, b] = [known.effect.kind(), effect.kind()];
    let contained = known.effect.contains().contains(&b) || effect.contains().contains(&a);
    let same = equivalents(a, &known.at, model);
    (contained && same_place(&known.at, at))
        || same.iter().any(|e| e.kind == b && same_place(&e.at, at))
}

/// The phases that the clock of an effect has in each record, and the times at which holds begin; what else a record has of its own is at
/// rest.
fn own_values(random: &mut Random, placed: &Placed, records: usize) -> Vec<Vec<f64>> {
    let places = placed.own_places();
    let clock = placed.effect.clock();
    let mut value = |place: usize| match clock {
        Some(clock) if clock.phase == place => random.uniform(-PI, PI),
        _ => match placed.effect.parameters()[place].neutral {
            Some(rest) => rest,
            None => random.uniform(0.0, 1.0),
        },
    };
    if places.is_empty() {
        return vec![];
    }
    let of_record = |_| places.iter().map(|&place| value(place)).collect();
    (0..records).map(of_record).collect()
}

pub(crate) fn largest(gaps: &[f64]) -> f64 {
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
