//! Scores of hand-made answers.
#![allow(clippy::unwrap_used)]

use std::collections::BTreeMap;

use simgap_blind::{
    Answer, Equivalent, Hidden, Level, Named, Outcome, Role, Score, Share, Status, Totals, Truth,
    render_calibration, render_confusion, render_figures, render_requirements,
};
use simgap_model::Location;

fn between(a: &str, b: &str) -> Location {
    Location::Between([a.into(), b.into()])
}

fn entry(kind: &str, at: Location) -> Hidden {
    Hidden {
        kind: kind.into(),
        at,
        parameters: BTreeMap::new(),
        of_record: vec![],
    }
}

/// One check record of one output, whose standard deviation is 1.
const SIGNAL: [f64; 4] = [1.0, -1.0, 1.0, -1.0];
/// What the nominal model predicts is off by this.
const NOMINAL_GAP: f64 = 0.2;

fn off_by(gap: f64) -> Vec<Vec<Vec<f64>>> {
    vec![vec![SIGNAL.map(|y| y + gap).to_vec()]]
}

fn case(status: Status, effects: Vec<Hidden>) -> Truth {
    Truth {
        status,
        level: Level::Standard,
        withheld: false,
        equivalents: vec![vec![]; effects.len()],
        gaps: vec![0.1; effects.len()],
        effects,
        deviations: vec![],
        noise_share: 0.01,
        signals: off_by(0.0),
    }
}

fn score(truth: &Truth, answer: &Answer) -> Score {
    simgap_blind::score("case-0001", truth, answer, Some(&off_by(0.002)))
}

fn friction() -> Truth {
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
        is_incomplete: false,
    }
}

/// States that 0.96 of the gap is closed; 0.95 is.
fn answer(status: Status, named: Vec<Named>) -> Answer {
    Answer {
        status,
        named,
        closed: 0.96,
        nominal: off_by(NOMINAL_GAP),
        corrected: off_by(0.05 * NOMINAL_GAP),
    }
}

fn outcome(case: &Truth, status: Status, named: Vec<Named>) -> Outcome {
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
    // What is stated is that one of the class is part of the cause.
    assert_eq!(score.stated, vec![(0.6, true)]);
    let first = score.first.unwrap();
    assert!(first.is_declared && !first.is_kind && !first.is_same);
    assert_eq!(first.set, 2);
}

