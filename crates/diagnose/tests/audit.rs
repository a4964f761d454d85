//! What the audit of records against a model says, and when it is silent.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use crate::common::{self, plant, record};
use simgap_diagnose::audit::audit;
use simgap_model::Model;
use simgap_record::{AuditFinding, AuditTopic, Channel, Record};

const ROWS: usize = 2500;
const STEP_S: f64 = 4e-3;

fn clean() -> Record {
    record(&plant(), &[], 1, ROWS, STEP_S, 0.0)
}

fn with(record: &Record, step_s: f64, change: impl Fn(&mut Channel)) -> Record {
    let mut channels = record.channels().to_vec();
    channels.iter_mut().for_each(change);
    Record::from_uniform(record.name(), 0.0, step_s, channels).unwrap()
}

fn found(model: &Model, record: &Record) -> Vec<AuditFinding> {
    audit(model, &[record]).unwrap()
}

fn outputs(model: &Model) -> Vec<String> {
    model.outputs.iter().map(|o| o.channel.clone()).collect()
}

/// A change of one output channel of the clean record, and what is said of it.
fn told(change: impl Fn(&mut Vec<f64>)) -> Vec<(AuditTopic, String)> {
    let model = plant();
    let first = outputs(&model)[0].clone();
    let changed = with(&clean(), STEP_S, |channel| {
        if channel.name == first {
            change(&mut channel.values);
        }
    });
    let findings = found(&model, &changed).into_iter();
    findings.map(|f| (f.topic, f.text)).collect()
}

#[test]
fn verify_clean_records_are_not_told_of() {
    let model = plant();
    for number in 1..6 {
        let record = record(&model, &[], number, ROWS, STEP_S, 0.01);
        assert_eq!(found(&model, &record), [], "record {number}");
    }
}

/// Effects of the catalogue are no odd records: the audit leaves them to the diagnosis.
#[test]
fn verify_machines_with_effects_are_not_told_of() {
    let model = plant();
    let ground = common::ground();
    for (kind, values) in [
        ("stiffness_error", vec![1.3]),
        ("damping_error", vec![0.4]),
        ("coulomb_friction", vec![2.0]),
        ("cubic_stiffness", vec![3e7]),
    ] {
        let effect = common::placed(kind, ground.clone(), &values);
        let record = record(&model, &[effect], 2, ROWS, STEP_S, 0.0);
        assert_eq!(found(&model, &record), [], "{kind}");
    }
}

#[test]
fn regress_what_is_odd_against_the_model() {
    let mut text = String::new();
    let mut note = |case: &str, found: Vec<(AuditTopic, String)>| {
        for (topic, line) in found {
            text += &format!("{case}: [{}] {line}\n", topic.name());
        }
    };
    note("sign", told(|y| y.iter_mut().for_each(|y| *y *= -1.0)));
    note("mm as m", told(|y| y.iter_mut().for_each(|y| *y *= 1e3)));
    note("kilo", told(|y| y.iter_mut().for_each(|y| *y *= 1e-3)));
    note("g", told(|y| y.iter_mut().for_each(|y| *y /= 9.806_65)));
    note("late", told(|y| y.rotate_right(20)));
    note("early", told(|y| y.rotate_left(20)));
    note("zero", told(|y| y.iter_mut().for_each(|y| *y += 1.0)));
    let mut word = 7_u64;
    let mut noise = || {
        word = word
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (word >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    };
    let drawn: Vec<f64> = (0..ROWS).map(|_| 1e-3 * noise()).collect();
    note("noise only", told(|y| y.copy_from_slice(&drawn)));
    let model = plant();
    let ms = with(&clean(), 1e-3 * STEP_S, |_| {});
    let found_ms = found(&model, &ms).into_iter().map(|f| (f.topic, f.text));
    note(
        "ms as s",
        found_ms.filter(|f| f.0 == AuditTopic::Clock).collect(),
    );
    insta::assert_snapshot!(text);
}

/// A mass that nothing joins to what is driven.
#[test]
fn verify_a_channel_that_nothing_moves_is_named() {
    let mut model = plant();
    let free = simgap_model::Mass {
        name: "apart".into(),
        value: 1.0,
        ..model.masses[0].clone()
    };
    model.masses.push(free);
    let mut output = model.outputs[0].clone();
    output.channel = "apart".into();
    output.at = Some("apart".into());
    output.between = None;
    model.outputs.push(output);
    let clean = clean();
    let mut channels = clean.channels().to_vec();
    let like = model.outputs[0].channel.clone();
    let like = channels
        .iter()
        .find(|channel| channel.name == like)
        .unwrap();
    let unit = like.unit.symbol().to_string();
    let values = (0..ROWS).map(|k| (0.3 * k as f64).sin()).collect();
    channels.push(Channel::new("apart", &unit, values));
    let record = Record::from_uniform("A.csv", 0.0, STEP_S, channels).unwrap();
    let found = found(&model, &record);
    assert!(
        found
            .iter()
            .any(|f| f.topic == AuditTopic::Unmoved && f.text.contains("'apart'")),
        "{found:?}"
    );
}
