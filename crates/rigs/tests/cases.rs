//! Cases as a whole.
#![allow(clippy::unwrap_used)]

use simgap_rigs::{Answer, Filter, Role, draw_case, score};

fn filter(role: Role) -> Filter {
    Filter {
        role: Some(role),
        kind: None,
    }
}

#[test]
fn verify_equal_seeds_give_equal_bytes() {
    let draw = |seed| draw_case(seed, 3, &filter(Role::Single)).unwrap();
    let (a, b, c) = (draw(5), draw(5), draw(6));
    assert_eq!(a.files, b.files);
    assert_eq!(a.truth, b.truth);
    assert_ne!(a.files, c.files);
}

#[test]
fn verify_a_case_has_a_model_training_records_and_a_check_record() {
    let case = draw_case(5, 1, &filter(Role::Parameters)).unwrap();
    let names: Vec<&str> = case.files.iter().map(|f| f.0.as_str()).collect();
    assert!(names.starts_with(&["model.toml", "train-1.csv", "train-2.csv"]));
    assert_eq!(names.last(), Some(&"check.csv"));
    assert!(case.truth.gap >= 0.03, "{}", case.truth.gap);
    // No file tells the cause.
    assert!(case.files.iter().all(|f| !f.1.contains("error")));
}

#[test]
fn verify_a_mixed_case_has_a_main_cause_and_smaller_ones() {
    for number in 1..=3 {
        let case = draw_case(5, number, &filter(Role::Mixed)).unwrap();
        let truth = &case.truth;
        assert_eq!(truth.status, "effect");
        assert!((3..=4).contains(&(truth.effects.len() + truth.foreign.len())));
        // The first is the main one: the others leave little of the gap of all.
        let check = case.bench.setups.len() - 1;
        let free = case.bench.free_responses(check);
        let largest = |effects: &[simgap_rigs::effect::Effect], whole: bool| {
            let mut bench = case.bench.clone();
            if !whole {
                bench.plant = bench.without.clone();
            }
            let gaps = bench.gap(effects, check, &free).unwrap();
            gaps.into_iter().fold(0.0, f64::max)
        };
        assert_eq!(truth.effects[0].kind, case.effects[0].kind);
        let main = largest(&case.effects[..1], true);
        for small in &case.effects[1..] {
            assert!(largest(std::slice::from_ref(small), false) <= 0.4 * main);
        }
    }
}

fn answered(text: &str) -> Answer {
    Answer {
        diagnosis: Some(serde_json::from_str(text).unwrap()),
        failure: String::new(),
        seconds: 1.0,
    }
}

#[test]
fn verify_the_score_of_a_single_effect() {
    let truth = draw_case(
        5,
        1,
        &Filter {
            role: None,
            kind: Some("coulomb_friction"),
        },
    )
    .unwrap()
    .truth;
    let at = truth.effects[0].at.to_string();
    let say = |kind: &str, other: &str| {
        answered(&format!(
            r#"{{"verdict": {{"status": "effect", "effects": [{{"kind": "{kind}", "at": {at},
            "probability": 0.95, "indistinguishable": [{{"kind": "{other}", "at": {at}}}]}}]}}}}"#
        ))
    };
    let one = |answer: Answer| score(&[(truth.clone(), answer)]);
    let right = one(say("coulomb_friction", "backlash"));
    assert!(right.cases[0].right && right.cases[0].declared);
    assert_eq!(right.sure, (1, 0));
    assert!((right.calibration_error - 0.05).abs() < 1e-12);
    let declared = one(say("quadratic_damping", "coulomb_friction"));
    assert!(!declared.cases[0].right && declared.cases[0].declared);
    let wrong = one(say("quadratic_damping", "backlash"));
    assert!(!wrong.cases[0].declared);
    assert_eq!(wrong.sure, (1, 1));
    let silent = one(answered(r#"{"verdict": {"status": "none"}}"#));
    assert!(!silent.cases[0].right && silent.cases[0].statements.is_empty());
}
