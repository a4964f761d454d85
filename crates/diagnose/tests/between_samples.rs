//! Inputs that keep their values between samples, and those that do not.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use simgap_diagnose::{Cancel, Diagnosis, Request, Status, diagnose};
use simgap_inference::read_inputs;
use simgap_model::{BetweenSamples, Model};
use simgap_record::{Channel, Record};
use simgap_simulate::Run;

const STEP_S: f64 = 0.01;
const SAMPLES: usize = 3000;
const MASS: f64 = 2.0;
const STIFFNESS: f64 = 800.0;
const DAMPING: f64 = 4.0;

fn model(stated: &str) -> Model {
    let text = format!(
        r#"schema = "simgap-model/1"
name = "axis"
[[mass]]
name = "m"
value = {MASS}
[[spring]]
name = "k"
between = ["m", "ground"]
stiffness = {STIFFNESS}
[[damper]]
name = "c"
between = ["m", "ground"]
damping = {DAMPING}
[[input]]
channel = "u"
kind = "force"
at = "m"
{stated}
[[output]]
channel = "x"
kind = "displacement"
at = "m"
"#
    );
    Model::from_toml(&text).unwrap()
}

/// Evenly drawn between -1 and 1 (splitmix64).
struct Draw(u64);

impl Draw {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}

/// Two levels, each kept for 4 to 24 samples.
fn binary(draw: &mut Draw) -> Vec<f64> {
    let mut values = vec![];
    let mut level = 10.0;
    while values.len() < SAMPLES {
        let kept = 4 + (10.0 * (draw.next() + 1.0)) as usize;
        values.extend(std::iter::repeat_n(level, kept));
        level = -level;
    }
    values.truncate(SAMPLES);
    values
}

/// What drives within the interval after a sample: `share` of the way to the next.
type Between = fn(f64, f64, f64) -> f64;

fn held(now: f64, _: f64, _: f64) -> f64 {
    now
}

fn line(now: f64, next: f64, share: f64) -> f64 {
    now + share * (next - now)
}

/// A record of the axis that is driven by two levels.
fn record(number: u64, between: Between, friction: f64) -> Record {
    let mut draw = Draw(number);
    let input = binary(&mut draw);
    let within = |i: usize, share: f64| between(input[i], input[(i + 1).min(SAMPLES - 1)], share);
    driven(&format!("{number}.csv"), &within, [1.0, friction], draw)
}

/// A record of the axis by a Runge-Kutta method of fourth order in twenty steps a sample, driven by `gain` times what the input is
/// within the interval after a sample, with Coulomb friction of `friction`, smoothed within 0.1 mm/s.
fn driven(
    name: &str,
    within: &dyn Fn(usize, f64) -> f64,
    [gain, friction]: [f64; 2],
    mut draw: Draw,
) -> Record {
    const PARTS: usize = 20;
    let rate = |u: f64, [x, v]: [f64; 2]| {
        let dry = friction * (v / 1e-4).tanh();
        [v, (gain * u - DAMPING * v - STIFFNESS * x - dry) / MASS]
    };
    let h = STEP_S / PARTS as f64;
    let mut state = [0.0, 0.0];
    let mut output = vec![];
    for i in 0..SAMPLES {
        output.push(state[0]);
        for part in 0..PARTS {
            let u = |half: f64| within(i, (part as f64 + half) / PARTS as f64);
            let along = |state: [f64; 2], rate: [f64; 2], h: f64| {
                [state[0] + h * rate[0], state[1] + h * rate[1]]
            };
            let a = rate(u(0.0), state);
            let b = rate(u(0.5), along(state, a, 0.5 * h));
            let c = rate(u(0.5), along(state, b, 0.5 * h));
            let d = rate(u(1.0), along(state, c, h));
            for k in 0..2 {
                state[k] += h / 6.0 * (a[k] + 2.0 * b[k] + 2.0 * c[k] + d[k]);
            }
        }
    }
    let rms = (output.iter().map(|x| x * x).sum::<f64>() / SAMPLES as f64).sqrt();
    for value in &mut output {
        *value += 0.003 * rms * (draw.next() + draw.next() + draw.next());
    }
    let channels = vec![
        Channel::new("u", "N", (0..SAMPLES).map(|i| within(i, 0.0)).collect()),
        Channel::new("x", "m", output),
    ];
    Record::from_uniform(name, 0.0, STEP_S, channels).unwrap()
}

