//! The plants of the generated cases.

use simgap_model::{
    Damper, GROUND, Input, InputKind, Mass, Model, Output, OutputKind, Pendulum, Spring,
    damped_modes,
};

use crate::BlindError;
use crate::random::Random;

/// A plant and the sizes it is driven at.
#[derive(Debug, Clone)]
pub(crate) struct Plant {
    pub(crate) model: Model,
    /// Excited band, Hz.
    pub(crate) band_hz: [f64; 2],
    /// Peak of the excitation, unit of the input.
    pub(crate) amplitude: f64,
    /// Typical displacement, m or rad.
    pub(crate) displacement_m: f64,
    pub(crate) sample_rate_hz: f64,
}

/// Sizes from which a plant is finished.
struct Sizes {
    /// Frequency the plant is about, Hz.
    freq_hz: f64,
    displacement_m: f64,
    amplitude: f64,
}

/// Samples per period of the highest frequency, lowest and highest draw. At 40 the first-order hold
/// of the inputs errs by (2π/40)²/12 = 0.2 %, as on a decently sampled machine.
const OVERSAMPLED: [f64; 2] = [40.0, 110.0];

/// Draws a plant.
pub(crate) fn draw(random: &mut Random) -> Result<Plant, BlindError> {
    let (model, sizes) = match random.below(14) {
        0 => mold(random),
        1..=3 => rig(random),
        4 | 5 => axis(random),
        6..=8 => chain(random, 2),
        9 => chain(random, 3),
        10 => shaken(random),
        11 => free(random),
        12 => pendulum(random),
        _ => damper(random),
    };
    finish(random, model, &sizes)
}

fn finish(random: &mut Random, model: Model, sizes: &Sizes) -> Result<Plant, BlindError> {
    let f = sizes.freq_hz;
    let band_hz = [
        f * random.log_uniform(0.15, 0.4),
        f * random.log_uniform(1.3, 2.5),
    ];
    let modes = damped_modes(&model.matrices()?)?;
    let highest = modes
        .iter()
        .map(|mode| mode.damped_freq_hz)
        .fold(band_hz[1], f64::max);
    Ok(Plant {
        model,
        band_hz,
        amplitude: sizes.amplitude,
        displacement_m: sizes.displacement_m,
        sample_rate_hz: highest * random.log_uniform(OVERSAMPLED[0], OVERSAMPLED[1]),
    })
}

fn pair(a: &str, b: &str) -> [String; 2] {
    [a.to_string(), b.to_string()]
}

fn mass(name: &str, value: f64) -> Mass {
    Mass {
        name: name.to_string(),
        value,
    }
}

fn spring(a: &str, b: &str, stiffness: f64) -> Spring {
    Spring {
        name: format!("{a} {b}"),
        between: pair(a, b),
        stiffness,
    }
}

fn dashpot(a: &str, b: &str, damping: f64) -> Damper {
    Damper {
        name: format!("{a} {b}"),
        between: pair(a, b),
        damping,
    }
}

fn input(kind: InputKind, at: &str) -> Input {
    Input {
        channel: "u".to_string(),
        kind,
        at: at.to_string(),
        gain: None,
    }
}

fn output(number: usize, kind: OutputKind, at: &str) -> Output {
    Output {
        channel: format!("y{number}"),
        kind,
        at: Some(at.to_string()),
        between: None,
        gain: None,
    }
}

/// Displacement most often, acceleration, velocity.
fn output_kind(random: &mut Random) -> OutputKind {
    match random.below(20) {
        0..=10 => OutputKind::Displacement,
        11..=13 => OutputKind::Velocity,
        _ => OutputKind::Acceleration,
    }
}

