//! Plants whose records are made finer than they are stored, by an odd factor: every other sample stays every other.

use simgap_diagnose::{Outcome, Request, diagnose};
use simgap_effects::{Placed, find};
use simgap_model::{InputKind, Location, Model, OutputKind};
use simgap_record::{Channel, Record};
use simgap_simulate::{Run, Simulator};

const FINER: usize = 5;
const DURATION_S: f64 = 10.0;
/// Noise over the spread of a channel.
const NOISE: f64 = 0.01;

const PLANT: &str = r#"schema = "simgap-model/1"
name = "two masses"
[[mass]]
name = "base"
value = 2.0
[[mass]]
name = "top"
value = 0.7
[[spring]]
name = "k1"
between = ["base", "ground"]
stiffness = 4000.0
[[spring]]
name = "k2"
between = ["top", "base"]
stiffness = 2500.0
[[damper]]
name = "c1"
between = ["base", "ground"]
damping = 9.0
[[damper]]
name = "c2"
between = ["top", "base"]
damping = 5.0
[[input]]
channel = "u"
kind = "force"
at = "base"
[[input]]
channel = "spare"
kind = "force"
at = "top"
[[output]]
channel = "x"
kind = "displacement"
at = "base"
[[output]]
channel = "a"
kind = "acceleration"
at = "top"
"#;

pub(crate) fn plant() -> Model {
    Model::from_toml(PLANT).unwrap()
}

pub(crate) fn ground() -> Location {
    Location::Between(["base".into(), "ground".into()])
}

pub(crate) fn placed(kind: &str, at: Location, values: &[f64]) -> Placed {
    Placed::new(find(kind).unwrap(), at, values.to_vec())
}

/// Numbers of zero mean and unit variance, about normal: twelve draws by splitmix64 each.
pub(crate) struct Noise(pub(crate) u64);

impl Noise {
    pub(crate) fn next(&mut self) -> f64 {
        let draw = |_| {
            self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
            let mut z = self.0;
            z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
            ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
        };
        (0..12).map(draw).sum::<f64>() - 6.0
    }
}

/// Lines between 1 and 14 Hz, other phases for each record; the spare input is silent.
fn drive(t: f64, number: f64) -> f64 {
    let lines = [1.3, 2.9, 4.7, 6.1, 7.9, 10.3, 13.7];
    let line = |(k, f): (usize, f64)| {
        let phase = 2.1 * number + 1.7 * (k * k) as f64;
        (std::f64::consts::TAU * f * t + phase).sin()
    };
    8.0 * lines.into_iter().enumerate().map(line).sum::<f64>()
}

/// A record of a machine that is a plant with effects, by its number; its input is stored with noise of a share of it.
pub(crate) fn record(
    model: &Model,
    effects: &[Placed],
    number: u64,
    rows: usize,
    step_s: f64,
    input_noise: f64,
) -> Record {
    let fine = rows * FINER;
    let step = step_s / FINER as f64;
    let input: Vec<f64> = (0..fine)
        .map(|n| drive(n as f64 * step, number as f64))
        .collect();
    // All inputs but the first are silent.
    let inputs = model.inputs.iter().enumerate();
    let inputs = inputs.map(|(k, _)| {
        if k == 0 {
            input.clone()
        } else {
            vec![0.0; fine]
        }
    });
    let run = Run {
        name: "machine".into(),
        start_s: 0.0,
        time_step_s: step,
        len: fine,
        first_index: 0,
        inputs: inputs.collect(),
        measured: vec![],
        mended: simgap_simulate::Mended::default(),
    };
    let simulator = Simulator::new(model, effects, 1).unwrap();
    let rest = vec![0.0; simulator.state_len()];
    let outputs = simulator.predict(&run, &rest).unwrap();
    let mut noise = Noise(1000 + number);
    let stored = |signal: &[f64]| -> Vec<f64> { signal.iter().copied().step_by(FINER).collect() };
    let mut noisy = |signal: &[f64], share: f64| -> Vec<f64> {
        let clean = stored(signal);
        let spread = (clean.iter().map(|y| y * y).sum::<f64>() / rows as f64).sqrt();
        let noisy = clean.iter().map(|y| y + share * spread * noise.next());
        noisy.collect()
    };
    let mut channels = vec![];
    for (k, drive) in model.inputs.iter().enumerate() {
        let unit = match drive.kind {
            InputKind::Force => "N",
            InputKind::Displacement => "m",
            InputKind::Command | InputKind::SetPoint | InputKind::Signal => "1",
        };
        let values = match k {
            0 if input_noise > 0.0 => noisy(&input, input_noise),
            0 => stored(&input),
            _ => vec![0.0; rows],
        };
        channels.push(Channel::new(&drive.channel, unit, values));
    }
    for (signal, output) in outputs.iter().zip(&model.outputs) {
        let unit = match output.kind {
            OutputKind::Acceleration => "m/s^2",
            OutputKind::Force => "N",
            OutputKind::Velocity => "m/s",
            OutputKind::Displacement => "m",
            OutputKind::Roll => "rad",
            OutputKind::Pressure => "Pa",
            OutputKind::Flow => "m^3/s",
            OutputKind::Signal => "1",
            OutputKind::Spool => "1",
        };
        let values = noisy(signal, NOISE);
        channels.push(Channel::new(&output.channel, unit, values));
    }
    Record::from_uniform(format!("{number}.csv"), 0.0, step_s, channels).unwrap()
}

/// Diagnoses two records of a machine, checked on a third.
pub(crate) fn diagnosed(effects: &[Placed], withheld: &[&str]) -> Outcome {
    diagnosed_as(&plant(), effects, withheld, 4e-3)
}

/// The same of a machine that is another plant with effects, sampled in steps of so many seconds.
pub(crate) fn diagnosed_as(
    model: &Model,
    effects: &[Placed],
    withheld: &[&str],
    step_s: f64,
) -> Outcome {
    diagnosed_with_noise(model, effects, withheld, step_s, 0.0)
}

/// The same where the input is stored with noise of a share of it.
pub(crate) fn diagnosed_with_noise(
    model: &Model,
    effects: &[Placed],
    withheld: &[&str],
    step_s: f64,
    input_noise: f64,
) -> Outcome {
    let rows = (DURATION_S / step_s).round() as usize;
    let of_number = |k| record(model, effects, k, rows, step_s, input_noise);
    let records: Vec<Record> = (1..4).map(of_number).collect();
    let withheld: Vec<String> = withheld.iter().map(ToString::to_string).collect();
    let request = Request {
        withheld: &withheld,
        ..Request::new(model, &records[..2], &records[2..])
    };
    diagnose(&request, &|_| {}).unwrap()
}

/// Kinds and places that are named.
pub(crate) fn named(outcome: &Outcome) -> Vec<(String, Location)> {
    let effects = outcome.diagnosis.verdict.effects.iter();
    effects.map(|e| (e.kind.clone(), e.at.clone())).collect()
}
