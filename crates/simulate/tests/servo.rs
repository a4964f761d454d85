//! A servo axis: cylinder, valve and controller against SciPy, closed forms and balances.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use std::f64::consts::TAU;

use crate::support::{self, between, largest_difference, placed, predict, run, sampled};
use simgap_model::{Model, Parameter, damped_modes_of};
use simgap_simulate::{Job, Run, Simulator, predict_all};

const AXIS: &str = include_str!("fixtures/servo_axis.toml");

fn axis() -> Model {
    Model::from_toml(AXIS).unwrap()
}

/// The set point of `fixtures/servo_axis.py`.
fn set_point(step: f64, len: usize) -> Run {
    let wave =
        |t: f64| 0.004 * (1.0 - (TAU * 3.0 * t).cos()) + 0.001 * (1.0 - (TAU * 11.0 * t).cos());
    run(step, len, vec![sampled(step, len, wave)])
}

/// Columns of `fixtures/servo_axis.csv` after the time, every 10 ms: y, p1, p2, spool, flow into chamber 1.
/// Made by `python servo_axis.py > servo_axis.csv` (SciPy 1.17.1, BDF at a relative tolerance of 1e-10, steps of 0.1 ms
/// at most); Radau at 1e-11 agrees to 5e-10 of the span of each.
fn reference() -> Vec<Vec<f64>> {
    let text = include_str!("fixtures/servo_axis.csv");
    let rows = text.lines().filter(|line| !line.starts_with(['#', 't']));
    let rows: Vec<Vec<f64>> = rows
        .map(|row| row.split(',').map(|v| v.parse().unwrap()).collect())
        .collect();
    (1..6)
        .map(|k| rows.iter().map(|row| row[k]).collect())
        .collect()
}

fn span(values: &[f64]) -> f64 {
    let low = values.iter().copied().fold(f64::INFINITY, f64::min);
    let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    high - low
}

/// Largest difference from the reference over its span for each output, in so many samples each 10 ms and steps a sample.
fn off(samples: usize, substeps: usize) -> Vec<f64> {
    let run = set_point(0.01 / samples as f64, 40 * samples + 1);
    let found = predict(&axis(), &[], substeps, &run, &[]);
    let each = found.iter().zip(reference());
    each.map(|(found, theirs)| {
        let ours: Vec<f64> = found.iter().copied().step_by(samples).collect();
        largest_difference(&ours, &theirs) / span(&theirs)
    })
    .collect()
}

/// Ours minus theirs, largest over the span of each output:
///
/// | samples each 10 ms, steps a sample | y | p1 | p2 | spool | flow |
/// |---|---|---|---|---|---|
/// | 10, 32 | 2e-8 | 3e-7 | 3e-7 | 3e-6 (1) | 4e-6 (1) |
/// | 40, 32 | 1e-9 | 3e-8 | 2e-8 | 2e-8 | 3e-8 |
///
/// (1) The set point is joined by straight lines between samples, whose harmonics about the sample rate the spool follows
/// a little: 3e-6 at 1 kHz whatever the steps. Steps are of second order; the kinks of the overlap cost nothing of it.
#[test]
fn val_scipy_servo_axis() {
    let coarse = off(10, 32);
    let fine = off(40, 32);
    println!("off {coarse:?}\n    {fine:?}");
    assert!(coarse.iter().all(|off| *off < 1e-5), "{coarse:?}");
    assert!(fine.iter().all(|off| *off < 1e-7), "{fine:?}");
}

#[test]
fn order_of_the_orifice_is_two() {
    let errors: Vec<f64> = [4, 8, 16].map(|substeps| off(40, substeps)[1]).to_vec();
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!((order - 2.0).abs() < 0.2, "{order} of {errors:?}");
    }
}

/// `python servo_poles.py`: central differences of the equations, relative steps that leave about 1e-8.
const POLES: [[f64; 2]; 5] = [
    [-4.817_036_675e-1, 0.0],
    [-1.868_770_845e1, 0.0],
    [-2.052_092_861e1, 1.731_686_793e2],
    [-4.979_028_171e2, 0.0],
    [-3.502_821_032e2, 3.589_206_553e2],
];

/// What finite differences leave of poles.
const DIFFERENCES: f64 = 1e-6;

#[test]
fn val_scipy_linearised_poles() {
    let mut model = axis();
    let valve = &mut model.elements.valves[0];
    (valve.overlap, valve.asymmetry, valve.supply_droop) = (0.0, 0.0, 0.0);
    let modes = damped_modes_of(&model.matrices().unwrap(), &model.first_order()).unwrap();
    println!(
        "{:?}",
        modes.iter().map(|m| m.eigenvalue).collect::<Vec<_>>()
    );
    assert_eq!(modes.len(), POLES.len());
    for (mode, [re, im]) in modes.iter().zip(POLES) {
        let (found, size) = (mode.eigenvalue, re.hypot(im));
        let off = (found.re - re).hypot(found.im - im) / size;
        assert!(off < DIFFERENCES, "{found} instead of {re} + {im}i");
    }
}

