//! Records without an input: a plant that is let go and rings down.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use crate::common::{Noise, named, placed};
use simgap_diagnose::{Limit, Outcome, Request, Status, diagnose};
use simgap_effects::Placed;
use simgap_model::{Location, Model};
use simgap_record::{Channel, Record};
use simgap_simulate::{Run, Simulator};

const STEP_S: f64 = 2e-3;
const ROWS: usize = 2000;

const PLANT: &str = r#"schema = "simgap-model/1"
name = "beam with a tip"
[[mass]]
name = "beam"
value = 5.0
[[mass]]
name = "tip"
value = 2.5
[[spring]]
name = "k1"
between = ["beam", "ground"]
stiffness = 30000.0
[[spring]]
name = "k2"
between = ["tip", "beam"]
stiffness = 28000.0
[[damper]]
name = "c1"
between = ["beam", "ground"]
damping = 4.0
[[damper]]
name = "c2"
between = ["tip", "beam"]
damping = 4.0
[[output]]
channel = "a"
kind = "acceleration"
at = "tip"
[[output]]
channel = "x"
kind = "displacement"
at = "beam"
"#;

/// A record of a plant with effects, let go from a state: its channels have noise of their resolution and are
/// stored in steps of it.
fn record(
    model: &Model,
    effects: &[Placed],
    number: usize,
    state: &[f64],
    resolution: &[f64],
) -> Record {
    let run = Run {
        name: format!("{number}.csv"),
        start_s: 0.0,
        time_step_s: STEP_S,
        len: ROWS,
        first_index: 0,
        inputs: vec![],
        measured: vec![],
        mended: simgap_simulate::Mended::default(),
    };
    let simulator = Simulator::new(model, effects, 1).unwrap();
    let outputs = simulator.predict(&run, state).unwrap();
    let mut noise = Noise(number as u64);
    let channels = outputs.iter().zip(&model.outputs).zip(resolution);
    let channels = channels.map(|((signal, output), resolution)| {
        let stored = signal
            .iter()
            .map(|y| (y / resolution + noise.next()).round() * resolution);
        let unit = if output.channel == "a" { "m/s^2" } else { "m" };
        Channel::new(&output.channel, unit, stored.collect::<Vec<f64>>())
    });
    Record::from_uniform(format!("{number}.csv"), 0.0, STEP_S, channels.collect()).unwrap()
}

fn diagnosed(effects: &[Placed], resolution: [f64; 2], limit: Limit<'_>) -> Outcome {
    let model = Model::from_toml(PLANT).unwrap();
    let tips = [0.03, 0.02, -0.025].into_iter().enumerate();
    let records: Vec<Record> = tips
        .map(|(number, tip)| {
            let state = [0.5 * tip, tip, 0.0, 0.0];
            record(&model, effects, number, &state, &resolution)
        })
        .collect();
    let request = Request {
        limit,
        ..Request::new(&model, &records[..2], &records[2..])
    };
    diagnose(&request, &|_| {}).unwrap()
}

/// Where a free decay begins follows the channel that tells most of it, so that a delay there shows in the other one. It had no
/// name: the channel that it moves is not the one in which it closes the gap.
#[test]
fn verify_a_delay_is_found_where_it_shows_in_another_channel() {
    let at = Location::Channel("a".into());
    let outcome = diagnosed(
        &[placed("sensor_delay", at.clone(), &[3.1e-3])],
        [1e-3, 1e-7],
        Limit::default(),
    );
    let verdict = &outcome.diagnosis.verdict;
    assert_eq!(
        named(&outcome),
        [("sensor_delay".to_string(), at)],
        "{verdict:?}"
    );
    let delay = &verdict.effects[0].parameters[0];
    assert!((delay.value - 3.1e-3).abs() < 2e-5, "{delay:?}");
    assert!(verdict.complete, "{verdict:?}");
}

/// A sensor of a coarse resolution and a damping that is off: what else might be there cannot be told from nothing.
#[test]
fn verify_nothing_is_added_to_a_wrong_damping_within_coarse_steps() {
    let at = Location::Between(["beam".into(), "ground".into()]);
    let outcome = diagnosed(
        &[placed("damping_error", at.clone(), &[1.8])],
        [2.0, 1.5e-3],
        Limit::default(),
    );
    let verdict = &outcome.diagnosis.verdict;
    assert_eq!(verdict.status, Status::Parameters, "{verdict:?}");
    assert_eq!(
        named(&outcome),
        [("damping_error".to_string(), at)],
        "{verdict:?}"
    );
}

/// An angle in degrees that the model takes for radians: from what it says a pendulum would turn over, and no fit of the gain finds back.
#[test]
fn verify_degrees_for_radians_are_told_of_a_pendulum() {
    let model = Model::from_toml(
        "schema = \"simgap-model/1\"\nname = \"arm\"\n[[mass]]\nname = \"arm\"\nvalue = 0.02\n\
         [[damper]]\nname = \"pivot\"\nbetween = [\"arm\", \"ground\"]\ndamping = 0.012\n\
         [[pendulum]]\nat = \"arm\"\nvalue = 0.6\n\
         [[output]]\nchannel = \"phi\"\nkind = \"displacement\"\nat = \"arm\"\n",
    )
    .unwrap();
    let at = Location::Channel("phi".into());
    let degrees = 180.0 / std::f64::consts::PI;
    let truth = [placed("sensor_gain", at.clone(), &[degrees])];
    let angles = [1.9, 2.3, -2.1].into_iter().enumerate();
    let records: Vec<Record> = angles
        .map(|(number, angle)| record(&model, &truth, number, &[angle, 0.0], &[0.05]))
        .collect();
    let request = Request::new(&model, &records[..2], &records[2..]);
    let outcome = diagnose(&request, &|_| {}).unwrap();
    let verdict = &outcome.diagnosis.verdict;
    assert_eq!(
        named(&outcome),
        [("sensor_gain".to_string(), at)],
        "{verdict:?}"
    );
    let gain = &verdict.effects[0].parameters[0];
    assert!((gain.value / degrees - 1.0).abs() < 0.01, "{gain:?}");
    assert!(verdict.complete, "{verdict:?}");
}

/// A search that has spent its work ends with what it has, and says so.
#[test]
fn verify_a_search_ends_at_its_limit() {
    let at = Location::Channel("a".into());
    let truth = [placed("sensor_delay", at, &[3.1e-3])];
    let ended = diagnosed(&truth, [1e-3, 1e-7], Limit::Effort(0)).diagnosis;
    assert!(ended.stopped_early);
    assert!(
        ended
            .notes
            .iter()
            .any(|note| note.contains("ended at its limit"))
    );
    let done = diagnosed(&[], [1e-3, 1e-7], Limit::Asked(&|| false)).diagnosis;
    assert!(!done.stopped_early);
}
