//! What check records say of an answer that the training records gave.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use crate::common::{placed, plant, record};
use simgap_diagnose::{Outcome, Request, Status, diagnose};
use simgap_effects::Placed;
use simgap_model::Location;
use simgap_record::Record;

fn of(effects: &[Placed], number: u64) -> Record {
    record(&plant(), effects, number, 2500, 4e-3, 0.0)
}

/// Trained on two records of a machine with some effects.
fn diagnosed(train: &[Placed], check: Record) -> Outcome {
    let train: Vec<Record> = (1..3).map(|number| of(train, number)).collect();
    diagnose(&Request::new(&plant(), &train, &[check]), &|_| {}).unwrap()
}

fn tone(amplitude: f64) -> Placed {
    let at = Location::Channel("x".into());
    placed("tone_pickup", at, &[amplitude, 5.3, 0.4])
}

/// A tone of half the size leaves as much with the tone of the training records as without: that closes nothing.
#[test]
fn verify_an_effect_that_closes_nothing_of_a_check_record_is_refuted() {
    let same = diagnosed(&[tone(6e-4)], of(&[tone(6e-4)], 3)).diagnosis;
    assert_eq!(same.verdict.status, Status::Effect);
    assert_eq!(same.verdict.effects[0].kind, "tone_pickup");
    let half = diagnosed(&[tone(6e-4)], of(&[tone(3e-4)], 3)).diagnosis;
    assert!(half.gap.corrected < 1.1 * half.gap.recalibrated, "no worse");
    assert!(half.verdict.refuted, "{:?}", half.verdict);
    assert_eq!(half.verdict.status, Status::Unknown);
    assert_eq!(half.verdict.leading[0].kind, "tone_pickup");
}