/// Simpson's rule over an even number of intervals.
fn integral(values: &[f64], step: f64) -> f64 {
    let last = values.len() - 1;
    let weight = |i: usize| match i {
        i if i == 0 || i == last => 1.0,
        i if i % 2 == 1 => 4.0,
        _ => 2.0,
    };
    let sum: f64 = values.iter().enumerate().map(|(i, v)| weight(i) * v).sum();
    sum * step / 3.0
}

/// Steps of 1/80 ms leave this of the balances: orifices of second order, kinks under Simpson's rule.
const BALANCED: f64 = 1e-5;

#[test]
fn prop_volume_and_energy_are_balanced() {
    let mut model = axis();
    for (channel, kind, at) in [("v", "velocity", "table"), ("q2", "flow", "drive.p2")] {
        let mut output = model.outputs[0].clone();
        output.channel = channel.into();
        output.kind = match kind {
            "velocity" => simgap_model::OutputKind::Velocity,
            _ => simgap_model::OutputKind::Flow,
        };
        output.at = Some(at.into());
        model.outputs.push(output);
    }
    let step = 2e-4;
    let found = predict(&model, &[], 16, &set_point(step, 2001), &[]);
    let [y, p1, p2, _, q1, v, q2] = &found[..] else {
        panic!("seven outputs");
    };
    let cylinder = &model.elements.cylinders[0];
    let (areas, volumes, beta) = (cylinder.areas, cylinder.volumes_m3(), cylinder.bulk_modulus);
    let of = |f: &dyn Fn(usize) -> f64| integral(&(0..y.len()).map(f).collect::<Vec<_>>(), step);
    // Oil that came in is compressed, has moved the rod or has leaked.
    let last = y.len() - 1;
    let came = of(&|i| q1[i]);
    let pressed = volumes[0] / beta * (p1[last] - p1[0]);
    let leaked = of(&|i| cylinder.leakage * (p1[i] - p2[i]) + cylinder.external_leakage * p1[i]);
    let moved = areas[0] * (y[last] - y[0]);
    let size = areas[0] * span(y);
    assert!((came - pressed - moved - leaked).abs() < BALANCED * size);
    // Work of the oil that comes in: stored in mass, spring and oil, lost in damper and leaks.
    let stored = |i: usize| {
        0.5 * 1000.0 * v[i] * v[i]
            + 0.5 * 1e5 * y[i] * y[i]
            + 0.5 * (volumes[0] * p1[i] * p1[i] + volumes[1] * p2[i] * p2[i]) / beta
    };
    let lost = of(&|i| {
        let out = cylinder.external_leakage * (p1[i] * p1[i] + p2[i] * p2[i]);
        2000.0 * v[i] * v[i] + cylinder.leakage * (p1[i] - p2[i]).powi(2) + out
    });
    let work = of(&|i| p1[i] * q1[i] + p2[i] * q2[i]);
    let gross = of(&|i| (p1[i] * q1[i]).abs());
    let off = work - lost - (stored(last) - stored(0));
    assert!(off.abs() < BALANCED * gross, "{off} of {gross}");
}

/// A block on shut-in oil: f = √(k_oil/m)/2π; the stiffer the oil, the nearer its speed is that of the flow over the area.
#[test]
fn verify_stiff_oil_makes_a_rigid_actuator() {
    let shut = "[[mass]]\nname = \"block\"\nvalue = 33000.0\n\
        [[cylinder]]\nname = \"c\"\nbetween = [\"block\", \"ground\"]\nareas = [0.02, 0.02]\n\
        dead_volumes = [0.0, 0.0]\nstroke = 0.08\nbulk_modulus = 1.4e9\n\
        [[output]]\nchannel = \"y\"\nkind = \"velocity\"\nat = \"block\"\n\
        [[output]]\nchannel = \"q\"\nkind = \"flow\"\nat = \"c.p1\"\n";
    let mut model = support::model(shut);
    let modes = damped_modes_of(&model.matrices().unwrap(), &model.first_order()).unwrap();
    let needed = (model.elements.cylinders[0].oil_stiffness() / 33000.0).sqrt() / TAU;
    let found = modes
        .iter()
        .map(|mode| mode.natural_freq_hz)
        .fold(0.0, f64::max);
    assert!((found / needed - 1.0).abs() < 1e-9, "{found} {needed}");
    // One cylinder of 0.02 m² on 40 mm columns: 1.4 GN/m.
    assert!((model.elements.cylinders[0].oil_stiffness() - 1.4e9).abs() < 1.0);

    let valve = "schema = \"simgap-model/1\"\nname = \"v\"\n".to_string()
        + shut
        + "[[damper]]\nname = \"d\"\nbetween = [\"block\", \"ground\"]\ndamping = 1e5\n\
        [[valve]]\nname = \"s\"\ncylinder = \"c\"\nrated_flow = 1e-3\nrated_drop = 3.5e6\n\
        natural_freq = 50.0\ndamping_ratio = 0.7\nsupply = 2e7\n\
        [[input]]\nchannel = \"u\"\nkind = \"command\"\nat = \"s\"\n";
    model = Model::from_toml(&valve).unwrap();
    model.elements.cylinders[0].pressures = [1e7, 1e7];
    let command = sampled(1e-3, 2000, |t| 0.1 * (1.0 - (TAU * t).cos()));
    let off = |beta: f64| {
        let mut stiff = model.clone();
        stiff.elements.cylinders[0].bulk_modulus = beta;
        let run = run(1e-3, 2000, vec![command.clone()]);
        let found = predict(&stiff, &[], 16, &run, &[]);
        let speed: Vec<f64> = found[1].iter().map(|q| q / 0.02).collect();
        largest_difference(&found[0][1000..], &speed[1000..]) / span(&speed)
    };
    let (soft, stiff) = (off(1e9), off(1e11));
    assert!(stiff < 1e-3 && stiff < 0.03 * soft, "{soft} {stiff}");
}

