//! Scores of hand-made answers.
#![allow(clippy::unwrap_used)]

use std::collections::BTreeMap;

use simgap_blind::{
    Answer, Case, Equivalent, Named, Outcome, Score, Status, Style, Totals, Truth, render, score,
};
use simgap_model::{EffectEntry, Location, Model};

fn between(a: &str, b: &str) -> Location {
    Location::Between([a.into(), b.into()])
}

fn entry(kind: &str, at: Location) -> EffectEntry {
    EffectEntry {
        kind: kind.into(),
        at,
        parameters: BTreeMap::new(),
    }
}

fn case(status: Status, effects: Vec<EffectEntry>) -> Case {
    Case {
        name: "case-0001".into(),
        model: Model::default(),
        train: vec![],
        check: vec![],
        truth: Truth {
            status,
            equivalents: vec![vec![]; effects.len()],
            gaps: vec![0.1; effects.len()],
            effects,
            deviations: vec![],
            noise_share: 0.01,
            closable: true,
        },
    }
}

fn friction() -> Case {
    case(
        Status::Effect,
        vec![entry("coulomb_friction", between("m1", "ground"))],
    )
}

fn named(kind: &str, at: Location, probability: f64) -> Named {
    Named {
        kind: kind.into(),
        at,
        probability,
        indistinguishable: vec![],
    }
}

fn answer(status: Status, named: Vec<Named>) -> Answer {
    Answer {
        status,
        named,
        closed: 0.9,
    }
}

fn outcome(case: &Case, status: Status, named: Vec<Named>) -> Outcome {
    score(case, &answer(status, named)).outcome()
}

#[test]
fn verify_right_whichever_way_round_the_pair_is_written() {
    for at in [between("m1", "ground"), between("ground", "m1")] {
        let said = vec![named("coulomb_friction", at, 0.9)];
        let score = score(&friction(), &answer(Status::Effect, said));
        assert_eq!(score.outcome(), Outcome::Right);
        assert!(score.is_right());
        assert_eq!(score.verdicts[0].probability, 0.9);
        assert_eq!(score.stated, vec![(0.9, true)]);
    }
}

#[test]
fn verify_wrong_place_wrong_kind_missed_and_unknown() {
    let case = friction();
    let elsewhere = named("coulomb_friction", between("m2", "ground"), 0.6);
    let other = named("quadratic_damping", between("m1", "ground"), 0.6);
    assert_eq!(
        outcome(&case, Status::Effect, vec![elsewhere]),
        Outcome::WrongPlace
    );
    assert_eq!(
        outcome(&case, Status::Effect, vec![other.clone()]),
        Outcome::Wrong
    );
    assert_eq!(outcome(&case, Status::None, vec![]), Outcome::Missed);
    // What an answer of `unknown` or `none` lists is not named.
    assert_eq!(
        outcome(&case, Status::Unknown, vec![other.clone()]),
        Outcome::CalledUnknown
    );
    assert_eq!(outcome(&case, Status::None, vec![other]), Outcome::Missed);
}

#[test]
fn verify_truth_among_the_rivals() {
    let mut said = named("stribeck_friction", between("m1", "ground"), 0.6);
    said.indistinguishable
        .push(("coulomb_friction".into(), between("ground", "m1")));
    let score = score(&friction(), &answer(Status::Effect, vec![said]));
    assert_eq!(score.outcome(), Outcome::AmongRivals);
    assert!(!score.is_right());
    assert_eq!(score.rivals, vec![1]);
    assert_eq!(score.stated, vec![(0.6, false)]);
}

#[test]
fn verify_equivalent_counts_as_right() {
    let mut case = case(
        Status::Effect,
        vec![entry("constant_force", Location::Mass("m1".into()))],
    );
    case.truth.equivalents[0].push(Equivalent {
        kind: "sensor_bias".into(),
        at: Location::Channel("y1".into()),
        because: "the rest position shifts",
    });
    let said = vec![named("sensor_bias", Location::Channel("y1".into()), 0.5)];
    let score = score(&case, &answer(Status::Effect, said));
    assert_eq!(score.outcome(), Outcome::Equivalent);
    assert!(score.is_right());
    assert_eq!(score.verdicts[0].probability, 0.5);
}