#[test]
fn verify_equivalent_counts_as_right() {
    let mut case = case(
        Status::Effect,
        vec![entry("constant_force", Location::Mass("m1".into()))],
    );
    case.equivalents[0].push(Equivalent {
        kind: "sensor_bias".into(),
        at: Location::Channel("y1".into()),
        because: "the rest position shifts".into(),
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
    // Where parameters are off by a little, that may be said, and nothing else.
    let mut small = noise;
    small
        .deviations
        .push(entry("mass_error", Location::Mass("m1".into())));
    let mass = vec![named("mass_error", Location::Mass("m1".into()), 0.9)];
    assert_eq!(outcome(&small, Status::None, vec![]), Outcome::Quiet);
    assert_eq!(
        outcome(&small, Status::Parameters, mass.clone()),
        Outcome::Quiet
    );
    assert_eq!(outcome(&small, Status::Effect, said), Outcome::FalseAlarm);
    let exact = case(Status::None, vec![]);
    assert_eq!(
        outcome(&exact, Status::Parameters, mass),
        Outcome::FalseAlarm
    );
}

fn brake() -> Truth {
    let at = between("m1", "ground");
    case(Status::Unknown, vec![entry("foreign_eddy_brake", at)])
}

#[test]
fn verify_a_foreign_effect_is_unknown_or_has_the_nearest_name_of_an_incomplete_answer() {
    let foreign = brake();
    let said = |kind: &str, at, is_incomplete| {
        let named = named(kind, at, 0.5);
        vec![Named {
            is_incomplete,
            ..named
        }]
    };
    let member = || between("m1", "ground");
    assert_eq!(
        outcome(&foreign, Status::Unknown, vec![]),
        Outcome::HonestUnknown
    );
    assert_eq!(outcome(&foreign, Status::None, vec![]), Outcome::Missed);
    let mut good = answer(Status::Effect, said("stribeck_friction", member(), true));
    good.corrected = off_by(0.2 * NOMINAL_GAP);
    assert_eq!(score(&foreign, &good).outcome(), Outcome::Nearest);
    assert!(score(&foreign, &good).is_right());
    // Said to be complete; of another family.
    let wrong = [
        Answer {
            named: said("stribeck_friction", member(), false),
            ..good.clone()
        },
        Answer {
            named: said("sensor_lag", Location::Channel("y1".into()), true),
            ..good.clone()
        },
    ];
    for answer in wrong {
        assert_eq!(
            score(&foreign, &answer).outcome(),
            Outcome::Wrong,
            "{answer:?}"
        );
        assert_eq!(score(&foreign, &answer).stated, vec![(0.5, false)]);
    }
}

#[test]
fn verify_a_withheld_kind_may_go_by_another_name_of_the_same_law() {
    let truth = friction().with_kind_withheld();
    let mut good = answer(
        Status::Effect,
        vec![named("stribeck_friction", between("ground", "m1"), 0.9)],
    );
    good.corrected = off_by(0.01 * NOMINAL_GAP);
    let of_answer = |answer: &Answer| score(&truth, answer);
    assert_eq!(of_answer(&good).role, Role::Withheld);
    assert_eq!(of_answer(&good).outcome(), Outcome::Equivalent);
    good.named[0].kind = "quadratic_damping".into();
    assert_eq!(of_answer(&good).outcome(), Outcome::Wrong);
    assert_eq!(
        of_answer(&answer(Status::Unknown, vec![])).outcome(),
        Outcome::HonestUnknown
    );
}

/// An input gain that is not looked for, imitated by parameters that are off a little besides: an answer that says that more is left.
#[test]
fn verify_parameters_that_are_off_besides_may_be_the_nearest_name() {
    let member = || between("m1", "ground");
    let gain = entry("input_gain", Location::Input("u".into()));
    let mut truth = case(Status::Effect, vec![gain]).with_kind_withheld();
    truth.deviations.push(entry("stiffness_error", member()));
    let stiffness = named("stiffness_error", member(), 0.8);
    let mut told = answer(
        Status::Parameters,
        vec![Named {
            is_incomplete: true,
            ..stiffness
        }],
    );
    told.corrected = off_by(0.01 * NOMINAL_GAP);
    assert_eq!(score(&truth, &told).outcome(), Outcome::Nearest);
    told.named[0].is_incomplete = false;
    assert_eq!(score(&truth, &told).outcome(), Outcome::Wrong);
}

#[test]
fn verify_the_true_closing_is_against_the_truth_without_noise() {
    let said = vec![named("coulomb_friction", between("m1", "ground"), 0.9)];
    let closing = score(&friction(), &answer(Status::Effect, said))
        .closing
        .unwrap();
    assert_eq!(closing.stated, 0.96);
    assert!((closing.actual - 0.95).abs() < ROUNDING);
    assert!((closing.best - 0.99).abs() < ROUNDING);
    let nothing = score(&friction(), &Answer::nothing()).closing.unwrap();
    assert_eq!(nothing.actual, 0.0);
    assert!(
        score(&case(Status::None, vec![]), &Answer::nothing())
            .closing
            .is_none()
    );
}

fn pair() -> Truth {
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
    case.deviations
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
    let mut declared = named("stribeck_friction", at(), 0.95);
    declared
        .indistinguishable
        .push(("coulomb_friction".into(), at()));
    let mut undecided = declared.clone();
    for kind in ["hysteresis", "backlash"] {
        undecided.indistinguishable.push((kind.into(), at()));
    }
    vec![
        one(Status::Effect, vec![named("coulomb_friction", at(), 0.8)]),
        one(
            Status::Effect,
            vec![named("coulomb_friction", between("m2", "ground"), 0.6)],
        ),
        one(Status::Effect, vec![declared]),
        one(Status::Effect, vec![undecided]),
        one(Status::None, vec![]),
        score(
            &pair(),
            &answer(Status::Effect, vec![named("coulomb_friction", at(), 1.0)]),
        ),
        score(&noise, &answer(Status::None, vec![])),
        score(
            &noise,
            &answer(Status::Effect, vec![named("mass_error", at(), 1.0)]),
        ),
        score(&brake(), &answer(Status::Unknown, vec![])),
        score(&friction().with_kind_withheld(), &Answer::nothing()),
    ]
}

#[test]
fn verify_totals() {
    let totals = Totals::of(&campaign());
    let share = |hits, of| Share { hits, of };
    assert_eq!(totals.cases, 10);
    assert_eq!(totals.right, share(3, 10));
    assert_eq!(totals.first, share(2, 5));
    // The set of four kinds is too large to count.
    assert_eq!(totals.declared, share(3, 5));
    assert_eq!((totals.set_mean, totals.set_max), (2.0, 4));
    assert_eq!(totals.placed, share(1, 2));
    assert_eq!(
        (totals.exact, totals.small_errors),
        (share(1, 2), share(0, 0))
    );
    assert_eq!(
        (totals.foreign, totals.withheld),
        (share(1, 1), share(0, 1))
    );
    assert_eq!((totals.pairs, totals.of_pairs), (share(0, 1), share(1, 2)));
    // Stated 0.96, true 0.95; nothing answered is nothing stated and nothing closed.
    assert_eq!(totals.stated, share(8, 8));
    assert!((totals.closing.median - 0.95).abs() < ROUNDING);
    assert!((totals.of_best.median - 0.95 / 0.99).abs() < ROUNDING);
    // The class of two holds the truth, that of four is too large to count.
    let brier = (0.04 + 0.36 + 0.0025 + 0.9025 + 0.0 + 1.0) / 6.0;
    assert!((totals.brier - brier).abs() < ROUNDING, "{}", totals.brier);
    let counts: Vec<usize> = totals.calibration.iter().map(|bin| bin.count).collect();
    assert_eq!(counts, vec![0, 0, 1, 1, 2, 2]);
    let row = &totals.confusion["coulomb_friction"];
    assert_eq!((row["stribeck_friction"], row["(nothing)"]), (2, 1));
}

#[test]
fn regress_tables() {
    let scores = campaign();
    let hard: Vec<Score> = scores[..3].to_vec();
    let (standard, hard) = (Totals::of(&scores), Totals::of(&hard));
    let tables = [
        render_requirements(&standard, &hard),
        render_figures(&standard),
        render_calibration(&standard),
        render_confusion(&standard),
    ];
    insta::assert_snapshot!(tables.join("\n"));
}
