//! From a seed and a recipe to a case.

use simgap_effects::{Action, Effect, Family, Placed, find, sites};
use simgap_model::{Location, Model};
use simgap_record::{Channel, Record};

use crate::bench::Bench;
use crate::case::{Case, Status, Truth};
use crate::excitation::{self, Range, Signal};
use crate::gap::{std, visible_gap};
use crate::plant::{self, Plant, input_unit, output_unit};
use crate::random::Random;
use crate::recipe::known_kinds;
use crate::size::{factor_for, instance, scaled, site_scale};
use crate::{BlindError, Recipe, equivalents, foreign_effects};

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
/// Noise as a share of the channel's standard deviation, lowest and highest draw.
const NOISE: [f64; 2] = [0.001, 0.05];
/// Samples of a record, lowest and highest draw.
const SAMPLES: [f64; 2] = [1000.0, 6000.0];
/// Draws before a recipe is given up.
const ATTEMPTS: u64 = 200;
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

/// Generates the case of a number in the campaign of a seed. The same arguments give the same
/// case to the last bit.
///
/// Two records to learn from, one to judge by, with different excitations or sizes. The truth is
/// stepped [`crate::OVERSAMPLING`] times as finely as the records are sampled.
///
/// # Errors
/// [`BlindError::UnknownKind`] for a recipe of an unknown kind, [`BlindError::NoCase`] when the
/// kind never matters on any plant drawn.
///
/// ```
/// use simgap_blind::{Recipe, Status, generate};
/// let case = generate(1, 17, &Recipe::Kind("cubic_stiffness".into()))?;
/// assert_eq!(case.name, "case-0017");
/// assert_eq!(case.truth.status, Status::Effect);
/// assert_eq!((case.train.len(), case.check.len()), (2, 1));
/// # Ok::<(), simgap_blind::BlindError>(())
/// ```
pub fn generate(seed: u64, number: usize, recipe: &Recipe) -> Result<Case, BlindError> {
    let wanted = wanted(recipe)?;
    for attempt in 0..ATTEMPTS {
        let mut random = Random::of_case(seed, number, attempt);
        if let Some(draft) = draft(&mut random, recipe, &wanted)? {
            return finish(&mut random, number, recipe, &draft);
        }
    }
    Err(BlindError::NoCase {
        number,
        recipe: recipe.to_string(),
        attempts: ATTEMPTS,
    })
}

/// The effects a recipe names; nominal parameters of [`Recipe::TwoParameters`] are drawn later.
fn wanted(recipe: &Recipe) -> Result<Vec<&'static dyn Effect>, BlindError> {
    let unknown = |found: &String| BlindError::UnknownKind {
        found: found.clone(),
        known: known_kinds(),
    };
    let known = |kind: &String| find(kind).ok_or_else(|| unknown(kind));
    Ok(match recipe {
        Recipe::Noise | Recipe::TwoParameters => vec![],
        Recipe::Kind(kind) => vec![known(kind)?],
        Recipe::Pair(a, b) => vec![known(a)?, known(b)?],
        Recipe::Foreign(kind) => vec![
            foreign_effects()
                .into_iter()
                .find(|effect| effect.kind() == kind)
                .ok_or_else(|| unknown(kind))?,
        ],
    })
}

