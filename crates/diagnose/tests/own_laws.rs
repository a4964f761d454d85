//! A law of the user's among the entries of the catalogue: named where it acts, and only there.
#![allow(clippy::unwrap_used, clippy::panic)]

use crate::common::{diagnosed_as, named};
use simgap_diagnose::Status;
use simgap_effects::{Placed, find_of};
use simgap_model::{Law, LawParameter, Location, Model};

/// Fine enough for a machine of 7 Hz; what is withheld is looked for everywhere.
const STEP_S: f64 = 8e-3;
const TRUE: [f64; 3] = [4.0, 0.06, 3e4];

const SLIDE: &str = r#"schema = "simgap-model/1"
name = "slide"
[[mass]]
name = "slide"
value = 2.0
[[spring]]
name = "k"
between = ["slide", "ground"]
stiffness = 4000.0
[[damper]]
name = "c"
between = ["slide", "ground"]
damping = 9.0
[[input]]
channel = "u"
kind = "force"
at = "slide"
[[output]]
channel = "x"
kind = "displacement"
at = "slide"
"#;

fn guide() -> Location {
    Location::Between(["slide".into(), "ground".into()])
}

/// Drag that grows away from the middle of the travel: no entry of the catalogue has this shape.
fn model() -> Model {
    let parameters = vec![
        LawParameter::of_size("c", "N", 2.0),
        LawParameter::of_size("v0", "m/s", 0.1),
        LawParameter::of_size("k", "1/m^2", 1e4),
    ];
    let mut model = Model::from_toml(SLIDE).unwrap();
    model.laws = vec![Law {
        name: "grease".into(),
        summary: Some("drag of cold grease, more at the ends of the travel".into()),
        between: vec![],
        force: "c * tanh(v / v0) * (1 + k * d^2)".into(),
        parameters,
    }];
    model.check().unwrap();
    model
}

fn grease(model: &Model) -> Placed {
    Placed::new(find_of(model, "grease").unwrap(), guide(), TRUE.to_vec())
}

#[test]
fn verify_a_law_is_named_with_its_values_and_withheld() {
    let model = model();
    let outcome = diagnosed_as(&model, &[grease(&model)], &[], STEP_S);
    let verdict = &outcome.diagnosis.verdict;
    assert_eq!(verdict.status, Status::Effect, "{verdict:?}");
    assert_eq!(named(&outcome)[0], ("grease".to_string(), guide()));
    let effect = &verdict.effects[0];
    assert!(effect.probability > 0.9, "{}", effect.probability);
    for (parameter, truth) in effect.parameters.iter().zip(TRUE) {
        let off = parameter.value / truth - 1.0;
        assert!(off.abs() < 0.1, "{parameter:?}");
    }
    let units: Vec<_> = effect.parameters.iter().map(|p| p.unit.as_str()).collect();
    assert_eq!(units, ["N", "m/s", "1/m^2"]);
    // The corrected model holds the law and its values, and is a model of its own.
    let written = outcome.corrected.to_toml().unwrap();
    let read = Model::from_toml(&written).unwrap();
    assert_eq!(read, outcome.corrected);
    assert_eq!(read.law("grease"), model.law("grease"));
    let placed = Placed::from_entry(&read, &read.effects[0]).unwrap();
    assert_eq!(placed.effect.kind(), "grease");

    let without = diagnosed_as(&model, &[grease(&model)], &["grease"], STEP_S);
    assert!(named(&without).iter().all(|(kind, _)| kind != "grease"));
    assert!(without.diagnosis.gap.corrected > outcome.diagnosis.gap.corrected);
}

/// A machine with an effect of the catalogue, or none, and a model that holds a law: the law is not in the way.
#[test]
fn verify_a_law_that_does_not_act_is_not_named() {
    let model = model();
    let clean = diagnosed_as(&model, &[], &[], STEP_S);
    assert_eq!(named(&clean), []);
    let cubic = Placed::new(
        find_of(&model, "cubic_stiffness").unwrap(),
        guide(),
        vec![3e7],
    );
    let outcome = diagnosed_as(&model, &[cubic], &[], STEP_S);
    assert_eq!(named(&outcome)[0], ("cubic_stiffness".to_string(), guide()));
    assert!(named(&outcome).iter().all(|(kind, _)| kind != "grease"));
}
