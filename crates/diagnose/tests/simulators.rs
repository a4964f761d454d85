//! A simulator in the place of a model file: the same plant gets the same answer.
#![allow(clippy::unwrap_used)]

use std::sync::Arc;

use simgap_diagnose::{DiagnoseError, Outcome, Request, Status, diagnose};
use simgap_model::Model;
use simgap_record::{Channel, Record};
use simgap_simulate::{ExternalPlant, Plant, PlantError, PlantRun};

const STEP_S: f64 = 5e-3;
const SAMPLES: usize = 1200;
const FRICTION_N: f64 = 1.4;
const LATE_S: f64 = 0.011;

const INSIDE: &str = r#"
schema = "simgap-model/1"
name = "table"
[[mass]]
name = "slide"
value = 2.0
[[spring]]
name = "leaf"
between = ["slide", "ground"]
stiffness = 180.0
[[damper]]
name = "guide"
between = ["slide", "ground"]
damping = 3.0
[[input]]
channel = "u"
kind = "force"
at = "slide"
between_samples = "held"
[[output]]
channel = "y"
kind = "displacement"
at = "slide"
"#;

const OUTSIDE: &str = r#"
schema = "simgap-model/1"
name = "table"
[[parameter]]
name = "mass"
value = 2.0
[[parameter]]
name = "stiffness"
value = 180.0
[[parameter]]
name = "damping"
value = 3.0
[[port]]
name = "slide"
displacement = "x"
velocity = "v"
[[input]]
channel = "u"
kind = "signal"
at = "u"
[[output]]
channel = "y"
kind = "signal"
at = "x"
"#;

/// Displacement and velocity under held forces, by many small steps; friction acts in each.
fn motion(
    [m, k, c]: [f64; 3],
    forces: impl Iterator<Item = f64>,
    friction: f64,
    fine: usize,
) -> [Vec<f64>; 2] {
    let h = STEP_S / fine as f64;
    let (mut x, mut v) = (0.0_f64, 0.0_f64);
    let mut signals = [vec![], vec![]];
    for f in forces {
        signals[0].push(x);
        signals[1].push(v);
        for _ in 0..fine {
            let free = v + h / m * (f - c * v - k * x);
            let most = h / m * friction;
            v = free - free.abs().min(most).copysign(free);
            x += h * v;
        }
    }
    signals
}

/// Looked for here: the whole catalogue says the same in many times as long.
const RIVALS: [&str; 11] = [
    "mass_error",
    "stiffness_error",
    "damping_error",
    "parameter_error",
    "input_gain",
    "input_delay",
    "coulomb_friction",
    "viscous_damping",
    "sensor_delay",
    "sensor_gain",
    "sensor_lag",
];

/// Steps of the simulator, and of the machine: a sixteenth of them.
const FINE: usize = 8;

struct Table;

impl Plant for Table {
    fn simulate(&self, run: &PlantRun<'_>) -> Result<Vec<Vec<f64>>, PlantError> {
        let [m, k, c] = [0, 1, 2].map(|i| run.parameters[i].1);
        let forces = run.inputs[0].1.iter().zip(&run.forces[0].1);
        let signals = motion([m, k, c], forces.map(|(u, f)| u + f), 0.0, FINE);
        let of = |name: &String| signals[usize::from(name == "v")].clone();
        Ok(run.outputs.iter().map(of).collect())
    }
}

fn record(k: u32) -> Record {
    let t: Vec<f64> = (0..SAMPLES).map(|n| n as f64 * STEP_S).collect();
    let phase = f64::from(k);
    let force = |t: &f64| {
        let tones = 4.0 * (6.1 * t + phase).sin() + 3.0 * (10.3 * t - 2.0 * phase).sin();
        (1.0 - (-2.0 * t).exp()) * (tones + 2.0 * (2.3 * t + 0.7 * phase).cos())
    };
    let u: Vec<f64> = t.iter().map(force).collect();
    let [x, _] = motion([2.0, 180.0, 3.0], u.iter().copied(), FRICTION_N, 128);
    let late = |n: usize| {
        let at = (n as f64 - LATE_S / STEP_S).max(0.0);
        let (left, part) = (at as usize, at.fract());
        x[left] + part * (x[(left + 1).min(SAMPLES - 1)] - x[left])
    };
    // White noise of 20 µm from a counter.
    let noise = |n: usize| {
        let word = (n as u64 + 7919 * u64::from(k)).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        let word = (word ^ (word >> 29)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        3.5e-5 * (((word ^ (word >> 32)) >> 11) as f64 / (1_u64 << 52) as f64 - 1.0)
    };
    let y = (0..SAMPLES).map(|n| late(n) + noise(n)).collect();
    let channels = vec![Channel::new("u", "N", u), Channel::new("y", "m", y)];
    Record::new(format!("run{k}.csv"), t, channels).unwrap()
}

fn asked(text: &str, plant: Option<Arc<ExternalPlant>>) -> Outcome {
    let model = Model::from_toml(text).unwrap();
    let records = [record(1), record(2), record(3)];
    let kinds = simgap_effects::catalogue()
        .iter()
        .map(|effect| effect.kind());
    let withheld = kinds.filter(|kind| !RIVALS.contains(kind));
    let withheld: Vec<String> = withheld.map(String::from).collect();
    let request = Request {
        plant,
        withheld: &withheld,
        ..Request::new(&model, &records[..2], &records[2..])
    };
    diagnose(&request, &|_| {}).unwrap()
}

#[test]
fn verify_a_simulator_gets_the_answer_of_its_model_file() {
    let inside = asked(INSIDE, None);
    let outside = asked(OUTSIDE, Some(ExternalPlant::new(Table)));
    for outcome in [&inside, &outside] {
        let verdict = &outcome.diagnosis.verdict;
        assert_eq!(verdict.status, Status::Effect);
        let value = |kind: &str| {
            let effect = verdict.effects.iter().find(|effect| effect.kind == kind);
            effect.map(|effect| effect.parameters[0].value)
        };
        assert_eq!(verdict.effects.len(), 2);
        let friction = value("coulomb_friction").unwrap();
        assert!((friction / FRICTION_N - 1.0).abs() < 0.03, "{friction}");
        // One input and one output: a late sensor and a late input are told apart by how a record begins at the most.
        let late = value("sensor_delay")
            .or_else(|| value("input_delay"))
            .unwrap();
        assert!((late / LATE_S - 1.0).abs() < 0.1, "{late}");
    }
    let gaps = [&inside, &outside].map(|outcome| outcome.diagnosis.gap.corrected);
    let nominal = inside.diagnosis.gap.nominal;
    assert!((gaps[0] - gaps[1]).abs() < 0.01 * nominal, "{gaps:?}");
}

#[test]
fn verify_a_simulator_needs_itself_and_a_check_record() {
    let model = Model::from_toml(OUTSIDE).unwrap();
    let records = [record(1), record(2)];
    let error = |request: Request<'_, Record>| diagnose(&request, &|_| {}).err().unwrap();
    let alone = error(Request::new(&model, &records[..1], &records[1..]));
    assert!(
        alone.to_string().contains("needed is the simulator itself"),
        "{alone}"
    );
    let unjudged = error(Request {
        plant: Some(ExternalPlant::new(Table)),
        ..Request::new(&model, &records, &[])
    });
    assert!(matches!(unjudged, DiagnoseError::NoCheckRecord));
}