fn diagnosed(stated: &str, between: Between, friction: f64) -> Diagnosis {
    let [a, b, c] = [1, 2, 3].map(|number| record(number, between, friction));
    let outcome = diagnose(&Request::new(&model(stated), &[a, b], &[c]), &|_| {}).unwrap();
    outcome.diagnosis
}

fn told(diagnosis: &Diagnosis) -> bool {
    diagnosis
        .notes
        .iter()
        .any(|note| note.contains("zero-order hold"))
}

#[test]
fn verify_a_clean_machine_is_clean_in_either_reading() {
    let of_held = diagnosed("", held, 0.0);
    assert_eq!(
        of_held.verdict.status,
        Status::None,
        "{:?}",
        of_held.verdict
    );
    assert!(of_held.verdict.complete && told(&of_held));
    let of_lines = diagnosed("", line, 0.0);
    assert_eq!(
        of_lines.verdict.status,
        Status::None,
        "{:?}",
        of_lines.verdict
    );
    assert!(of_lines.verdict.complete && !told(&of_lines));
}

#[test]
fn verify_an_effect_is_found_beside_a_held_input() {
    let diagnosis = diagnosed("", held, 2.0);
    let [effect] = &diagnosis.verdict.effects[..] else {
        panic!("{:?}", diagnosis.verdict);
    };
    assert_eq!(effect.kind, "coulomb_friction");
    assert!(
        (effect.parameters[0].value / 2.0 - 1.0).abs() < 0.02,
        "{effect:?}"
    );
    assert!(told(&diagnosis));
}

/// A force that is smooth in one record and goes in jumps in the others, and acts with the other sign: read as one smooth curve it
/// would swing about each jump, read as held it would be late everywhere.
#[test]
fn verify_a_sweep_beside_square_waves_is_smooth_between_its_steps() {
    let turns = |t: f64| std::f64::consts::TAU * (0.5 * t + 0.125 * t * t);
    let curve = |i: usize, share: f64| 10.0 * turns(STEP_S * (i as f64 + share)).sin();
    let reversed = [-1.0, 0.0];
    let sweep = driven("sweep.csv", &curve, reversed, Draw(9));
    let [square, check] = [1, 2].map(|number| {
        let mut draw = Draw(number);
        let input = binary(&mut draw);
        let within = |i: usize, _: f64| input[i];
        driven(&format!("{number}.csv"), &within, reversed, draw)
    });
    let outcome = diagnose(
        &Request::new(&model(""), &[sweep, square], &[check]),
        &|_| {},
    );
    let diagnosis = outcome.unwrap().diagnosis;
    let [effect] = &diagnosis.verdict.effects[..] else {
        panic!("{:?}", diagnosis.verdict);
    };
    assert_eq!(effect.kind, "input_gain");
    assert!(
        (effect.parameters[0].value + 1.0).abs() < 0.03,
        "{effect:?}"
    );
    assert!(diagnosis.verdict.complete, "{:?}", diagnosis.verdict);
    let mut notes = diagnosis.notes.iter();
    assert!(notes.any(|note| note.contains("a smooth curve but for its jumps")));
}

/// What the model file states is not asked again.
#[test]
fn verify_the_model_file_decides_what_an_input_does_between_samples() {
    let record = record(1, held, 0.0);
    let read = |stated: &str| {
        let model = model(stated);
        let run = Run::with_outputs(&model, &record).unwrap();
        let read = read_inputs(&model, &[run], &Cancel::default()).unwrap();
        read.inputs[0].between_samples
    };
    assert_eq!(read(""), Some(BetweenSamples::Held));
    let stated = [
        ("smooth", BetweenSamples::Smooth),
        ("linear", BetweenSamples::Linear),
        ("held", BetweenSamples::Held),
        ("stepped", BetweenSamples::Stepped),
    ];
    for (name, wanted) in stated {
        assert_eq!(read(&format!("between_samples = \"{name}\"")), Some(wanted));
    }
}
