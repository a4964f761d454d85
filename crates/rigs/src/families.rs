//! The machines that are drawn.

use std::f64::consts::PI;

use crate::plant::{Control, Input, Member, Node, Output, Plant, Quantity, Unit};
use crate::rng::Rng;

use Node::{Base, Ground, Mass};
use Quantity::{Acceleration, Displacement, Force, Velocity};

/// Names of the families.
pub const FAMILIES: [&str; 11] = [
    "shear_frame",
    "quarter_car",
    "isolator",
    "drive_train",
    "test_stand",
    "massless_stand",
    "arm",
    "axis",
    "closed_axis",
    "free_decay",
    "servo_table",
];

const RATES_HZ: [f64; 14] = [
    20.0, 50.0, 100.0, 125.0, 200.0, 250.0, 400.0, 500.0, 800.0, 1000.0, 1250.0, 2000.0, 4000.0,
    10_000.0,
];

/// Four digits, as a data sheet has them.
fn sheet(value: f64) -> f64 {
    let digits = 10_f64.powi(3 - value.abs().log10().floor() as i32);
    (value * digits).round() / digits
}

fn member(name: &str, a: Node, b: Node, value: f64) -> Member {
    Member {
        name: name.into(),
        a,
        b,
        value: sheet(value),
    }
}

fn output(channel: &str, quantity: Quantity, a: Node, unit: Unit) -> Output {
    Output {
        channel: channel.into(),
        unit,
        quantity,
        a,
        b: Ground,
    }
}

fn input(channel: &str, at: Node, unit: Unit) -> Input {
    Input {
        channel: channel.into(),
        unit,
        at,
    }
}

const METRE: Unit = Unit("m", 1.0);
const MILLIMETRE: Unit = Unit("mm", 1e-3);
const NEWTON: Unit = Unit("N", 1.0);

fn length(rng: &mut Rng) -> Unit {
    *rng.pick(&[METRE, MILLIMETRE])
}

fn acceleration(rng: &mut Rng) -> Unit {
    *rng.pick(&[Unit("m/s^2", 1.0), Unit("m/s^2", 1.0), Unit("g", 9.806_65)])
}

fn speed(rng: &mut Rng) -> Unit {
    *rng.pick(&[Unit("m/s", 1.0), Unit("mm/s", 1e-3)])
}

fn force(rng: &mut Rng) -> Unit {
    *rng.pick(&[NEWTON, NEWTON, Unit("kN", 1e3)])
}

fn rate_for(samples_per_second: f64) -> f64 {
    let fits = RATES_HZ.iter().copied().find(|r| *r >= samples_per_second);
    fits.unwrap_or(10_000.0)
}

fn plant(family: &'static str, masses: &[(&str, f64)]) -> Plant {
    Plant {
        family,
        mass_names: masses.iter().map(|m| m.0.to_owned()).collect(),
        masses: masses.iter().map(|m| sheet(m.1)).collect(),
        springs: vec![],
        dampers: vec![],
        inputs: vec![],
        outputs: vec![],
        pendulum: vec![],
        control: None,
        rate_hz: 1000.0,
        band_hz: (1.0, 10.0),
        drive: 1.0,
    }
}

/// A machine of a family.
#[must_use]
pub fn draw_plant(family: &str, rng: &mut Rng) -> Plant {
    match family {
        "shear_frame" => shear_frame(rng),
        "quarter_car" => quarter_car(rng),
        "isolator" => isolator(rng),
        "drive_train" => drive_train(rng),
        "test_stand" => test_stand(rng),
        "massless_stand" => massless_stand(rng),
        "arm" => arm(rng),
        "axis" => axis(rng, false),
        "closed_axis" => axis(rng, true),
        "free_decay" => free_decay(rng),
        _ => servo_table(rng),
    }
}

