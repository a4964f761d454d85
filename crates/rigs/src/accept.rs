//! Other names of an effect that no data of a plant could tell from it: exact identities only.

use crate::bench::Bench;
use crate::effect::Effect;
use crate::linear::{dot, remainder};
use crate::plant::{Place, Plant};

/// Kinds that leave a linear plant linear.
const LINEAR: [&str; 26] = [
    "mass_error",
    "stiffness_error",
    "damping_error",
    "input_gain",
    "viscous_damping",
    "linear_stiffness",
    "constant_force",
    "harmonic_force",
    "attached_mode",
    "flexible_support",
    "input_lag",
    "input_delay",
    "sensor_bias",
    "sensor_gain",
    "sensor_drift",
    "sensor_delay",
    "sensor_lag",
    "clipping",
    "quantisation",
    "alternating_timing",
    "alternating_gain",
    "tone_pickup",
    "dropouts",
    "outliers",
    "clock_skew",
    "time_varying_stiffness",
];

/// A kind at a place.
pub type Name = (&'static str, Place);

/// Other names of `effect` among all `effects` of a plant.
#[must_use]
pub fn accepted(bench: &Bench, effects: &[Effect], effect: &Effect) -> Vec<Name> {
    let plant = &bench.plant;
    let others = effects.iter().all(|e| LINEAR.contains(&e.kind));
    let linear = others && plant.pendulum.is_empty();
    let single = plant.inputs.len() == 1 && plant.outputs.len() == 1;
    let mut names = law_twins(effect);
    if single {
        names.extend(delay_twins(effect));
        let still = !effects.iter().any(|e| e.kind == "time_varying_stiffness");
        if linear && still {
            names.extend(chain_twins(plant, effect));
        }
    }
    if plant.inputs.is_empty() && linear && plant.outputs.len() == 2 && effect.kind == "sensor_gain"
    {
        // Without inputs the size of the motion is free: one gain up is the other one down.
        names.extend((0..2).map(|c| ("sensor_gain", Place::Channel(c))));
    }
    if linear && plant.outputs.len() == 1 && effects.len() == 1 {
        names.extend(tone_twins(plant, effect));
    }
    if linear && effects.len() == 1 {
        names.extend(constant_twins(bench, effect));
    }
    names.retain(|name| *name != (effect.kind, effect.at));
    names
}

/// Laws that are the same formula.
fn law_twins(e: &Effect) -> Vec<Name> {
    let name = match e.kind {
        // A contact without damping is a spring that is stiffer beyond a point.
        "end_stop" if e.get("contact_damping_time_s") == 0.0 => "bilinear_stiffness",
        "bilinear_stiffness" if e.get("stiffness_change_n_per_m") > 0.0 => "end_stop",
        // Dahl's law is Bouc and Wen's with n = 1 and gamma = 0.
        "presliding_friction" if e.get("damping_time_s") == 0.0 => "hysteresis",
        "hysteresis" if e.get("exponent") == 1.0 && e.get("loop_share") == 1.0 => {
            "presliding_friction"
        }
        _ => return vec![],
    };
    vec![(name, e.at)]
}

/// One input, one output: a machine that is driven later answers later.
fn delay_twins(e: &Effect) -> Vec<Name> {
    match e.kind {
        "input_delay" => vec![("sensor_delay", Place::Channel(0))],
        "sensor_delay" => vec![("input_delay", Place::Input(0))],
        _ => vec![],
    }
}

/// One input, one output, linear: parts in a row may be swapped.
fn chain_twins(plant: &Plant, e: &Effect) -> Vec<Name> {
    let (input, channel) = (Place::Input(0), Place::Channel(0));
    let mut gains = vec![("input_gain", input), ("sensor_gain", channel)];
    // A negative factor is one of the sensor only.
    if e.kind == "sensor_gain" && e.get("gain_factor") < 0.0 {
        gains.remove(0);
    }
    let members: Vec<Place> = plant
        .member_pairs()
        .iter()
        .map(|p| Place::Between(p.0, p.1))
        .collect();
    let parts = (plant.masses.len(), plant.springs.len(), plant.dampers.len());
    match parts {
        (1, 0, 0) => gains.push(("mass_error", Place::Mass(0))),
        (0, 1, 0) => gains.push(("stiffness_error", members[0])),
        (0, 0, 1) => gains.push(("damping_error", members[0])),
        _ => {}
    }
    match e.kind {
        "input_lag" => vec![("sensor_lag", channel)],
        "sensor_lag" => vec![("input_lag", input)],
        kind if gains.iter().any(|g| g.0 == kind) => gains,
        _ => vec![],
    }
}

/// One output of a linear plant: a force at one frequency on any mass is a tone in it.
fn tone_twins(plant: &Plant, e: &Effect) -> Vec<Name> {
    if !matches!(e.kind, "harmonic_force" | "tone_pickup") {
        return vec![];
    }
    let masses = (0..plant.masses.len()).map(|i| ("harmonic_force", Place::Mass(i)));
    let mut names: Vec<Name> = masses.collect();
    names.push(("tone_pickup", Place::Channel(0)));
    names
}

/// Rest of a signature that counts as none: what the march leaves of an exact identity.
const NOTHING: f64 = 1e-5;

/// Constant forces, biases and drifts whose signatures are in proportion, first states aside.
fn constant_twins(bench: &Bench, e: &Effect) -> Vec<Name> {
    if !matches!(e.kind, "constant_force" | "sensor_bias" | "sensor_drift") {
        return vec![];
    }
    let plant = &bench.plant;
    let mut names: Vec<Name> = (0..plant.masses.len())
        .map(|i| ("constant_force", Place::Mass(i)))
        .collect();
    for c in 0..plant.outputs.len() {
        names.push(("sensor_bias", Place::Channel(c)));
        names.push(("sensor_drift", Place::Channel(c)));
    }
    let own = signature(bench, (e.kind, e.at));
    let size = dot(&own, &own).sqrt();
    names.retain(|name| {
        let other = signature(bench, *name);
        let left = remainder(&[other], own.clone());
        dot(&left, &left).sqrt() < NOTHING * size
    });
    names
}

/// What a constant fault of size 1 leaves of the first record, first states taken off.
fn signature(bench: &Bench, (kind, at): Name) -> Vec<f64> {
    let setup = &bench.setups[0];
    let plant = &bench.without;
    let n = setup.samples;
    let mut list = vec![0.0; n * plant.outputs.len()];
    match at {
        Place::Channel(c) => {
            for k in 0..n {
                let drift = kind == "sensor_drift";
                list[c * n + k] = if drift { k as f64 / n as f64 } else { 1.0 };
            }
        }
        Place::Mass(mass) => {
            list = bench.quiet_response(0, &[], &[(mass, plant.masses[mass])]);
        }
        _ => {}
    }
    let free = bench.free_responses(0);
    let scale: Vec<f64> = (0..plant.outputs.len())
        .map(|c| {
            let size =
                |list: &[f64]| dot(&list[c * n..(c + 1) * n], &list[c * n..(c + 1) * n]).sqrt();
            free.iter().map(|f| size(f)).fold(1e-30, f64::max)
        })
        .collect();
    let scaled = |list: &[f64]| -> Vec<f64> {
        list.iter()
            .enumerate()
            .map(|(i, v)| v / scale[i / n])
            .collect()
    };
    let basis: Vec<Vec<f64>> = free.iter().map(|f| scaled(f)).collect();
    remainder(&basis, scaled(&list))
}