#[test]
fn verify_oil_is_least_stiff_at_the_middle_of_the_stroke() {
    let mut cylinder = axis().elements.cylinders.swap_remove(0);
    cylinder.areas = [2e-3; 2];
    let mut at = |position: f64| {
        cylinder.position = Some(position);
        cylinder.oil_stiffness()
    };
    let middle = at(0.1);
    for off in [0.02, 0.05, 0.09] {
        assert!(at(0.1 - off) > middle);
        assert!((at(0.1 - off) / at(0.1 + off) - 1.0).abs() < 1e-12);
    }
}

#[test]
fn verify_lanes_are_the_march_of_one_set() {
    let run = set_point(1e-3, 301);
    let chambers = between("drive.p1", "drive.p2");
    let of = |factor: f64| {
        let air = placed("bulk_modulus", chambers.clone(), &[factor]);
        let friction = placed(
            "coulomb_friction",
            between("table", "ground"),
            &[200.0 * factor],
        );
        Simulator::new(&axis(), &[air, friction], 4).unwrap()
    };
    let simulators: Vec<Simulator> = (1..=8).map(|i| of(0.1 * f64::from(i) + 0.3)).collect();
    let jobs: Vec<Job<'_>> = simulators
        .iter()
        .map(|simulator| Job {
            simulator,
            run: &run,
            initial: &[],
            smooth: false,
        })
        .collect();
    for (simulator, lanes) in simulators.iter().zip(predict_all(&jobs)) {
        assert_eq!(lanes.unwrap(), simulator.predict(&run, &[]).unwrap());
    }
}

#[test]
fn verify_the_file_is_written_as_it_is_read() {
    let model = axis();
    let again = Model::from_toml(&model.to_toml().unwrap()).unwrap();
    assert_eq!(again, model);
}

/// Central differences leave about this of a pole; and poles are good to 1e-13 of the largest, 500 rad/s, which a
/// difference over 2e-5 enlarges.
const SLOPES: f64 = 1e-6;
const ROUNDING_OF_POLES: f64 = 1e-13 * 500.0 / 2e-5;

#[test]
fn verify_sensitivities_of_a_drive_against_finite_differences() {
    let model = axis();
    let at = vec![0.0; model.dof_count()];
    let parameters = model.parameters();
    let found = model.pole_sensitivities(&at).unwrap();
    let first_order = model.first_order();
    let poles = |model: &Model| damped_modes_of(&model.matrices().unwrap(), &first_order).unwrap();
    assert_eq!(found.len(), poles(&model).len());
    let step = 1e-5;
    let mut seen = 0;
    for (k, parameter) in parameters.iter().enumerate() {
        let Parameter::Element(place) = *parameter else {
            continue;
        };
        seen += 1;
        let at = model.parameter_value(*parameter).unwrap();
        let moved = |factor: f64| poles(&model.with_element_value(place, factor));
        let (high, low) = (moved(1.0 + step), moved(1.0 - step));
        for (r, pole) in found.iter().enumerate() {
            let slope = (high[r].eigenvalue - low[r].eigenvalue) / (2.0 * step);
            let own = pole.derivative.as_ref().unwrap()[k] * at;
            let off = (own - slope).norm();
            assert!(
                off < SLOPES * pole.pole.norm() + ROUNDING_OF_POLES,
                "{}: {own} {slope}",
                model.parameter_name(*parameter)
            );
        }
    }
    assert_eq!(seen, 9);
}
