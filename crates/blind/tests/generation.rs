//! Generated cases: the same bits again, gaps as promised, nothing given away.
#![allow(clippy::unwrap_used)]

use simgap_blind::{
    GAP_OVER_NOISE, LARGEST_GAP, Recipe, SMALLEST_GAP, Status, foreign_effects, generate, schedule,
};
use simgap_effects::{Placed, catalogue};

const SEED: u64 = 5;

#[test]
fn verify_same_arguments_give_the_same_case() {
    let recipe = Recipe::Kind("coulomb_friction".into());
    let (once, again) = (
        generate(SEED, 4, &recipe).unwrap(),
        generate(SEED, 4, &recipe).unwrap(),
    );
    assert_eq!(once.train, again.train);
    assert_eq!(once.check, again.check);
    assert_eq!(once.model, again.model);
    let other = generate(SEED + 1, 4, &recipe).unwrap();
    assert_ne!(once.train, other.train);
}

#[test]
fn verify_every_recipe_makes_a_case_with_the_promised_gap() {
    for (number, recipe) in schedule(SEED, 12, &[]).unwrap().iter().enumerate() {
        let case = generate(SEED, number, recipe).unwrap();
        let truth = &case.truth;
        case.model.check().unwrap();
        assert_eq!((case.train.len(), case.check.len()), (2, 1));
        for record in case.train.iter().chain(&case.check) {
            assert!((1000..=6000).contains(&record.len()));
        }
        let smallest = SMALLEST_GAP.max(GAP_OVER_NOISE * truth.noise_share);
        assert_eq!(truth.gaps.len(), truth.effects.len());
        for gap in &truth.gaps {
            assert!(*gap >= smallest, "{recipe}: {gap} {smallest}");
            assert!(truth.status == Status::Parameters || *gap <= LARGEST_GAP);
        }
        match recipe {
            Recipe::Noise => assert_eq!(truth.status, Status::None),
            Recipe::Foreign(_) => assert_eq!(truth.status, Status::Unknown),
            Recipe::TwoParameters => assert_eq!(truth.effects.len(), 2),
            _ => {
                assert!(truth.closable);
                // A corrected model file could say it.
                for entry in &truth.effects {
                    Placed::from_entry(&case.model, entry).unwrap();
                }
            }
        }
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
        let case = generate(SEED + 1, number, recipe).unwrap();
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
