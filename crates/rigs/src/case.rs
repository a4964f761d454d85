//! A case: machine, records, truth.

use serde_json::{Value, json};

use crate::accept::accepted;
use crate::bench::{Bench, draw_setup, shapes_for};
use crate::chain::Noise;
use crate::draft::Draft;
use crate::effect::{Effect, FLIPPED};
use crate::families::{FAMILIES, draw_plant};
use crate::plan::{Filter, Role, Wanted, wanted, wanted_instead};
use crate::plant::Plant;
use crate::rng::Rng;
use crate::truth::{Named, Truth, TruthNoise};

/// Tries until a machine, a place and a size fit together.
const TRIES: usize = 400;

/// A case as it is handed over.
#[derive(Debug, Clone)]
pub struct Case {
    /// Folder name.
    pub name: String,
    /// Files by name.
    pub files: Vec<(String, String)>,
    /// What is withheld.
    pub truth: Truth,
    /// For checks: the bench and the effects it was made with.
    pub bench: Bench,
    /// The effects, nominal parameters aside.
    pub effects: Vec<Effect>,
    /// The plant as the model file has it.
    pub nominal: Plant,
}

/// Why a case cannot be drawn.
#[derive(Debug, thiserror::Error)]
pub enum RigError {
    /// No machine was found that shows the effect.
    #[error("case {number} of seed {seed}: no machine shows {kinds} after {tries} tries")]
    NoMachine {
        /// Seed.
        seed: u64,
        /// Number.
        number: usize,
        /// What was to be shown.
        kinds: String,
        /// Tries.
        tries: usize,
    },
}

/// Kinds that are tried in the place of one that no machine shows (two of a pair may hide each other), itself first.
const OTHERS: usize = 8;

/// Draws a case.
///
/// # Errors
/// [`RigError`] where no machine shows what is wanted.
pub fn draw_case(seed: u64, number: usize, filter: &Filter) -> Result<Case, RigError> {
    let others = if filter.kind.is_some() { 1 } else { OTHERS };
    for instead in 0..others {
        let wanted = wanted_instead(seed, number, filter, instead);
        for attempt in 0..TRIES {
            let label = format!("rigs/1/{seed}/{number}/{}/{attempt}", wanted.role.name());
            let mut rng = Rng::new(&label);
            if let Some(case) = attempt_case(&wanted, number, &mut rng) {
                return Ok(case);
            }
        }
    }
    Err(RigError::NoMachine {
        seed,
        number,
        kinds: wanted(seed, number, filter).kinds.join(" and "),
        tries: TRIES,
    })
}

fn attempt_case(wanted: &Wanted, number: usize, rng: &mut Rng) -> Option<Case> {
    let family = *rng.pick(&FAMILIES);
    let nominal = draw_plant(family, rng);
    let spread = match wanted.role {
        Role::Mixed => crate::deviate::WIDE,
        _ => crate::deviate::SPREAD,
    };
    let (plant, deviations) = crate::deviate::deviated(&nominal, spread, rng);
    let setups = setups(&plant, wanted, rng);
    let bench = Bench {
        without: plant.clone(),
        plant,
        setups,
    };
    let draft = Draft {
        nominal,
        bench,
        effects: vec![],
        wrong: vec![],
        deviations,
        gap: 0.0,
        gaps: vec![],
    };
    let draft = crate::cause::with_cause(draft, wanted, rng)?;
    finish(draft, wanted, number, rng)
}

fn setups(plant: &Plant, wanted: &Wanted, rng: &mut Rng) -> Vec<crate::bench::Setup> {
    let held = !wanted
        .kinds
        .iter()
        .any(|k| k.contains("delay") || k.contains("lag"))
        && plant.control.is_none()
        && rng.chance(0.08);
    let shapes = shapes_for(plant, held);
    let records = rng.whole(3, 4);
    let periods = rng.log_uniform(8.0, 40.0);
    let rate = plant.rate_hz * if held { 2.0 } else { 1.0 };
    let samples = (periods * rate / plant.band_hz.0).clamp(800.0, 6000.0);
    let same = rng.chance(0.85);
    (0..records)
        .map(|r| {
            let fast = !same && r == records - 1;
            let step_s = if fast { 0.5 } else { 1.0 } / rate;
            let size = samples * rng.uniform(0.8, 1.2);
            let size = (size.clamp(800.0, 6000.0)) as usize;
            draw_setup(plant, &shapes, step_s, size, rng)
        })
        .collect()
}

