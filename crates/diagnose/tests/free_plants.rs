//! Plants without a spring to the ground: noise of the drive leads them away, and what a sensor adds is as slow as they are.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use crate::common::{diagnosed, diagnosed_as, diagnosed_with_noise, ground, named, placed};
use simgap_diagnose::Status;
use simgap_model::{Location, Model};

/// A slide whose drive is measured with noise.
const SLIDE: &str = r#"schema = "simgap-model/1"
name = "slide"
[[mass]]
name = "base"
value = 1.7
[[damper]]
name = "c"
between = ["base", "ground"]
damping = 2.2
[[input]]
channel = "u"
kind = "force"
at = "base"
[[output]]
channel = "x"
kind = "displacement"
at = "base"
"#;
const NOISE_OF_DRIVE: f64 = 0.04;

fn slide() -> Model {
    Model::from_toml(SLIDE).unwrap()
}

/// Over a record the noise of the drive moves the true model by a multiple of the noise of the sensor, and a spring would hold
/// it. There is none.
#[test]
fn verify_nothing_is_blamed_for_the_way_that_noise_leads_a_slide() {
    let outcome = diagnosed_with_noise(&slide(), &[], &[], 4e-3, NOISE_OF_DRIVE);
    let verdict = &outcome.diagnosis.verdict;
    assert!(
        matches!(verdict.status, Status::None | Status::Parameters),
        "{verdict:?}"
    );
    let gap = &outcome.diagnosis.gap;
    assert!(gap.input_noise > 4.0 * gap.noise_floor, "{gap:?}");
    let notes = &outcome.diagnosis.notes;
    assert!(
        notes
            .iter()
            .any(|note| note.contains("leads this plant away")),
        "{notes:?}"
    );
}

/// A plant that springs hold is judged by its residuals as they are.
#[test]
fn verify_a_plant_on_springs_is_not_led_away() {
    let notes = diagnosed(&[], &[]).diagnosis.notes;
    assert!(
        notes
            .iter()
            .all(|note| !note.contains("leads this plant away")),
        "{notes:?}"
    );
}

/// What every sample adds to those before it shows a delay, to a part of a sample.
#[test]
fn verify_a_delay_is_found_on_a_slide_that_noise_leads_away() {
    let channel = Location::Channel("x".into());
    let delay = [placed("sensor_delay", channel, &[0.0123])];
    let outcome = diagnosed_with_noise(&slide(), &delay, &[], 4e-3, NOISE_OF_DRIVE);
    let verdict = &outcome.diagnosis.verdict;
    let [effect] = &verdict.effects[..] else {
        panic!("{verdict:?}");
    };
    // With one input and one output it is late in either.
    assert!(effect.kind.ends_with("_delay"), "{effect:?}");
    let found = effect.parameters[0].value;
    assert!((found - 0.0123).abs() < 5e-4, "{found}");
}

/// A coupled pair of rotors whose speeds are measured, one of them by a sensor that drifts: as slow as the rotors themselves, it
/// counts as next to no sample, and a drift of the other sensor gains as little.
#[test]
fn verify_a_drift_is_found_in_the_channel_that_hardly_counts() {
    let text = r#"schema = "simgap-model/1"
name = "rotors"
[[mass]]
name = "base"
value = 0.18
[[mass]]
name = "gear"
value = 0.22
[[spring]]
name = "k"
between = ["gear", "base"]
stiffness = 12600.0
[[damper]]
name = "c1"
between = ["gear", "base"]
damping = 2.1
[[damper]]
name = "c2"
between = ["base", "ground"]
damping = 0.09
[[input]]
channel = "u"
kind = "force"
at = "base"
[[output]]
channel = "v1"
kind = "velocity"
at = "base"
[[output]]
channel = "v2"
kind = "velocity"
at = "gear"
[[output]]
channel = "f"
kind = "force"
between = ["gear", "base"]
"#;
    let model = Model::from_toml(text).unwrap();
    let at = Location::Channel("v1".into());
    let truth = [
        placed("sensor_drift", at.clone(), &[-0.9]),
        placed(
            "stiffness_error",
            Location::Between(["gear".into(), "base".into()]),
            &[0.985],
        ),
        placed("damping_error", ground(), &[1.03]),
    ];
    let outcome = diagnosed_as(&model, &truth, &[], 2e-3);
    assert_eq!(named(&outcome), [("sensor_drift".to_string(), at)]);
}

/// A pendulum hangs from a heavy frame that swings on and hardly dies away: the beat of its free decay is told as the frame, though a force
/// at one frequency leaves a few per cent of the gap.
#[test]
fn verify_the_beat_of_a_free_decay_is_a_hidden_mode() {
    let text = r#"schema = "simgap-model/1"
name = "pendulum"
[[mass]]
name = "base"
value = 2.0
[[spring]]
name = "k"
between = ["base", "ground"]
stiffness = 808.0
[[damper]]
name = "c"
between = ["base", "ground"]
damping = 0.5
[[output]]
channel = "x"
kind = "displacement"
at = "base"
"#;
    let frame = [24_250.0, 47.6, 3e-4, 0.01, 0.0];
    let frame = [placed("flexible_support", ground(), &frame)];
    let outcome = diagnosed_as(&Model::from_toml(text).unwrap(), &frame, &[], 8e-3);
    let verdict = &outcome.diagnosis.verdict;
    let first = verdict
        .effects
        .first()
        .unwrap_or_else(|| panic!("{verdict:?}"));
    assert_eq!(first.kind, "flexible_support", "{verdict:?}");
    assert!(
        outcome.diagnosis.gap.corrected < 0.02,
        "{:?}",
        outcome.diagnosis.gap
    );
}
