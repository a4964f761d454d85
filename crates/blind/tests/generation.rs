//! Generated cases: the same bits again, gaps as promised, nothing given away.
#![allow(clippy::unwrap_used, clippy::panic)]

use simgap_blind::{Level, Recipe, Status, foreign_effects, generate, schedule};
use simgap_effects::{Effect, SiteKind, catalogue};

const SEED: u64 = 5;

#[test]
fn verify_same_arguments_give_the_same_case() {
    let recipe = Recipe::Kind("coulomb_friction".into());
    let (once, again) = (
        generate(SEED, 4, &recipe, Level::Standard).unwrap(),
        generate(SEED, 4, &recipe, Level::Standard).unwrap(),
    );
    assert_eq!(once.train, again.train);
    assert_eq!(once.check, again.check);
    assert_eq!(once.model, again.model);
    assert_eq!(once.truth, again.truth);
    for (seed, level) in [(SEED + 1, Level::Standard), (SEED, Level::Hard)] {
        let other = generate(seed, 4, &recipe, level).unwrap();
        assert_ne!(once.train, other.train);
    }
}

/// What a case of a level must hold.
fn check_case(number: usize, recipe: &Recipe, level: Level) {
    let case = generate(SEED, number, recipe, level).unwrap();
    let truth = &case.truth;
    case.model.check().unwrap();
    assert_eq!((case.train.len(), case.check.len()), (2, 1));
    for record in case.train.iter().chain(&case.check) {
        assert!((1000..=6000).contains(&record.len()));
    }
    let [quietest, loudest] = level.noise_share();
    assert!((quietest..=loudest).contains(&truth.noise_share));
    let [smallest, largest] = level.gap();
    assert_eq!(truth.gaps.len(), truth.effects.len());
    for gap in &truth.gaps {
        assert!((smallest..=largest).contains(gap), "{recipe}: {gap}");
    }
    let outputs = case.model.outputs.len();
    assert_eq!(truth.signals[0].len(), outputs);
    assert!(
        truth.signals[0]
            .iter()
            .all(|y| y.len() == case.check[0].len())
    );
    for deviation in &truth.deviations {
        let [factor] = deviation.placed().unwrap().values[..] else {
            panic!("{deviation:?}");
        };
        assert!((factor - 1.0).abs() <= level.tolerance());
    }
    assert_eq!(truth.deviations.is_empty(), *recipe == Recipe::Noise);
    for effect in &truth.effects {
        assert_eq!(effect.placed().unwrap().effect.kind(), effect.kind);
    }
    let expected = match recipe {
        Recipe::Noise | Recipe::SmallErrors => (Status::None, 0),
        Recipe::Foreign(_) => (Status::Unknown, 1),
        Recipe::TwoParameters => (Status::Parameters, 2),
        Recipe::Pair(..) => (Status::Effect, 2),
        Recipe::Kind(_) => (truth.status, 1),
    };
    assert_eq!((truth.status, truth.effects.len()), expected);
}

/// Kinds that a machine may have: no machine is drawn that is a simulator of someone else's.
fn drawn() -> impl Iterator<Item = &'static &'static dyn Effect> {
    catalogue()
        .iter()
        .filter(|effect| effect.site() != SiteKind::Parameter)
}

#[test]
fn verify_every_kind_of_the_catalogue_can_be_drawn() {
    for (number, effect) in drawn().enumerate() {
        let recipe = Recipe::Kind(effect.kind().to_string());
        check_case(number, &recipe, Level::Standard);
    }
}

/// One in four: the others differ in nothing that the level touches.
#[test]
fn verify_kinds_can_be_drawn_with_small_gaps_and_much_noise() {
    for (number, effect) in drawn().enumerate().step_by(4) {
        // On the few plants with a pendulum other parameters that are 5 % off hide a small error of its torque.
        if effect.kind() == "pendulum_error" {
            continue;
        }
        let recipe = Recipe::Kind(effect.kind().to_string());
        check_case(number, &recipe, Level::Hard);
    }
}

#[test]
fn verify_every_other_recipe_makes_a_case() {
    let mut recipes = vec![Recipe::Noise, Recipe::SmallErrors, Recipe::TwoParameters];
    recipes.push(Recipe::Pair(
        "coulomb_friction".into(),
        "sensor_delay".into(),
    ));
    let foreign = foreign_effects().into_iter();
    recipes.extend(foreign.map(|effect| Recipe::Foreign(effect.kind().to_string())));
    for (number, recipe) in recipes.iter().enumerate() {
        check_case(100 + number, recipe, Level::Standard);
    }
}

#[test]
fn verify_nothing_is_given_away() {
    let foreign = foreign_effects();
    let words: Vec<&str> = catalogue()
        .iter()
        .chain(&foreign)
        .flat_map(|effect| effect.kind().split('_'))
        .filter(|word| *word != "foreign" && word.len() > 3)
        .collect();
    for (number, recipe) in schedule(SEED + 1, 6, &[]).unwrap().iter().enumerate() {
        let case = generate(SEED + 1, number, recipe, Level::Standard).unwrap();
        assert_eq!(case.name, format!("case-{number:04}"));
        assert!(case.model.effects.is_empty());
        let records = case.train.iter().chain(&case.check);
        for (record, letter) in records.zip(["a", "b", "c"]) {
            assert_eq!(record.name(), format!("{}-{letter}.csv", case.name));
            let mut expected: Vec<&str> = vec![];
            expected.extend(case.model.inputs.iter().map(|i| i.channel.as_str()));
            expected.extend(case.model.outputs.iter().map(|o| o.channel.as_str()));
            let found: Vec<&str> = record.channels().iter().map(|c| c.name.as_str()).collect();
            assert_eq!(found, expected);
            assert!(
                found
                    .iter()
                    .all(|name| !words.iter().any(|w| name.contains(w)))
            );
        }
    }
}