/// One mass on a ground spring and damper, driven by a force near its resonance.
fn oscillator(
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

/// About the oscillator of the paper: 33 t at 2.5 Hz.
fn mold(random: &mut Random) -> (Model, Sizes) {
    let mass_kg = 33_000.0 * random.uniform(0.8, 1.2);
    let freq_hz = random.uniform(2.2, 2.9);
    let ratio = random.uniform(0.05, 0.3);
    oscillator(random, "mold", mass_kg, freq_hz, ratio)
}

/// A laboratory rig, 5 to 70 Hz.
fn rig(random: &mut Random) -> (Model, Sizes) {
    let mass_kg = random.log_uniform(0.3, 200.0);
    let freq_hz = random.log_uniform(5.0, 70.0);
    let ratio = random.log_uniform(0.01, 0.1);
    oscillator(random, "table", mass_kg, freq_hz, ratio)
}

/// A positioning axis: a mass without a spring.
fn axis(random: &mut Random) -> (Model, Sizes) {
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

/// Masses in a row, the first tied to the ground, sometimes the last too; not all measured.
fn chain(random: &mut Random, count: usize) -> (Model, Sizes) {
    let names: Vec<String> = (1..=count).map(|i| format!("m{i}")).collect();
    let mass_kg = random.log_uniform(0.5, 300.0);
    let freq_hz = random.log_uniform(2.0, 40.0);
    let omega = std::f64::consts::TAU * freq_hz;
    let stiffness = mass_kg * omega * omega;
    let ratio = random.log_uniform(0.01, 0.06);
    let displacement_m = random.log_uniform(1e-4, 5e-3) * (5.0 / freq_hz).min(1.0);
    let mut model = Model {
        name: format!("{count} masses"),
        ..Model::default()
    };
    for (i, name) in names.iter().enumerate() {
        model
            .masses
            .push(mass(name, mass_kg * random.uniform(0.5, 1.5)));
        let before = if i == 0 { GROUND } else { &names[i - 1] };
        let k = stiffness * random.uniform(0.7, 2.0);
        let c = 2.0 * ratio * (k * mass_kg).sqrt() * random.uniform(0.5, 1.5);
        model.springs.push(spring(name, before, k));
        model.dampers.push(dashpot(name, before, c));
    }
    if random.chance(0.4) {
        let last = &names[count - 1];
        let k = stiffness * random.uniform(0.5, 1.5);
        model.springs.push(spring(last, GROUND, k));
        if random.chance(0.5) {
            let c = 2.0 * ratio * (k * mass_kg).sqrt();
            model.dampers.push(dashpot(last, GROUND, c));
        }
    }
    model
        .inputs
        .push(input(InputKind::Force, &names[random.below(count)]));
    measure_some(random, &mut model, &names);
    let sizes = Sizes {
        freq_hz,
        displacement_m,
        amplitude: stiffness * displacement_m * random.uniform(0.3, 1.0),
    };
    (model, sizes)
}

fn measure_some(random: &mut Random, model: &mut Model, names: &[String]) {
    let hidden = if random.chance(0.4) {
        Some(random.below(names.len()))
    } else {
        None
    };
    let same = output_kind(random);
    let mixed = random.chance(0.25);
    for (i, name) in names.iter().enumerate() {
        if hidden == Some(i) {
            continue;
        }
        let kind = if mixed { output_kind(random) } else { same };
        let number = model.outputs.len() + 1;
        model.outputs.push(output(number, kind, name));
    }
}

/// A mass on a base whose displacement is prescribed.
fn shaken(random: &mut Random) -> (Model, Sizes) {
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
    model.inputs = vec![input(InputKind::Displacement, "base")];
    sizes.amplitude = sizes.displacement_m;
    (model, sizes)
}

/// One or two masses let go, without any input.
fn free(random: &mut Random) -> (Model, Sizes) {
    let (mut model, mut sizes) = if random.chance(0.5) {
        rig(random)
    } else {
        chain(random, 2)
    };
    model.name = "free decay".to_string();
    model.inputs.clear();
    sizes.amplitude = 0.0;
    (model, sizes)
}

/// An arm under gravity, driven by a torque.
fn pendulum(random: &mut Random) -> (Model, Sizes) {
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
fn damper(random: &mut Random) -> (Model, Sizes) {
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
        outputs: vec![Output {
            channel: "y1".to_string(),
            kind: OutputKind::Force,
            at: None,
            between: Some(pair("rod", GROUND)),
            gain: None,
        }],
        ..Model::default()
    };
    let sizes = Sizes {
        freq_hz,
        displacement_m,
        amplitude: displacement_m,
    };
    (model, sizes)
}

/// Unit of a channel of the plant.
pub(crate) fn output_unit(model: &Model, kind: OutputKind) -> &'static str {
    let rotates = !model.pendulums.is_empty();
    match (kind, rotates) {
        (OutputKind::Displacement, false) => "m",
        (OutputKind::Velocity, false) => "m/s",
        (OutputKind::Acceleration, false) => "m/s^2",
        (OutputKind::Force, false) => "N",
        (OutputKind::Displacement, true) => "rad",
        (OutputKind::Velocity, true) => "rad/s",
        (OutputKind::Acceleration, true) => "rad/s^2",
        (OutputKind::Force, true) => "N m",
    }
}

/// Unit of an input of the plant.
pub(crate) fn input_unit(model: &Model, kind: InputKind) -> &'static str {
    match kind {
        InputKind::Force => output_unit(model, OutputKind::Force),
        InputKind::Displacement => output_unit(model, OutputKind::Displacement),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn prop_every_plant_is_a_model() -> Result<(), BlindError> {
        let mut names = std::collections::BTreeSet::new();
        for seed in 0..300 {
            let plant = draw(&mut Random::new(seed))?;
            plant.model.check()?;
            assert!(plant.sample_rate_hz >= OVERSAMPLED[0] * plant.band_hz[1]);
            names.insert(plant.model.name.clone());
        }
        // one mass, axis, 2 masses, 3 masses, shaken mass, free decay, arm, test stand
        assert_eq!(names.len(), 8, "{names:?}");
        Ok(())
    }
}
