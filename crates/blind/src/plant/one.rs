//! Plants of one degree of freedom, and of none.

use simgap_model::{GROUND, InputKind, Load, Model, OutputKind, Pendulum};

use super::parts::{dashpot, input, load_cell, mass, output, output_kind, pair, spring};
use super::sizes::Sizes;
use crate::random::Random;

/// One mass on a ground spring and damper, driven by a force near its resonance.
pub(super) fn oscillator(
    random: &mut Random,
    node: &str,
    mass_kg: f64,
    freq_hz: f64,
    ratio: f64,
) -> (Model, Sizes) {
    let omega = std::f64::consts::TAU * freq_hz;
    let displacement_m = random.log_uniform(1e-4, 5e-3) * (5.0 / freq_hz).min(1.0);
    let stiffness = mass_kg * omega * omega;
    let mut outputs = vec![output(1, output_kind(random), node)];
    if random.chance(0.3) {
        let kind = output_kind(random);
        if kind != outputs[0].kind {
            outputs.push(output(2, kind, node));
        }
    } else if random.chance(0.15) {
        outputs.push(load_cell(2, node, GROUND));
    }
    let model = Model {
        name: "one mass".to_string(),
        masses: vec![mass(node, mass_kg)],
        springs: vec![spring(node, GROUND, stiffness)],
        dampers: vec![dashpot(node, GROUND, 2.0 * ratio * mass_kg * omega)],
        inputs: vec![input(InputKind::Force, node)],
        outputs,
        ..Model::default()
    };
    let sizes = Sizes {
        freq_hz,
        displacement_m,
        amplitude: stiffness * displacement_m * random.uniform(0.3, 1.0),
    };
    (model, sizes)
}

/// m/s².
const GRAVITY: f64 = 9.806_65;

/// About the oscillator of the paper: 33 t at 2.5 Hz, sometimes with its weight.
pub(super) fn mold(random: &mut Random) -> (Model, Sizes) {
    let mass_kg = 33_000.0 * random.uniform(0.8, 1.2);
    let freq_hz = random.uniform(2.2, 2.9);
    let ratio = random.uniform(0.05, 0.3);
    let (mut model, sizes) = oscillator(random, "mold", mass_kg, freq_hz, ratio);
    if random.chance(0.3) {
        model.loads.push(Load {
            at: "mold".to_string(),
            value: -mass_kg * GRAVITY,
            uncertainty: None,
        });
    }
    (model, sizes)
}

/// A laboratory rig, 5 to 70 Hz.
pub(super) fn rig(random: &mut Random) -> (Model, Sizes) {
    let mass_kg = random.log_uniform(0.3, 200.0);
    let freq_hz = random.log_uniform(5.0, 70.0);
    let ratio = random.log_uniform(0.01, 0.1);
    oscillator(random, "table", mass_kg, freq_hz, ratio)
}

/// A positioning axis: a mass without a spring.
pub(super) fn axis(random: &mut Random) -> (Model, Sizes) {
    let mass_kg = random.log_uniform(5.0, 500.0);
    let freq_hz = random.log_uniform(0.3, 3.0);
    let omega = std::f64::consts::TAU * freq_hz;
    let displacement_m = random.log_uniform(5e-3, 0.2);
    let kind = match random.below(10) {
        0..=5 => OutputKind::Displacement,
        6..=8 => OutputKind::Velocity,
        _ => OutputKind::Acceleration,
    };
    let model = Model {
        name: "axis".to_string(),
        masses: vec![mass("carriage", mass_kg)],
        dampers: vec![dashpot(
            "carriage",
            GROUND,
            mass_kg * omega * random.log_uniform(0.1, 0.6),
        )],
        inputs: vec![input(InputKind::Force, "carriage")],
        outputs: vec![output(1, kind, "carriage")],
        ..Model::default()
    };
    let sizes = Sizes {
        freq_hz,
        displacement_m,
        amplitude: mass_kg * omega * omega * displacement_m,
    };
    (model, sizes)
}

/// A mass on a base whose displacement is prescribed.
pub(super) fn shaken(random: &mut Random) -> (Model, Sizes) {
    let (mut model, mut sizes) = rig(random);
    model.name = "shaken mass".to_string();
    for between in model
        .springs
        .iter_mut()
        .map(|s| &mut s.between)
        .chain(model.dampers.iter_mut().map(|d| &mut d.between))
    {
        *between = pair("table", "base");
    }
    for between in model.outputs.iter_mut().filter_map(|o| o.between.as_mut()) {
        *between = pair("table", "base");
    }
    model.inputs = vec![input(InputKind::Displacement, "base")];
    sizes.amplitude = sizes.displacement_m;
    (model, sizes)
}

/// An arm under gravity, driven by a torque.
pub(super) fn pendulum(random: &mut Random) -> (Model, Sizes) {
    let inertia = random.log_uniform(0.005, 2.0);
    let freq_hz = random.log_uniform(0.6, 2.0);
    let omega = std::f64::consts::TAU * freq_hz;
    let torque = inertia * omega * omega;
    let swing = random.uniform(0.2, 0.7);
    let kind = if random.chance(0.7) {
        OutputKind::Displacement
    } else {
        OutputKind::Velocity
    };
    let model = Model {
        name: "arm".to_string(),
        masses: vec![mass("arm", inertia)],
        dampers: vec![dashpot(
            "arm",
            GROUND,
            2.0 * random.log_uniform(0.02, 0.1) * inertia * omega,
        )],
        inputs: vec![input(InputKind::Force, "arm")],
        outputs: vec![output(1, kind, "arm")],
        pendulums: vec![Pendulum {
            at: "arm".to_string(),
            value: torque,
            uncertainty: None,
        }],
        ..Model::default()
    };
    let sizes = Sizes {
        freq_hz,
        displacement_m: swing,
        amplitude: torque * swing * 0.3,
    };
    (model, sizes)
}

/// A damper on a test stand: displacement prescribed, force measured.
pub(super) fn damper(random: &mut Random) -> (Model, Sizes) {
    let freq_hz = random.log_uniform(0.5, 10.0);
    let damping = random.log_uniform(50.0, 2e4);
    let displacement_m = random.log_uniform(2e-3, 0.05);
    let mut springs = vec![];
    if random.chance(0.4) {
        let stiffness = damping * std::f64::consts::TAU * freq_hz * random.uniform(0.2, 1.0);
        springs.push(spring("rod", GROUND, stiffness));
    }
    let model = Model {
        name: "test stand".to_string(),
        springs,
        dampers: vec![dashpot("rod", GROUND, damping)],
        inputs: vec![input(InputKind::Displacement, "rod")],
        outputs: vec![load_cell(1, "rod", GROUND)],
        ..Model::default()
    };
    let sizes = Sizes {
        freq_hz,
        displacement_m,
        amplitude: displacement_m,
    };
    (model, sizes)
}