fn shear_frame(rng: &mut Rng) -> Plant {
    let n = rng.whole(3, 5);
    let (m, f) = (rng.log_uniform(5.0, 5e4), rng.log_uniform(1.0, 12.0));
    let names: Vec<String> = (1..=n).map(|i| format!("floor{i}")).collect();
    let masses: Vec<(&str, f64)> = names
        .iter()
        .map(|name| (name.as_str(), m * rng.uniform(0.7, 1.3)))
        .collect();
    let mut p = plant("shear_frame", &masses);
    // First and last natural frequency of a uniform frame: (1/π) √(k/m) sin((2j − 1) π / (4n + 2)).
    let sine = |j: usize| ((2 * j - 1) as f64 * PI / (4 * n + 2) as f64).sin();
    let k = m * (PI * f / sine(1)).powi(2);
    let damping = 2.0 * rng.log_uniform(0.008, 0.04) / (2.0 * PI * f);
    let shaken = rng.chance(0.5);
    let foot = if shaken { Base(0) } else { Ground };
    for i in 0..n {
        let below = if i == 0 { foot } else { Mass(i - 1) };
        let k = k * rng.uniform(0.75, 1.25);
        let name = format!("storey{}", i + 1);
        p.springs.push(member(&name, Mass(i), below, k));
        p.dampers.push(member(&name, Mass(i), below, damping * k));
    }
    if shaken {
        p.inputs.push(input("x_table", Base(0), length(rng)));
        p.drive = rng.log_uniform(0.5e-3, 10e-3);
    } else {
        let at = rng.below(n);
        p.inputs.push(input("F_shaker", Mass(at), force(rng)));
        p.drive = m * rng.log_uniform(0.2, 2.0);
    }
    let unit = acceleration(rng);
    let skip = rng.below(n + 2);
    for i in (0..n).filter(|i| *i != skip) {
        let name = format!("a{}", i + 1);
        p.outputs.push(output(&name, Acceleration, Mass(i), unit));
    }
    if rng.chance(0.2) {
        p.outputs
            .push(output("x_top", Displacement, Mass(n - 1), length(rng)));
    }
    p.band_hz = (0.7 * f, 1.15 * f * sine(n) / sine(1));
    p.rate_hz = rate_for(p.band_hz.1 * rng.uniform(9.0, 16.0));
    p
}

fn quarter_car(rng: &mut Rng) -> Plant {
    let body = rng.uniform(200.0, 500.0);
    let wheel = body * rng.uniform(0.08, 0.18);
    let f = rng.uniform(1.0, 1.8);
    let k = body * (2.0 * PI * f).powi(2);
    let mut p = plant("quarter_car", &[("body", body), ("wheel", wheel)]);
    let c = 2.0 * rng.uniform(0.15, 0.4) * (k * body).sqrt();
    p.springs = vec![
        member("suspension", Mass(0), Mass(1), k),
        member("tyre", Mass(1), Base(0), k * rng.uniform(7.0, 11.0)),
    ];
    p.dampers = vec![member("shock", Mass(0), Mass(1), c)];
    if rng.chance(0.5) {
        p.dampers
            .push(member("tyre", Mass(1), Base(0), c * rng.uniform(0.02, 0.1)));
    }
    p.inputs.push(input("z_road", Base(0), length(rng)));
    p.drive = rng.log_uniform(2e-3, 20e-3);
    let unit = acceleration(rng);
    p.outputs
        .push(output("a_body", Acceleration, Mass(0), unit));
    if rng.chance(0.7) {
        p.outputs
            .push(output("a_wheel", Acceleration, Mass(1), unit));
    }
    if rng.chance(0.3) {
        p.outputs.push(Output {
            b: Mass(1),
            ..output("F_strut", Force, Mass(0), NEWTON)
        });
    }
    p.band_hz = (0.5 * f, 11.0 * f);
    p.rate_hz = rate_for(p.band_hz.1 * rng.uniform(10.0, 16.0));
    p
}

