//! A sealed truth is the one that was sealed.
#![allow(clippy::unwrap_used, clippy::panic)]

use std::collections::BTreeMap;

use simgap_blind::{BlindError, Level, Recipe, SealedCase, generate, open, seal, sha256};

fn cases() -> Vec<SealedCase> {
    // A clock gives every record a phase of its own.
    ["sensor_bias", "tone_pickup"]
        .iter()
        .enumerate()
        .map(|(number, kind)| {
            let recipe = Recipe::Kind((*kind).to_string());
            let case = generate(2, number, &recipe, Level::Standard).unwrap();
            let files = BTreeMap::from([("model.toml".to_string(), sha256(b"text"))]);
            SealedCase {
                name: case.name,
                files,
                truth: case.truth,
            }
        })
        .collect()
}

#[test]
fn verify_a_truth_comes_out_as_it_went_in() {
    let cases = cases();
    let text = seal(&cases).unwrap();
    let opened = open(&text, &sha256(text.as_bytes())).unwrap();
    for (before, after) in cases.iter().zip(&opened) {
        // Not a word of them on a screen.
        assert!(before == after, "{}", before.name);
        assert!(!after.truth.signals[0][0].is_empty());
    }
    assert_eq!(opened[1].truth.effects[0].of_record.len(), 3);
}

#[test]
fn verify_a_changed_truth_breaks_the_seal() {
    let text = seal(&cases()).unwrap();
    let digest = sha256(text.as_bytes());
    let changed = text.replacen("sensor_bias", "sensor_gain", 1);
    assert_ne!(changed, text);
    let Err(BlindError::BrokenSeal { found, needed }) = open(&changed, &digest) else {
        panic!("the seal holds");
    };
    assert_eq!(found, sha256(changed.as_bytes()));
    assert_eq!(needed, digest);
}

#[test]
fn verify_sha256_of_the_standard() {
    // FIPS 180-4, examples of one block and of none.
    let abc = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
    let nothing = "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855";
    assert_eq!(sha256(b"abc"), abc);
    assert_eq!(sha256(b""), nothing);
}