#[test]
fn verify_noise_and_foreign() {
    let noise = case(Status::None, vec![]);
    let said = vec![named("sensor_bias", Location::Channel("y1".into()), 0.5)];
    assert_eq!(outcome(&noise, Status::None, vec![]), Outcome::Quiet);
    assert_eq!(
        outcome(&noise, Status::Effect, said.clone()),
        Outcome::FalseAlarm
    );
    assert_eq!(
        outcome(&noise, Status::Unknown, vec![]),
        Outcome::FalseAlarm
    );
    let foreign = case(
        Status::Unknown,
        vec![entry("foreign_eddy_brake", between("m1", "ground"))],
    );
    assert_eq!(
        outcome(&foreign, Status::Unknown, vec![]),
        Outcome::HonestUnknown
    );
    assert_eq!(outcome(&foreign, Status::None, vec![]), Outcome::Missed);
    let score = score(&foreign, &answer(Status::Effect, said));
    assert_eq!(score.outcome(), Outcome::Wrong);
    assert_eq!(score.stated, vec![(0.5, false)]);
}

fn pair() -> Case {
    case(
        Status::Effect,
        vec![
            entry("coulomb_friction", between("m1", "ground")),
            entry("sensor_gain", Location::Channel("y1".into())),
        ],
    )
}

#[test]
fn verify_half_a_pair_is_missed_not_wrong() {
    let said = vec![named("coulomb_friction", between("m1", "ground"), 0.9)];
    let score = score(&pair(), &answer(Status::Effect, said));
    let outcomes: Vec<Outcome> = score.verdicts.iter().map(|v| v.outcome).collect();
    assert_eq!(outcomes, vec![Outcome::Right, Outcome::Missed]);
    assert!(score.extra.is_empty() && !score.is_right());
}

#[test]
fn verify_an_effect_too_many_spoils_the_answer_but_not_the_name() {
    let said = vec![
        named("coulomb_friction", between("m1", "ground"), 0.9),
        named("mass_error", Location::Mass("m1".into()), 0.7),
    ];
    let answer = answer(Status::Effect, said);
    let score1 = score(&friction(), &answer);
    assert_eq!(score1.outcome(), Outcome::Right);
    assert_eq!(score1.extra, vec!["mass_error mass m1"]);
    assert!(!score1.is_right());
    // Where the mass is off by a little, naming it is no mistake.
    let mut case = friction();
    case.truth
        .deviations
        .push(entry("mass_error", Location::Mass("m1".into())));
    let score2 = score(&case, &answer);
    assert!(score2.is_right() && score2.extra.is_empty());
    assert_eq!(score2.stated, vec![(0.9, true)]);
}

/// Sums of a few exact decimals.
const ROUNDING: f64 = 1e-12;

fn campaign() -> Vec<Score> {
    let at = || between("m1", "ground");
    let one = |status, named| score(&friction(), &answer(status, named));
    let noise = case(Status::None, vec![]);
    vec![
        one(Status::Effect, vec![named("coulomb_friction", at(), 0.8)]),
        one(
            Status::Effect,
            vec![named("coulomb_friction", between("m2", "ground"), 0.6)],
        ),
        one(Status::Effect, vec![named("quadratic_damping", at(), 0.95)]),
        one(Status::None, vec![]),
        score(&noise, &answer(Status::None, vec![])),
        score(
            &noise,
            &answer(Status::Effect, vec![named("mass_error", at(), 1.0)]),
        ),
    ]
}

#[test]
fn verify_totals() {
    let totals = Totals::of(&campaign());
    assert_eq!(
        (
            totals.cases,
            totals.effects,
            totals.quiet_cases,
            totals.foreign_cases
        ),
        (6, 4, 2, 0)
    );
    let expected = [
        (totals.right, 2.0 / 6.0),
        (totals.placed, 0.25),
        (totals.named, 0.5),
        (totals.wrong, 0.25),
        (totals.missed, 0.25),
        (totals.truth_probability, 0.2),
        (totals.false_alarms, 0.5),
        (totals.extra, 0.5),
        (totals.brier, (0.04 + 0.36 + 0.9025 + 1.0) / 4.0),
        (totals.rivals, 0.0),
    ];
    for (i, (found, wanted)) in expected.iter().enumerate() {
        assert!((found - wanted).abs() < ROUNDING, "{i}: {found} {wanted}");
    }
    assert!(totals.honest_unknown.is_nan());
    let counts: Vec<usize> = totals.calibration.iter().map(|bin| bin.count).collect();
    assert_eq!(counts, vec![0, 0, 1, 1, 1, 1]);
    assert_eq!(totals.calibration[3].right, 1.0);
    assert_eq!(totals.calibration[3].stated, 0.8);
    let row = &totals.kinds["coulomb_friction"];
    assert_eq!(row.outcomes[&Outcome::Right], 1);
    assert_eq!(row.said["quadratic_damping"], 1);
    assert_eq!(row.said["(nothing)"], 1);
}

#[test]
fn regress_tables() {
    let totals = Totals::of(&campaign());
    insta::assert_snapshot!("text", render(&totals, Style::Text));
    insta::assert_snapshot!("markdown", render(&totals, Style::Markdown));
}