/// Noise, substeps, records and truth.
fn finish(draft: Draft, wanted: &Wanted, number: usize, rng: &mut Rng) -> Option<Case> {
    let bench = &draft.bench;
    let mut share = rng.log_uniform(1e-4, 1e-2);
    if draft.gap > 0.0 {
        share = share.min(draft.gap / 4.0);
    }
    let ar1 = if rng.chance(1.0 / 3.0) {
        rng.uniform(0.3, 0.9)
    } else {
        0.0
    };
    let input_noise = match rng.chance(0.2) && !bench.plant.inputs.is_empty() {
        true => rng.uniform(1e-3, 5e-3),
        false => 0.0,
    };
    let all: Vec<Effect> = draft.effects.iter().chain(&draft.wrong).cloned().collect();
    let level = crate::records::noise_levels(bench, &all, share)?;
    let substeps = bench.substeps(&draft.effects, 0, &level)?;
    let noise: Vec<Noise> = level.iter().map(|rms| Noise { rms: *rms, ar1 }).collect();
    let name = format!("case-{number:04}");
    let mut files = vec![("model.toml".to_owned(), draft.nominal.to_toml(&name))];
    let last = bench.setups.len() - 1;
    for record in 0..bench.setups.len() {
        let file = match record == last {
            true => "check.csv".to_owned(),
            false => format!("train-{}.csv", record + 1),
        };
        let text = crate::records::csv(&draft, record, substeps, &noise, input_noise, rng)?;
        files.push((file, text));
    }
    let noise = TruthNoise {
        rms_share: share,
        ar1,
        input_share: input_noise,
    };
    let truth = truth(&draft, wanted, &name, noise);
    Some(Case {
        name,
        files,
        truth,
        bench: draft.bench,
        effects: draft.effects,
        nominal: draft.nominal,
    })
}

fn named(draft: &Draft, all: &[Effect], e: &Effect, twins: bool) -> Named {
    let plant = &draft.bench.plant;
    let accept = match twins {
        true => accepted(&draft.bench, all, e),
        false => vec![],
    };
    let twin = |(kind, at): &crate::accept::Name| crate::truth::Twin {
        kind: (*kind).to_owned(),
        at: plant.place_json(*at),
    };
    let parameters = e
        .values
        .iter()
        .map(|(name, value)| ((*name).to_owned(), json!(value)));
    let mut parameters: serde_json::Map<String, Value> = parameters.collect();
    if !e.phases.is_empty() {
        parameters.insert("phase_rad".into(), json!(e.phases));
    }
    Named {
        kind: contract_kind(e).to_owned(),
        at: plant.place_json(e.at),
        parameters,
        accept: accept.iter().map(twin).collect(),
    }
}

/// The kind by which the contract knows an effect: an input that was recorded with the other sign has a gain of -1.
fn contract_kind(e: &Effect) -> &'static str {
    match e.kind {
        FLIPPED => "input_gain",
        kind => kind,
    }
}

fn truth(draft: &Draft, wanted: &Wanted, name: &str, noise: TruthNoise) -> Truth {
    let catalogued =
        |e: &&Effect| !e.kind.starts_with("foreign_") && e.kind != "sensor_not_connected";
    let all: Vec<Effect> = draft.effects.iter().chain(&draft.wrong).cloned().collect();
    let known: Vec<&Effect> = all.iter().filter(catalogued).collect();
    let status = match (wanted.role, known.len() == all.len()) {
        (Role::Mixed, _) => "effect",
        (_, false) => "unknown",
        (Role::Clean, _) => "none",
        (Role::Parameters, _) => "parameters",
        (_, true) if known.iter().all(|e| contract_kind(e) == "input_gain") => "parameters",
        _ => "effect",
    };
    let effects = known
        .iter()
        .map(|e| named(draft, &all, e, e.kind != FLIPPED))
        .collect();
    let foreign = all.iter().filter(|e| !catalogued(e));
    let setups = draft.bench.setups.iter();
    Truth {
        name: name.to_owned(),
        role: wanted.role,
        status: status.to_owned(),
        effects,
        foreign: foreign.map(|e| named(draft, &all, e, false)).collect(),
        deviations: draft
            .deviations
            .iter()
            .map(|e| named(draft, &all, e, false))
            .collect(),
        noise,
        gap: draft.gap,
        gaps: draft.gaps.clone(),
        plant: draft.nominal.family.to_owned(),
        closed_loop: draft.nominal.control.is_some(),
        slip: (wanted.role == Role::Slip).then(|| wanted.kinds[0].to_owned()),
        excitations: setups
            .map(|s| s.shape.map_or("free", |shape| shape.name()).to_owned())
            .collect(),
    }
}