/// One try; `None` when this draw has no place for the effect, or the effect does not matter there.
pub(crate) fn draft(
    random: &mut Random,
    recipe: &Recipe,
    wanted: &[&'static dyn Effect],
) -> Result<Option<Draft>, BlindError> {
    let plant = plant::draw(random)?;
    let benches = benches(random, &plant);
    let noise_share = random.log_uniform(NOISE[0], NOISE[1]);
    let nominal = |effect: &&'static dyn Effect| effect.family() == Family::NominalParameter;
    let right_parameters = matches!(recipe, Recipe::Noise | Recipe::TwoParameters)
        || wanted.iter().any(|effect| nominal(effect));
    let deviations = if right_parameters || random.chance(0.5) {
        vec![]
    } else {
        let most = random.uniform(0.002, 0.02);
        deviations(random, &plant.model, most)
    };
    let mut draft = Draft {
        plant,
        benches,
        deviations,
        effects: vec![],
        gaps: vec![],
        noise_share,
    };
    let base = outputs(&draft, &draft.deviations, 1)?;
    if !base.iter().flatten().all(|y| std(y).is_normal()) {
        return Ok(None);
    }
    let effects = match recipe {
        Recipe::TwoParameters => two_parameters(random, &draft.plant.model),
        _ => place(random, &draft, recipe, wanted, &base)?,
    };
    let Some(effects) = effects else {
        return Ok(None);
    };
    draft.effects = effects;
    let accepted = accept(&mut draft, recipe, &base)?;
    Ok(accepted.then_some(draft))
}

fn benches(random: &mut Random, plant: &Plant) -> Vec<Bench> {
    let driven = !plant.model.inputs.is_empty();
    let at_rest = driven && random.chance(0.5);
    let usual = random.below(excitation::STYLES);
    let varied = random.chance(0.6);
    let start_s = if random.chance(0.2) {
        random.uniform(1.0, 100.0).round()
    } else {
        0.0
    };
    // The second record is weaker or stronger; the record to judge by differs from both.
    let sizes = [1.0, random.log_uniform(0.35, 1.3), random.uniform(0.5, 1.0)];
    sizes
        .iter()
        .map(|size| {
            let len = random.log_uniform(SAMPLES[0], SAMPLES[1]) as usize;
            let time_step_s = 1.0 / plant.sample_rate_hz;
            let style = if varied {
                random.below(excitation::STYLES)
            } else {
                usual
            };
            let range = Range {
                from_hz: plant.band_hz[0],
                to_hz: plant.band_hz[1],
                amplitude: plant.amplitude * size,
                duration_s: len as f64 * time_step_s,
            };
            let signals: Vec<Signal> = plant
                .model
                .inputs
                .iter()
                .map(|_| excitation::draw(random, style, &range))
                .collect();
            let moved = if at_rest {
                0.0
            } else {
                size * plant.displacement_m
            };
            let mut state = |scale: f64| -> Vec<f64> {
                (0..plant.model.dof_count())
                    .map(|_| random.sign() * random.uniform(0.3, 1.0) * scale)
                    .collect()
            };
            let displacement = state(moved);
            let speed = std::f64::consts::TAU * plant.band_hz[0];
            let velocity = state(if driven { moved * speed } else { 0.0 });
            let lead = if at_rest || !driven {
                0
            } else {
                2 * (16 + random.below(100))
            };
            Bench {
                signals,
                displacement,
                velocity,
                time_step_s,
                lead,
                len,
                start_s,
            }
        })
        .collect()
}

/// Nominal parameters as a drawing gives them: each off by at most the given share.
fn deviations(random: &mut Random, model: &Model, most: f64) -> Vec<Placed> {
    let mut placed = vec![];
    for effect in ["mass_error", "stiffness_error", "damping_error"]
        .iter()
        .filter_map(|kind| find(kind))
    {
        for at in sites(model, effect.site()) {
            placed.push(Placed {
                effect,
                at,
                values: vec![1.0 + random.uniform(-most, most)],
            });
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

fn two_parameters(random: &mut Random, model: &Model) -> Option<Vec<Placed>> {
    let mut all: Vec<Placed> = deviations(random, model, 0.0);
    random.shuffle(&mut all);
    all.truncate(2);
    for placed in &mut all {
        placed.values = vec![wrong_factor(random)];
    }
    (all.len() == 2).then_some(all)
}

/// Puts each effect at a random legal place, at a size that matters on the first record.
fn place(
    random: &mut Random,
    draft: &Draft,
    recipe: &Recipe,
    wanted: &[&'static dyn Effect],
    base: &[Vec<Vec<f64>>],
) -> Result<Option<Vec<Placed>>, BlindError> {
    let model = &draft.plant.model;
    let bench = &draft.benches[0];
    let free = bench.free_responses(model)?;
    let mut effects = vec![];
    for &effect in wanted {
        let sites = sites(model, effect.site());
        let Some(at) = random.pick(&sites).cloned() else {
            return Ok(None);
        };
        let mut placed = Placed {
            effect,
            at,
            values: vec![wrong_factor(random)],
        };
        if effect.family() != Family::NominalParameter {
            let scale = site_scale(model, bench, &placed.at)?;
            let instance = instance(random, effect, &scale);
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
fn accept(draft: &mut Draft, recipe: &Recipe, base: &[Vec<Vec<f64>>]) -> Result<bool, BlindError> {
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
        draft.gaps.push(gap);
    }
    reproducible(draft, &with)
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
        let gaps = visible_gap(with, without, &bench.free_responses(model)?);
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

fn finish(
    random: &mut Random,
    number: usize,
    recipe: &Recipe,
    draft: &Draft,
) -> Result<Case, BlindError> {
    let name = format!("case-{number:04}");
    let input_noise = if random.chance(0.15) {
        random.log_uniform(0.001, 0.005)
    } else {
        0.0
    };
    let records = draft
        .benches
        .iter()
        .zip(["a", "b", "c"])
        .map(|(bench, letter)| {
            let file = format!("{name}-{letter}.csv");
            record(random, draft, bench, &file, input_noise)
        })
        .collect::<Result<Vec<_>, _>>()?;
    let (train, check) = records.split_at(2);
    Ok(Case {
        name,
        model: draft.plant.model.clone(),
        train: train.to_vec(),
        check: check.to_vec(),
        truth: truth(recipe, draft),
    })
}

fn record(
    random: &mut Random,
    draft: &Draft,
    bench: &Bench,
    file: &str,
    input_noise: f64,
) -> Result<Record, BlindError> {
    let model = &draft.plant.model;
    let clean = bench.outputs(model, &draft.all(), 1, None)?;
    let noise: Vec<Vec<f64>> = clean
        .iter()
        .map(|signal| white(random, signal.len(), draft.noise_share * std(signal)))
        .collect();
    let measured = bench.outputs(model, &draft.all(), 1, Some(&noise))?;
    let mut channels = vec![];
    for (input, mut values) in model.inputs.iter().zip(bench.inputs()) {
        // A displacement is differentiated by whoever simulates: its noise would be all there is.
        if input.kind == simgap_model::InputKind::Force && input_noise > 0.0 {
            let noise = white(random, values.len(), input_noise * std(&values));
            values.iter_mut().zip(noise).for_each(|(u, e)| *u += e);
        }
        let unit = input_unit(model, input.kind);
        channels.push(Channel::new(&input.channel, unit, values));
    }
    for (output, values) in model.outputs.iter().zip(measured) {
        let unit = output_unit(model, output.kind);
        channels.push(Channel::new(&output.channel, unit, values));
    }
    Ok(Record::from_uniform(
        file,
        bench.start_s,
        bench.time_step_s,
        channels,
    )?)
}

fn white(random: &mut Random, len: usize, std: f64) -> Vec<f64> {
    (0..len).map(|_| std * random.normal()).collect()
}

fn truth(recipe: &Recipe, draft: &Draft) -> Truth {
    let nominal = |placed: &Placed| placed.effect.family() == Family::NominalParameter;
    let status = match recipe {
        Recipe::Noise => Status::None,
        Recipe::Foreign(_) => Status::Unknown,
        _ if draft.effects.iter().all(nominal) => Status::Parameters,
        _ => Status::Effect,
    };
    Truth {
        status,
        effects: draft.effects.iter().map(Placed::to_entry).collect(),
        equivalents: (0..draft.effects.len())
            .map(|i| equivalents_beside_others(draft, i))
            .collect(),
        deviations: draft.deviations.iter().map(Placed::to_entry).collect(),
        noise_share: draft.noise_share,
        gaps: draft.gaps.clone(),
        closable: matches!(status, Status::Parameters | Status::Effect),
    }
}

/// Equivalences hold on a linear plant: a nonlinear force beside the effect breaks them.
fn equivalents_beside_others(draft: &Draft, i: usize) -> Vec<crate::Equivalent> {
    let nonlinear = |placed: &Placed| {
        matches!(placed.action(), Action::Force(_))
            && !["constant_force", "harmonic_force"].contains(&placed.effect.kind())
    };
    let beside = draft.effects.iter().enumerate().filter(|&(j, _)| j != i);
    if beside.map(|(_, placed)| placed).any(nonlinear) {
        return vec![];
    }
    let placed = &draft.effects[i];
    let at: &Location = &placed.at;
    equivalents(placed.effect.kind(), at, &draft.plant.model)
}