fn isolator(rng: &mut Rng) -> Plant {
    let (m, f) = (rng.log_uniform(1.0, 2e3), rng.log_uniform(1.5, 25.0));
    let k = m * (2.0 * PI * f).powi(2);
    let c = 2.0 * rng.log_uniform(0.02, 0.2) * (k * m).sqrt();
    let mut p = plant("isolator", &[("payload", m)]);
    p.springs = vec![member("mount", Mass(0), Base(0), k)];
    p.dampers = vec![member("mount", Mass(0), Base(0), c)];
    p.inputs.push(input("x_base", Base(0), length(rng)));
    p.drive = rng.log_uniform(0.1e-3, 5e-3);
    match rng.below(3) {
        0 => p
            .outputs
            .push(output("a", Acceleration, Mass(0), acceleration(rng))),
        1 => p
            .outputs
            .push(output("x", Displacement, Mass(0), length(rng))),
        _ => {
            p.outputs
                .push(output("a", Acceleration, Mass(0), acceleration(rng)));
            p.outputs.push(Output {
                b: Base(0),
                ..output("F_mount", Force, Mass(0), force(rng))
            });
        }
    }
    p.band_hz = (0.4 * f, 3.0 * f);
    p.rate_hz = rate_for(f * rng.uniform(35.0, 70.0));
    p
}

fn drive_train(rng: &mut Rng) -> Plant {
    let three = rng.chance(0.5);
    let (j, f) = (rng.log_uniform(1e-3, 5.0), rng.log_uniform(3.0, 40.0));
    let ratio = rng.uniform(0.5, 3.0);
    let k = (2.0 * PI * f).powi(2) * j * ratio / (1.0 + ratio);
    let mut masses = vec![("motor", j)];
    if three {
        masses.push(("gear", j * rng.uniform(0.2, 0.8)));
    }
    masses.push(("load", j * ratio));
    let mut p = plant("drive_train", &masses);
    let last = masses.len() - 1;
    let shaft = 2.0 * rng.log_uniform(0.01, 0.06) / (2.0 * PI * f);
    for i in 0..last {
        let name = if i == 0 { "shaft" } else { "coupling" };
        let k = k * if three { rng.uniform(1.5, 4.0) } else { 1.0 };
        p.springs.push(member(name, Mass(i), Mass(i + 1), k));
        p.dampers
            .push(member(name, Mass(i), Mass(i + 1), shaft * k));
    }
    let bearing = j * 2.0 * PI * f * rng.log_uniform(0.01, 0.1);
    p.dampers
        .push(member("motor bearing", Mass(0), Ground, bearing));
    if rng.chance(0.6) {
        let c = bearing * rng.uniform(0.5, 2.0);
        p.dampers
            .push(member("load bearing", Mass(last), Ground, c));
    }
    p.inputs.push(input("M_motor", Mass(0), Unit("N m", 1.0)));
    p.drive = j * (2.0 * PI * f) * rng.log_uniform(1.0, 10.0);
    let rate = *rng.pick(&[Unit("rad/s", 1.0), Unit("rpm", 2.0 * PI / 60.0)]);
    p.outputs.push(output("w_motor", Velocity, Mass(0), rate));
    if rng.chance(0.7) {
        match rng.chance(0.6) {
            true => p.outputs.push(output("w_load", Velocity, Mass(last), rate)),
            false => p.outputs.push(output(
                "phi_load",
                Displacement,
                Mass(last),
                Unit("rad", 1.0),
            )),
        }
    }
    p.band_hz = (0.2 * f, if three { 4.0 } else { 2.0 } * f);
    p.rate_hz = rate_for(p.band_hz.1 * rng.uniform(14.0, 25.0));
    p
}

