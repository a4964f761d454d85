//! Plants of several degrees of freedom, and what is let go.

use simgap_model::{GROUND, Input, InputKind, Model, OutputKind};
use simgap_mold::TwoDof;

use super::one::rig;
use super::parts::{dashpot, input, load_cell, mass, output, output_kind, spring};
use super::sizes::Sizes;
use crate::BlindError;
use crate::random::Random;

/// Masses in a row, the first tied to the ground, sometimes the last too; not all measured.
pub(super) fn chain(random: &mut Random, count: usize) -> (Model, Sizes) {
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
    let driven = random.below(count);
    model.inputs.push(input(InputKind::Force, &names[driven]));
    if random.chance(0.15) {
        let also = (driven + 1 + random.below(count - 1)) % count;
        model.inputs.push(Input {
            channel: "u2".to_string(),
            ..input(InputKind::Force, &names[also])
        });
    }
    measure_some(random, &mut model, &names);
    let sizes = Sizes {
        freq_hz,
        displacement_m,
        amplitude: stiffness * displacement_m * random.uniform(0.3, 1.0),
    };
    (model, sizes)
}

pub(super) fn measure_some(random: &mut Random, model: &mut Model, names: &[String]) {
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
    if random.chance(0.1) {
        let number = model.outputs.len() + 1;
        model.outputs.push(load_cell(number, &names[0], GROUND));
    }
}

/// About the mold of the paper on its support, Eq. (4) and Table 5; with some damping, of which the
/// paper prints none.
///
/// Reference: `park-mold`.
pub(super) fn mold_on_support(random: &mut Random) -> Result<(Model, Sizes), BlindError> {
    let rows = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0];
    let published = TwoDof::published(rows[random.below(rows.len())])?;
    let mut model = published.model()?;
    model.name = "mold on a support".to_string();
    for mass in &mut model.masses {
        mass.value *= random.uniform(0.8, 1.2);
    }
    let ratio = random.log_uniform(0.01, 0.06);
    for spring in &mut model.springs {
        spring.stiffness *= random.uniform(0.8, 1.2);
        let [a, b] = &spring.between;
        let moving = model.masses.iter().find(|mass| &mass.name == a);
        let mass_kg = moving.map_or(0.0, |mass| mass.value);
        let damping = 2.0 * ratio * (spring.stiffness * mass_kg).sqrt();
        model.dampers.push(dashpot(a, b, damping));
    }
    let displacement_m = random.log_uniform(1e-5, 3e-4);
    model.inputs = vec![input(InputKind::Force, "mold")];
    model.outputs = vec![output(1, OutputKind::Displacement, "mold")];
    if random.chance(0.6) {
        let kind = output_kind(random);
        model.outputs.push(output(2, kind, "support"));
    }
    let stiffness = published.mold_stiffness() + published.leaf_stiffness();
    let sizes = Sizes {
        freq_hz: published.modes_hz()?[0],
        displacement_m,
        amplitude: stiffness * displacement_m * random.uniform(0.05, 0.3),
    };
    Ok((model, sizes))
}

/// One or two masses let go, without any input.
pub(super) fn free(random: &mut Random) -> (Model, Sizes) {
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
