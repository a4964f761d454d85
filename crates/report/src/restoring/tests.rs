use simgap_diagnose::{ChannelGap, ChannelSeries, Gap, Status, Verdict, Where};

use super::*;

/// m = 2 kg, k = 800 N/m, c = 4 N s/m, displacement measured.
const MODEL: &str = r#"schema = "simgap-model/1"
name = "block"
[[mass]]
name = "block"
value = 2.0
[[spring]]
name = "rod"
between = ["block", "ground"]
stiffness = 800.0
[[damper]]
name = "rod"
between = ["block", "ground"]
damping = 4.0
[[output]]
channel = "y"
kind = "displacement"
at = "block"
"#;

const STEP_S: f64 = 1e-3;

fn diagnosis() -> Diagnosis {
    let none = || Where {
        channels: vec![],
        locations: vec![],
        bands: vec![],
        times: vec![],
        states: vec![],
        records: vec![],
    };
    Diagnosis {
        schema: "simgap-diagnosis/1",
        model: "block".into(),
        gap: Gap {
            metric: "nrmse",
            nominal: 0.0,
            recalibrated: 0.0,
            corrected: 0.0,
            noise_floor: 0.0,
            input_noise: 0.0,
            closed: 0.0,
            channels: vec![ChannelGap {
                channel: "y".into(),
                nominal: 0.0,
                recalibrated: 0.0,
                corrected: 0.0,
                noise_floor: 1e-4,
                input_noise: 0.0,
            }],
        },
        r#where: none(),
        verdict: Verdict {
            status: Status::Effect,
            effects: vec![],
            description: vec![],
            ..Verdict::default()
        },
        stopped_early: false,
        turning: vec![],
        candidates: vec![],
        next_experiment: None,
        notes: vec![],
    }
}

/// The model at rest, the machine moved by a force −f that swings at 3 Hz, in its steady state:
/// e = Re(−F / (k − m ω² + i c ω) e^{iωt}).
fn swinging(amplitude: f64) -> (CheckSeries, PlaceMotion, Vec<f64>) {
    let omega = 2.0 * std::f64::consts::PI * 3.0;
    let (re, im) = (800.0 - 2.0 * omega * omega, 4.0 * omega);
    let size = re * re + im * im;
    let n = 3000;
    let time_s: Vec<f64> = (0..n).map(|i| f64::from(i) * STEP_S).collect();
    let off: Vec<f64> = time_s
        .iter()
        .map(|t| {
            let (sin, cos) = (omega * t).sin_cos();
            -amplitude * (re * cos + im * sin) / size
        })
        .collect();
    let force = time_s
        .iter()
        .map(|t| amplitude * (omega * t).cos())
        .collect();
    // Steps as fine as rounding would make them stand for noise.
    let measured: Vec<f64> = off.iter().map(|d| (d * 1e9).round() * 1e-9).collect();
    let zero = vec![0.0; measured.len()];
    let series = CheckSeries {
        record: "r".into(),
        time_s,
        channels: vec![ChannelSeries {
            channel: "y".into(),
            unit: "m",
            measured,
            nominal: zero.clone(),
            corrected: zero.clone(),
        }],
    };
    let motion = PlaceMotion {
        record: "r".into(),
        at: Location::Between(["block".into(), "ground".into()]),
        displacement: zero.clone(),
        velocity: zero,
    };
    (series, motion, force)
}

/// Largest relative error of the force allowed: the smoother knows neither its frequency nor that
/// it is smooth, and the noise it is told of is 1e-4 of the spread.
const FORCE_ERROR: f64 = 0.03;

#[test]
fn verify_a_swinging_force_is_found_from_displacement() {
    let model = Model::from_toml(MODEL).expect("a model");
    let (series, motion, force) = swinging(5.0);
    let found = missing_force(&model, &diagnosis(), &series, &motion).expect("a force");
    let skip = (series.time_s.len() - found.force.len()) / 2;
    let worst = found
        .force
        .iter()
        .zip(&force[skip..])
        .map(|(a, b)| (a - b).abs())
        .fold(0.0, f64::max);
    assert!(worst < FORCE_ERROR * 5.0, "{worst}");
    // The motion across the place is the machine's, not the model's.
    let measured = &series.channels[0].measured[skip..];
    let off = found
        .displacement
        .iter()
        .zip(measured)
        .map(|(a, b)| (a - b).abs());
    assert!(off.fold(0.0, f64::max) < 1e-4 * 0.1);
    let turned = found.velocity.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
    let expected =
        2.0 * std::f64::consts::PI * 3.0 * measured.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
    assert!(
        (turned / expected - 1.0).abs() < FORCE_ERROR,
        "{turned} {expected}"
    );
}

#[test]
fn verify_a_place_that_is_turned_round_has_the_opposite_force() {
    let model = Model::from_toml(MODEL).expect("a model");
    let (series, mut motion, _) = swinging(5.0);
    let found = missing_force(&model, &diagnosis(), &series, &motion).expect("a force");
    motion.at = Location::Between(["ground".into(), "block".into()]);
    let turned = missing_force(&model, &diagnosis(), &series, &motion).expect("a force");
    for (a, b) in found.force.iter().zip(&turned.force) {
        assert!((a + b).abs() < 1e-6, "{a} {b}");
    }
}

#[test]
fn verify_what_cannot_be_told_is_not() {
    let model = Model::from_toml(MODEL).expect("a model");
    let (mut series, motion, _) = swinging(5.0);
    let none = |series: &CheckSeries, motion: &PlaceMotion| {
        missing_force(&model, &diagnosis(), series, motion).is_none()
    };
    let elsewhere = PlaceMotion {
        at: Location::Channel("y".into()),
        ..motion.clone()
    };
    assert!(none(&series, &elsewhere));
    // Without discrepancy there is no force.
    let mut perfect = series.clone();
    perfect.channels[0].measured.fill(0.0);
    assert!(none(&perfect, &motion));
    series.time_s[1500] += 3.0 * 1500.0 * STEP_S;
    assert!(none(&series, &motion));
}

/// An output that is the force of the place itself, no mass at all: the force is the discrepancy.
#[test]
fn verify_the_force_of_a_damper_without_mass() {
    let text = r#"schema = "simgap-model/1"
name = "damper"
[[damper]]
name = "d"
between = ["rod", "ground"]
damping = 100.0
[[input]]
channel = "x"
kind = "displacement"
at = "rod"
[[output]]
channel = "y"
kind = "force"
between = ["rod", "ground"]
"#;
    let model = Model::from_toml(text).expect("a model");
    let (series, mut motion, _) = swinging(5.0);
    motion.at = Location::Between(["rod".into(), "ground".into()]);
    let found = missing_force(&model, &diagnosis(), &series, &motion).expect("a force");
    let skip = (series.time_s.len() - found.force.len()) / 2;
    let size = series.channels[0]
        .measured
        .iter()
        .fold(0.0, |m: f64, v| m.max(v.abs()));
    for (a, b) in found.force.iter().zip(&series.channels[0].measured[skip..]) {
        assert!((a - b).abs() < 0.01 * size);
    }
}
