//! What one record shows and another does not, and what several sensors show of one force.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use crate::common::{diagnosed, ground, named, placed, plant, record};
use simgap_diagnose::{Outcome, Request, Status, diagnose};
use simgap_effects::Placed;
use simgap_model::{Location, Model};
use simgap_record::{Channel, Record};

const ROWS: usize = 2500;
const STEP_S: f64 = 4e-3;
/// Step of a converter.
const STEP_M: f64 = 2e-3;

fn of_plant(effects: &[Placed], number: u64) -> Record {
    record(&plant(), effects, number, ROWS, STEP_S, 0.0)
}

fn judged(train: &[Record], check: &[Record], withheld: &[&str]) -> Outcome {
    let withheld: Vec<String> = withheld.iter().map(ToString::to_string).collect();
    let model = plant();
    let request = Request {
        withheld: &withheld,
        ..Request::new(&model, train, check)
    };
    diagnose(&request, &|_| {}).unwrap()
}

/// A stop that the check record does not reach. Where nothing like it is looked for, the check record shows no gap, and
/// that is not what the others say.
#[test]
fn verify_what_the_check_record_does_not_show_is_not_nothing() {
    let truth = [placed("end_stop", ground(), &[2.5e-3, 1.0, 4e4, 0.0])];
    // All that is known is looked for, and nothing fits: half as finely as elsewhere.
    let of_plant = |truth, number| record(&plant(), truth, number, ROWS / 2, 2.0 * STEP_S, 0.0);
    let train = [1, 2].map(|number| of_plant(&truth[..], number));
    let check = [of_plant(&[], 3)];
    let withheld = [
        "end_stop",
        "bilinear_stiffness",
        "backlash",
        "quadratic_stiffness",
        "cubic_stiffness",
        "clipping",
    ];
    let verdict = judged(&train, &check, &withheld).diagnosis.verdict;
    assert_eq!(verdict.status, Status::Unknown, "{verdict:?}");
}

/// A tone in every sensor, in the ratio in which one force shows on them: without a force in the catalogue, it is not one of each
/// cable.
#[test]
fn verify_a_force_is_not_taken_for_a_tone_of_every_sensor() {
    let base = Location::Mass("base".into());
    let truth = [placed("harmonic_force", base, &[2.0, 5.3, 0.4])];
    let outcome = diagnosed(&truth, &["harmonic_force"]);
    let verdict = &outcome.diagnosis.verdict;
    assert_eq!(verdict.status, Status::Unknown, "{verdict:?}");
    let mut told = verdict.description.iter();
    let is_told = told.any(|sentence| sentence.contains("one cause behind both"));
    assert!(is_told, "{:?}", verdict.description);
}

/// Spikes of the first record only, beside the steps of a converter: the last samples of the records say nothing about
/// spikes.
#[test]
fn verify_spikes_of_one_record_are_seen_beside_another_fault() {
    let records = [1, 2, 3].map(|number| {
        let clean = of_plant(&[], number);
        let stored = clean.channels().iter().map(|channel| {
            let mut values = channel.values.clone();
            match channel.name.as_str() {
                "x" => values
                    .iter_mut()
                    .for_each(|x| *x = STEP_M * (*x / STEP_M).round()),
                "a" if number == 1 => {
                    values[431] += 60.0;
                    values[987] -= 75.0;
                }
                _ => {}
            }
            Channel::new(&channel.name, channel.unit.symbol(), values)
        });
        Record::from_uniform(format!("{number}.csv"), 0.0, STEP_S, stored.collect()).unwrap()
    });
    let at = |channel: &str| Location::Channel(channel.into());
    let both = [("outliers", "a"), ("quantisation", "x")];
    for train in [&records[..2], &records[..1]] {
        let outcome = judged(train, &records[2..], &[]);
        let mut found = named(&outcome);
        found.sort_by(|a, b| a.0.cmp(&b.0));
        assert_eq!(
            found,
            both.map(|(kind, channel)| (kind.to_string(), at(channel)))
        );
    }
}

/// A slide with nothing that holds it: with the noise of its drive, a model of it wanders.
const SLIDE: &str = r#"schema = "simgap-model/1"
name = "slide"
[[mass]]
name = "slide"
value = 2.0
[[damper]]
name = "guide"
between = ["slide", "ground"]
damping = 6.0
[[input]]
channel = "u"
kind = "force"
at = "slide"
[[output]]
channel = "x"
kind = "displacement"
at = "slide"
"#;

fn of_slide(truth: &[Placed]) -> Outcome {
    let model = Model::from_toml(SLIDE).unwrap();
    let record = |number| record(&model, truth, number, ROWS, STEP_S, 0.03);
    let (train, check) = ([1, 2].map(record), [record(3)]);
    let request = Request::new(&model, &train, &check);
    diagnose(&request, &|_| {}).unwrap()
}

/// How far it wanders is no effect, and no reason against a spring that holds it.
#[test]
fn verify_what_wanders_with_the_noise_of_an_input_is_told_from_a_spring() {
    let clean = of_slide(&[]).diagnosis.verdict;
    assert_eq!(clean.status, Status::None, "{clean:?}");
    let at = Location::Between(["slide".into(), "ground".into()]);
    let stiffness = 15.0;
    let held = of_slide(&[placed("linear_stiffness", at, &[stiffness])]);
    let [spring] = &held.diagnosis.verdict.effects[..] else {
        panic!("{:?}", held.diagnosis.verdict);
    };
    assert_eq!(spring.kind, "linear_stiffness");
    let found = spring.parameters[0].value;
    assert!((found / stiffness - 1.0).abs() < 0.1, "{found}");
}

/// A force at one frequency that the model file knows, with the phase of some other record: every record has one of its own.
#[test]
fn verify_the_phase_in_a_model_file_is_that_of_no_record() {
    let text = "[[effect]]\nkind = \"harmonic_force\"\nmass = \"base\"\namplitude_n = 2.0\n\
                frequency_hz = 5.3\nphase_rad = 0.0\n";
    let model = Model::from_toml(&format!("{}{text}", plant().to_toml().unwrap())).unwrap();
    let of_phase = |number: u64, phase: f64| {
        let base = Location::Mass("base".into());
        of_plant(
            &[placed("harmonic_force", base, &[2.0, 5.3, phase])],
            number,
        )
    };
    let train = [of_phase(1, 0.4), of_phase(2, 1.9)];
    let check = [of_phase(3, 3.0)];
    let outcome = diagnose(&Request::new(&model, &train, &check), &|_| {}).unwrap();
    let diagnosis = outcome.diagnosis;
    assert_eq!(
        diagnosis.verdict.status,
        Status::None,
        "{:?}",
        diagnosis.verdict
    );
    let gap = &diagnosis.gap;
    assert!(gap.recalibrated < 1.1 * gap.noise_floor, "{gap:?}");
}
