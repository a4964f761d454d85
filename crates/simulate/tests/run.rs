//! From a record to a run: units, gains, missing columns, stretches.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use crate::support::{self, force_input, model, oscillator, output, predict};
use simgap_record::{Channel, Record};
use simgap_simulate::Run;

fn wave(scale: f64) -> Vec<f64> {
    (0..40)
        .map(|k| scale * (0.3 * f64::from(k)).sin())
        .collect()
}

fn record(channels: Vec<Channel>) -> Record {
    Record::from_uniform("A.csv", 2.0, 0.01, channels).unwrap()
}

fn plain() -> simgap_model::Model {
    model(
        &[
            oscillator(2.0, 800.0, 5.0, "ground"),
            force_input("block"),
            output("y", "displacement", "block"),
        ]
        .concat(),
    )
}

/// As [`plain`], with a gain on the input and on the output.
fn with_gains(input: f64, out: f64) -> simgap_model::Model {
    let mut model = plain();
    model.inputs[0].gain = Some(input);
    model.outputs[0].gain = Some(out);
    model
}

#[test]
fn verify_units_are_converted_where_there_is_no_gain() {
    let record = record(vec![
        Channel::new("u", "kN", wave(1.5)),
        Channel::new("y", "mm", wave(0.2)),
    ]);
    let run = Run::new(&plain(), &record).unwrap();
    assert_eq!(run.start_s, 2.0);
    let same = |a: &[f64], b: &[f64]| {
        a.iter()
            .zip(b)
            .all(|(a, b)| (a - b).abs() <= 1e-12 * b.abs())
    };
    assert!(same(&run.inputs[0], &wave(1500.0)));
    assert!(same(run.measured[0].as_ref().unwrap(), &wave(0.2e-3)));
}

/// The contract: model unit per unit of the channel; with it any unit is accepted, as it stands.
#[test]
fn verify_a_gain_takes_the_numbers_as_they_stand() {
    for (input, out) in [("V", "V"), ("kN", "mm"), ("N", "m"), ("kg", "K")] {
        let record = record(vec![
            Channel::new("u", input, wave(1.5)),
            Channel::new("y", out, wave(0.2)),
        ]);
        let run = Run::new(&with_gains(35.0, -0.5), &record).unwrap();
        let of =
            |signal: Vec<f64>, gain: f64| signal.iter().map(|v| gain * v).collect::<Vec<f64>>();
        assert_eq!(run.inputs[0], of(wave(1.5), 35.0), "{input}");
        assert_eq!(run.measured[0], Some(of(wave(0.2), -0.5)), "{out}");
        // Volts times the gain push as newtons do.
        let newtons = Record::from_uniform(
            "B.csv",
            2.0,
            0.01,
            vec![Channel::new("u", "N", of(wave(1.5), 35.0))],
        );
        let direct = Run::new(&plain(), &newtons.unwrap()).unwrap();
        let by_gain = predict(&with_gains(35.0, -0.5), &[], 1, &run, &[]);
        // The gain of an output is for what was measured: predictions are in model units.
        assert_eq!(by_gain, predict(&plain(), &[], 1, &direct, &[]));
    }
}

#[test]
fn regress_a_unit_that_does_not_fit_and_columns_that_are_not_there() {
    let of = |channels: Vec<Channel>| {
        let error = Run::with_outputs(&plain(), &record(channels)).unwrap_err();
        error.to_string()
    };
    let u = || Channel::new("u", "N", wave(1.0));
    let y = |unit: &str| Channel::new("y", unit, wave(1.0));
    insta::assert_snapshot!(of(vec![u(), y("V")]), @"A.csv: column 'y' is in [V], which is neither a motion nor a force, but a displacement is needed (m, mm, um, rad or deg), or a gain in the model");
    insta::assert_snapshot!(of(vec![y("m")]), @"A.csv: column 'u' is needed, but the file has 'y'");
    insta::assert_snapshot!(of(vec![u()]), @"A.csv: column 'y' is needed, but the file has 'u'");
}

#[test]
fn verify_inputs_alone_are_enough_for_a_run() {
    let record = record(vec![Channel::new("u", "N", wave(1.0))]);
    let run = Run::new(&plain(), &record).unwrap();
    assert_eq!(run.measured, vec![None]);
    assert!(Run::with_outputs(&plain(), &record).is_err());
}

#[test]
fn verify_a_stretch_of_a_run_keeps_its_clock() {
    let record = record(vec![
        Channel::new("u", "N", wave(1.0)),
        Channel::new("y", "m", wave(2.0)),
    ]);
    let run = Run::new(&plain(), &record).unwrap();
    let part = run.slice(10..25);
    assert_eq!((part.len, part.time_step_s), (15, 0.01));
    assert!((part.start_s - 2.1).abs() < 1e-12);
    assert_eq!(part.inputs[0], wave(1.0)[10..25]);
    assert_eq!(part.measured[0].as_deref(), Some(&wave(2.0)[10..25]));
    assert_eq!(run.slice(30..99).len, 10, "cut at the end of the run");
    assert_eq!(run.slice(99..120).len, 0);
}

/// A linear model marched in two parts is the model marched at once, where the force is as straight between
/// the samples as a part has to take it at its ends.
#[test]
fn verify_a_run_continued_from_its_state_is_the_whole_run() {
    let text = [
        oscillator(2.0, 800.0, 5.0, "ground"),
        force_input("block"),
        output("y", "displacement", "block"),
        output("v", "velocity", "block"),
    ]
    .concat();
    let model = model(&text);
    let ramp = (0..40).map(|i| 0.4 * f64::from(i)).collect();
    let record = record(vec![Channel::new("u", "N", ramp)]);
    let run = Run::new(&model, &record).unwrap();
    let whole = predict(&model, &[], 1, &run, &[0.01, 0.3]);
    let rest = predict(
        &model,
        &[],
        1,
        &run.slice(17..40),
        &[whole[0][17], whole[1][17]],
    );
    for c in 0..2 {
        assert!(support::largest_difference(&rest[c], &whole[c][17..]) < 1e-13);
    }
}
