//! The cause of a case: drawn, placed and sized.

use crate::deviate::apply;
use crate::draft::Draft;
use crate::effect::{Effect, FLIPPED};
use crate::kinds::{PARAMETERS, group};
use crate::plan::{Role, Wanted};
use crate::plant::{Place, Quantity, Unit};
use crate::rng::Rng;
use crate::sizing::{NEAR, far_off, largest, sized, swings_little};

/// Gap of a channel that an effect may cause, as a share of its motion.
const GAP: (f64, f64) = (0.03, 0.6);
/// Gaps that are aimed at.
const USUAL: (f64, f64) = (GAP.0 * NEAR, GAP.1 / NEAR);

/// Adds the cause; `None` where this machine does not show it.
pub(crate) fn with_cause(draft: Draft, wanted: &Wanted, rng: &mut Rng) -> Option<Draft> {
    match wanted.role {
        Role::Clean => {
            let shown = draft.bench.run(&draft.bench.plant, &[], 0, 8).is_some();
            (shown && swings_little(&draft.bench)).then_some(draft)
        }
        Role::Parameters => parameters(draft, rng),
        Role::Slip => slip(draft, wanted.kinds[0], rng),
        Role::Mixed => crate::mixed::mixed(draft, wanted.kinds[0], rng),
        Role::Single | Role::Pair | Role::Foreign => effects(draft, wanted, rng),
    }
}

fn effects(mut draft: Draft, wanted: &Wanted, rng: &mut Rng) -> Option<Draft> {
    if !swings_little(&draft.bench) || wanted.kinds.windows(2).any(|k| group(k[0]) == group(k[1])) {
        return None;
    }
    let plain = draft.bench.run(&draft.bench.plant, &[], 0, 8)?.1;
    let free = draft.bench.free_responses(0);
    for kind in &wanted.kinds {
        let effect = sized(&draft.bench, kind, (&plain, &free), USUAL, rng)?;
        draft.effects.push(effect);
    }
    judged(draft)
}

/// Measures the gap on the check record and on the first; `None` where it is not within the bounds.
fn judged(mut draft: Draft) -> Option<Draft> {
    let check = draft.bench.setups.len() - 1;
    let all: Vec<Effect> = draft.effects.iter().chain(&draft.wrong).cloned().collect();
    let mut least = f64::INFINITY;
    for record in [0, check] {
        let free = draft.bench.free_responses(record);
        let gaps = draft.bench.gap(&all, record, &free)?;
        draft.gap = largest(&gaps);
        least = least.min(draft.gap);
        draft.gaps = gaps;
        // Each of a pair must matter beside the other.
        if draft.effects.len() > 1 && record == check {
            for effect in &draft.effects {
                let alone = draft
                    .bench
                    .gap(std::slice::from_ref(effect), record, &free)?;
                let apart = alone.iter().zip(&draft.gaps).map(|(a, g)| (a - g).abs());
                if largest(&alone) < GAP.0 || apart.fold(0.0, f64::max) < 0.1 * GAP.0 {
                    return None;
                }
            }
        }
    }
    let upper = if draft.effects.len() > 1 {
        1.3 * GAP.1
    } else {
        1.1 * GAP.1
    };
    draft.gap = draft.gap.min(least);
    (draft.gap >= GAP.0 && draft.gap <= upper).then_some(draft)
}

fn parameters(mut draft: Draft, rng: &mut Rng) -> Option<Draft> {
    let count = if rng.chance(0.25) { 2 } else { 1 };
    for _ in 0..count {
        let kind = *rng.pick(&PARAMETERS);
        let wrong = far_off(&draft.bench, kind, rng)?;
        let is_same = |e: &Effect| e.kind == kind && e.at == wrong.at;
        if draft.wrong.iter().any(is_same) {
            return None;
        }
        apply(&mut draft.bench.plant, &wrong);
        draft.wrong.push(wrong);
    }
    if !swings_little(&draft.bench) {
        return None;
    }
    let check = draft.bench.setups.len() - 1;
    let wrong = draft.wrong.clone();
    for record in [0, check] {
        let free = draft.bench.free_responses(record);
        let gaps = draft.bench.gap(&wrong, record, &free)?;
        draft.gap = largest(&gaps);
        draft.gaps = gaps;
        if draft.gap < GAP.0 {
            return None;
        }
        // Each of two must matter alone.
        for one in wrong.iter().filter(|_| wrong.len() > 1) {
            let mut bench = draft.bench.clone();
            bench.plant = bench.without.clone();
            apply(&mut bench.plant, one);
            let alone = bench.gap(std::slice::from_ref(one), record, &free)?;
            if largest(&alone) < GAP.0 {
                return None;
            }
        }
    }
    // The true factor is of what the model file says: the small error is part of it.
    for wrong in &mut draft.wrong {
        let same = |e: &&Effect| e.kind == wrong.kind && e.at == wrong.at;
        let small = draft
            .deviations
            .iter()
            .find(same)
            .map_or(1.0, |e| e.values[0].1);
        if wrong.kind != "input_gain" {
            wrong.values[0].1 *= small;
        }
    }
    let wrong = &draft.wrong;
    draft
        .deviations
        .retain(|d| !wrong.iter().any(|w| w.kind == d.kind && w.at == d.at));
    Some(draft)
}

/// The factor that a unit read wrongly leaves.
fn misread(unit: Unit, quantity: Option<Quantity>) -> Option<f64> {
    match (unit.0, quantity) {
        ("m" | "m/s" | "N" | "rad" | "rad/s", _) => Some(1000.0),
        ("m/s^2", _) => Some(1.0 / 9.806_65),
        ("mm" | "mm/s" | "kN", _) => Some(1e-3),
        _ => None,
    }
}

fn slip(mut draft: Draft, kind: &'static str, rng: &mut Rng) -> Option<Draft> {
    let plant = &draft.bench.plant;
    let channel = rng.below(plant.outputs.len());
    let gain = |kind, at, factor| Effect {
        kind,
        at,
        values: vec![("gain_factor", factor)],
        phases: vec![],
    };
    let effect = match kind {
        "unit_output" => {
            let output = &plant.outputs[channel];
            let factor = misread(output.unit, Some(output.quantity))?;
            gain("sensor_gain", Place::Channel(channel), factor)
        }
        "sign_output" => gain("sensor_gain", Place::Channel(channel), -1.0),
        "not_connected" => Effect {
            kind: "sensor_not_connected",
            at: Place::Channel(channel),
            values: vec![],
            phases: vec![],
        },
        _ if plant.inputs.is_empty() => return None,
        "sign_input" if plant.outputs.len() == 1 => gain("sensor_gain", Place::Channel(0), -1.0),
        "sign_input" => gain(FLIPPED, Place::Input(0), -1.0),
        _ => gain(
            "input_gain",
            Place::Input(0),
            1.0 / misread(plant.inputs[0].unit, None)?,
        ),
    };
    let twice =
        kind == "sign_input" || kind == "unit_input" || effect.kind == "sensor_not_connected";
    if !swings_little(&draft.bench) {
        return None;
    }
    if !twice {
        let check = draft.bench.setups.len() - 1;
        let free = draft.bench.free_responses(check);
        let gaps = draft
            .bench
            .gap(std::slice::from_ref(&effect), check, &free)?;
        draft.gap = largest(&gaps);
        if draft.gap < GAP.0 {
            return None;
        }
    }
    draft.effects.push(effect);
    Some(draft)
}