fn test_stand(rng: &mut Rng) -> Plant {
    let two = rng.chance(0.6);
    let (m, f) = (rng.log_uniform(1.0, 500.0), rng.log_uniform(2.0, 30.0));
    let k = m * (2.0 * PI * f).powi(2);
    let c = 2.0 * rng.log_uniform(0.015, 0.1) * (k * m).sqrt();
    let masses: &[(&str, f64)] = match two {
        true => &[("table", m), ("fixture", m * rng.uniform(0.3, 0.9))],
        false => &[("table", m)],
    };
    let mut p = plant("test_stand", masses);
    p.springs = vec![member("bearing", Mass(0), Ground, k)];
    p.dampers = vec![member("bearing", Mass(0), Ground, c)];
    if two {
        p.springs
            .push(member("leaf", Mass(1), Mass(0), k * rng.uniform(0.8, 2.5)));
        p.dampers
            .push(member("leaf", Mass(1), Mass(0), c * rng.uniform(0.3, 1.0)));
    }
    p.inputs.push(input("F", Mass(0), force(rng)));
    p.drive = k * rng.log_uniform(0.2e-3, 5e-3);
    let cell = output("R", Force, Mass(0), force(rng));
    p.outputs.push(cell);
    let node = Mass(usize::from(two));
    if rng.chance(0.7) {
        match rng.chance(0.5) {
            true => p.outputs.push(output("x", Displacement, node, length(rng))),
            false => p
                .outputs
                .push(output("a", Acceleration, node, acceleration(rng))),
        }
    }
    p.band_hz = (0.3 * f, if two { 3.0 } else { 2.0 } * f);
    p.rate_hz = rate_for(p.band_hz.1 * rng.uniform(14.0, 25.0));
    p
}

fn massless_stand(rng: &mut Rng) -> Plant {
    let f = rng.log_uniform(0.3, 10.0);
    let mut p = plant("massless_stand", &[]);
    let c = rng.log_uniform(200.0, 2e4);
    p.dampers = vec![member("specimen", Base(0), Ground, c)];
    if rng.chance(0.7) {
        let k = c * 2.0 * PI * f * rng.uniform(0.5, 2.0);
        p.springs = vec![member("specimen", Base(0), Ground, k)];
    }
    p.inputs.push(input("x_piston", Base(0), length(rng)));
    p.drive = rng.log_uniform(2e-3, 30e-3);
    p.outputs.push(output("F_cell", Force, Base(0), force(rng)));
    p.band_hz = (0.4 * f, 3.0 * f);
    p.rate_hz = rate_for(f * rng.uniform(50.0, 90.0));
    p
}

fn arm(rng: &mut Rng) -> Plant {
    let (j, f) = (rng.log_uniform(0.01, 5.0), rng.uniform(0.5, 1.6));
    let mgl = j * (2.0 * PI * f).powi(2);
    let c = 2.0 * rng.log_uniform(0.02, 0.15) * (mgl * j).sqrt();
    let mut p = plant("arm", &[("arm", j)]);
    p.pendulum = vec![(0, sheet(mgl))];
    p.dampers = vec![member("bearing", Mass(0), Ground, c)];
    p.inputs.push(input("M_drive", Mass(0), Unit("N m", 1.0)));
    p.drive = mgl * rng.uniform(0.05, 0.25);
    let angle = *rng.pick(&[Unit("rad", 1.0), Unit("deg", PI / 180.0)]);
    match rng.below(3) {
        0 => p
            .outputs
            .push(output("w", Velocity, Mass(0), Unit("rad/s", 1.0))),
        1 => {
            p.outputs.push(output("phi", Displacement, Mass(0), angle));
            p.outputs
                .push(output("w", Velocity, Mass(0), Unit("rad/s", 1.0)));
        }
        _ => p.outputs.push(output("phi", Displacement, Mass(0), angle)),
    }
    p.band_hz = (0.3 * f, 2.5 * f);
    p.rate_hz = rate_for(f * rng.uniform(40.0, 80.0));
    p
}

fn axis(rng: &mut Rng, closed: bool) -> Plant {
    let (m, f) = (rng.log_uniform(2.0, 500.0), rng.log_uniform(0.5, 5.0));
    let family = if closed { "closed_axis" } else { "axis" };
    let mut p = plant(family, &[("carriage", m)]);
    let c = m * 2.0 * PI * f * rng.log_uniform(0.1, 1.0);
    p.dampers = vec![member("guide", Mass(0), Ground, c)];
    p.inputs.push(input("F_drive", Mass(0), NEWTON));
    p.drive = m * rng.log_uniform(0.5, 5.0);
    if closed {
        let w = 2.0 * PI * f * rng.uniform(1.5, 3.0);
        p.control = Some(Control {
            mass: 0,
            kp: m * w * w,
            kd: 1.6 * rng.uniform(0.6, 1.1) * m * w,
        });
        p.drive = rng.log_uniform(0.02, 0.3);
    }
    match rng.below(3) {
        0 if !closed => p.outputs.push(output("v", Velocity, Mass(0), speed(rng))),
        1 => {
            p.outputs
                .push(output("q", Displacement, Mass(0), length(rng)));
            p.outputs.push(output("v", Velocity, Mass(0), speed(rng)));
        }
        _ => p
            .outputs
            .push(output("q", Displacement, Mass(0), length(rng))),
    }
    p.band_hz = (0.3 * f, 2.5 * f);
    p.rate_hz = rate_for(f * rng.uniform(60.0, 120.0));
    p
}

fn free_decay(rng: &mut Rng) -> Plant {
    let two = rng.chance(0.5);
    let (m, f) = (rng.log_uniform(0.5, 1e3), rng.log_uniform(1.0, 20.0));
    let k = m * (2.0 * PI * f).powi(2);
    let c = 2.0 * rng.log_uniform(0.004, 0.02) * (k * m).sqrt();
    let masses: &[(&str, f64)] = match two {
        true => &[("beam", m), ("tip", m * rng.uniform(0.4, 1.0))],
        false => &[("beam", m)],
    };
    let mut p = plant("free_decay", masses);
    p.springs = vec![member("root", Mass(0), Ground, k)];
    p.dampers = vec![member("root", Mass(0), Ground, c)];
    if two {
        p.springs
            .push(member("tip", Mass(1), Mass(0), k * rng.uniform(0.7, 1.5)));
        p.dampers.push(member("tip", Mass(1), Mass(0), c));
        p.outputs
            .push(output("a_tip", Acceleration, Mass(1), acceleration(rng)));
    }
    p.outputs
        .push(output("x", Displacement, Mass(0), length(rng)));
    p.drive = rng.log_uniform(1e-3, 20e-3);
    p.band_hz = (0.5 * f, if two { 3.0 } else { 1.5 } * f);
    p.rate_hz = rate_for(p.band_hz.1 * rng.uniform(16.0, 30.0));
    p
}

fn servo_table(rng: &mut Rng) -> Plant {
    let (m, f) = (rng.log_uniform(2.0, 200.0), rng.log_uniform(0.8, 8.0));
    let mut p = plant("servo_table", &[("table", m)]);
    let c = m * 2.0 * PI * f * rng.uniform(0.3, 1.0);
    p.dampers = vec![member("guide", Mass(0), Ground, c)];
    if rng.chance(0.5) {
        let k = m * (2.0 * PI * f).powi(2);
        p.springs = vec![member("bellows", Mass(0), Ground, k)];
    }
    p.inputs.push(input("F_motor", Mass(0), NEWTON));
    p.drive = m * rng.log_uniform(0.5, 5.0);
    p.outputs.push(output("v", Velocity, Mass(0), speed(rng)));
    if rng.chance(0.3) {
        p.outputs
            .push(output("x", Displacement, Mass(0), length(rng)));
    }
    p.band_hz = (0.3 * f, 2.5 * f);
    p.rate_hz = rate_for(f * rng.uniform(50.0, 100.0));
    p
}
