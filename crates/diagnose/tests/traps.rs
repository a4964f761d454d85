//! What users of grey-box tools have been misled by, each on records made for it.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use crate::common::{self, diagnosed, diagnosed_as, diagnosed_with_noise, ground, named, placed};
use simgap_diagnose::Status;
use simgap_model::{Location, Model};

/// Sampling interval where all that is known is searched and nothing fits, which takes longest: the lines of the drive are
/// below a quarter of its rate.
const COARSE_S: f64 = 8e-3;

fn channel(name: &str) -> Location {
    Location::Channel(name.into())
}

/// An input that is silent can be wrong in any way without a trace: nothing at it may be named, or hold
/// any probability, or bring a figure that is no number.
#[test]
fn verify_a_candidate_that_changes_nothing_is_no_candidate() {
    let truth = [placed("cubic_stiffness", ground(), &[2e7])];
    let outcome = diagnosed_as(&common::plant(), &truth, &[], COARSE_S);
    assert_eq!(named(&outcome), [("cubic_stiffness".into(), ground())]);
    let spare = Location::Input("spare".into());
    for candidate in &outcome.diagnosis.candidates {
        assert!(candidate.held_back_gap.is_finite(), "{}", candidate.kind);
        assert!(candidate.at != spare || candidate.probability == 0.0);
    }
    let effects = &outcome.diagnosis.verdict.effects;
    let intervals = effects.iter().flat_map(|effect| &effect.parameters);
    for end in intervals.flat_map(|parameter| parameter.ci95) {
        assert!(end.is_finite(), "{effects:?}");
    }
}

#[test]
fn verify_a_delay_is_put_on_the_channel_that_is_late() {
    for (name, other) in [("x", "a"), ("a", "x")] {
        let truth = [placed("sensor_delay", channel(name), &[0.0031])];
        let outcome = diagnosed(&truth, &[]);
        let found = named(&outcome);
        assert_eq!(found, [("sensor_delay".to_string(), channel(name))]);
        let effect = &outcome.diagnosis.verdict.effects[0];
        let delay = effect.parameters[0].value;
        assert!((delay - 0.0031).abs() < 2e-4, "{delay}");
        let rivals = effect.indistinguishable.iter();
        let wrong = rivals.filter(|rival| rival.at == channel(other)).count();
        assert_eq!(wrong, 0, "the other channel is no rival");
    }
}

#[test]
fn verify_a_hidden_mode_is_not_taken_for_delay_and_damping() {
    let at = Location::Mass("base".into());
    let truth = [placed(
        "attached_mode",
        at.clone(),
        &[0.25, 9.0, 0.03, 0.0, 0.0],
    )];
    let outcome = diagnosed(&truth, &[]);
    assert_eq!(named(&outcome), [("attached_mode".into(), at)]);
    let values = &outcome.diagnosis.verdict.effects[0].parameters;
    assert!((values[0].value / 0.25 - 1.0).abs() < 0.05, "{values:?}");
    assert!((values[1].value / 9.0 - 1.0).abs() < 0.01, "{values:?}");
    let gap = &outcome.diagnosis.gap;
    assert!(gap.corrected < 1.1 * gap.noise_floor, "{gap:?}");
}

/// What a hidden mode shows is asked with the weights that it was fitted with: once its rivals are weighed anew, a sensor's
/// bias beside it must not cost it its place.
#[test]
fn verify_a_hidden_mode_keeps_its_place_beside_a_bias() {
    let at = Location::Mass("base".into());
    let mode = placed("attached_mode", at.clone(), &[0.25, 9.0, 0.03, 0.0, 0.0]);
    let bias = placed("sensor_bias", channel("x"), &[-2e-3]);
    let outcome = diagnosed(&[mode, bias], &[]);
    let found = named(&outcome);
    assert!(found.contains(&("attached_mode".into(), at)), "{found:?}");
    // A constant force on the mass above does the same to both channels.
    assert_eq!(found.len(), 2, "{found:?}");
    let gap = &outcome.diagnosis.gap;
    assert!(gap.corrected < 1.1 * gap.noise_floor, "{gap:?}");
}

/// A gain can be swallowed by masses, stiffnesses and dampings together. They stay where they are.
#[test]
fn verify_a_gain_is_not_swallowed_by_parameters() {
    let truth = [placed("sensor_gain", channel("x"), &[1.06])];
    let outcome = diagnosed(&truth, &[]);
    assert_eq!(named(&outcome), [("sensor_gain".into(), channel("x"))]);
    let gain = outcome.diagnosis.verdict.effects[0].parameters[0].value;
    assert!((gain - 1.06).abs() < 0.01, "{gain}");
    let nominal = common::plant();
    let masses = nominal.masses.iter().zip(&outcome.corrected.masses);
    for (given, found) in masses {
        assert!((found.value / given.value - 1.0).abs() < 0.02);
    }
}

/// With the true law out of the catalogue a familiar one may fit well. It is not named as if it were
/// the cause.
#[test]
fn verify_a_wrong_law_that_fits_is_told_as_such() {
    let truth = [placed("quadratic_damping", ground(), &[250.0])];
    let known = diagnosed(&truth, &[]);
    assert_eq!(named(&known), [("quadratic_damping".into(), ground())]);
    let outcome = diagnosed_as(&common::plant(), &truth, &["quadratic_damping"], COARSE_S);
    let verdict = &outcome.diagnosis.verdict;
    let honest = verdict.status == Status::Unknown || !verdict.complete;
    assert!(honest, "{verdict:?}");
}

/// A support that gives way is a softer spring and a weaker damper as long as its own mode is not excited.
#[test]
fn verify_a_support_is_not_taken_for_two_parameters() {
    let values = [40_000.0, 0.9, 0.05, 0.0, 0.0];
    let truth = [placed("flexible_support", ground(), &values)];
    let outcome = diagnosed(&truth, &[]);
    assert_eq!(named(&outcome), [("flexible_support".into(), ground())]);
    let found = outcome.diagnosis.verdict.effects[0].parameters[0].value;
    assert!((found / values[0] - 1.0).abs() < 0.2, "{found}");
}

/// A weak spring that the model lacks is a little more of every other spring, and a little more of the input: within
/// what is known of them these leave hardly anything for it.
#[test]
fn verify_a_weak_spring_is_not_put_down_to_what_is_known() {
    let at = Location::Between(["top".into(), "ground".into()]);
    let between = Location::Between(["top".into(), "base".into()]);
    for stiffness in [16.0, -16.0] {
        let truth = [
            placed("linear_stiffness", at.clone(), &[stiffness]),
            placed("stiffness_error", ground(), &[0.99]),
            placed("stiffness_error", between.clone(), &[1.008]),
        ];
        let outcome = diagnosed_as(&common::plant(), &truth, &[], 2e-3);
        assert_eq!(named(&outcome), [("linear_stiffness".into(), at.clone())]);
    }
}

/// A mass on a spring that no record shows swinging is as good as a heavier mass, and has more to say for itself.
#[test]
fn verify_a_heavier_mass_is_not_taken_for_one_on_a_spring() {
    for (mass, factor) in [("base", 1.08), ("top", 1.2)] {
        let at = Location::Mass(mass.into());
        let outcome = diagnosed(&[placed("mass_error", at.clone(), &[factor])], &[]);
        assert_eq!(named(&outcome), [("mass_error".into(), at)]);
    }
}

/// A spring that is gone and a stop on either side are play. Where play is not looked for, they are not named as
/// if they were the cause, and nothing but the member that has the play is blamed.
#[test]
fn verify_a_law_is_not_made_of_a_spring_that_is_gone() {
    let truth = [placed("backlash", ground(), &[4e-4])];
    let outcome = diagnosed_as(&common::plant(), &truth, &["backlash"], COARSE_S);
    let verdict = &outcome.diagnosis.verdict;
    let elsewhere = verdict.effects.iter().filter(|e| e.at != ground());
    assert_eq!(elsewhere.count(), 0, "{verdict:?}");
    let honest = verdict.status == Status::Unknown || !verdict.complete;
    assert!(honest, "{verdict:?}");
}

/// A damper of the model that is off damps alike in both directions. Where dampers are not looked for, a law by
/// direction is not named.
#[test]
fn verify_a_damper_that_is_off_is_no_asymmetry() {
    let truth = [placed("damping_error", ground(), &[1.3])];
    let outcome = diagnosed_as(&common::plant(), &truth, &["damping_error"], COARSE_S);
    let verdict = &outcome.diagnosis.verdict;
    assert_eq!(verdict.status, Status::Unknown, "{verdict:?}");
    let told = verdict.description.iter();
    let why = told.filter(|sentence| sentence.contains("two values that agree: one would do"));
    assert_eq!(why.count(), 1, "{:?}", verdict.description);
}

/// What comes late on every channel by the same time was late before the sensors. Where nothing before them is
/// looked for, it is not blamed on each of them.
#[test]
fn verify_what_is_common_to_all_channels_is_not_blamed_on_each() {
    let truth = [placed(
        "input_delay",
        Location::Input("u".into()),
        &[0.0047],
    )];
    let known = diagnosed(&truth, &[]);
    assert_eq!(
        named(&known),
        [("input_delay".into(), Location::Input("u".into()))]
    );
    let outcome = diagnosed(&truth, &["input_delay", "input_lag", "held_input"]);
    let verdict = &outcome.diagnosis.verdict;
    assert_eq!(verdict.status, Status::Unknown, "{verdict:?}");
}

/// A hidden mass that nothing excites rings by its start alone, and its force is as good as any at one frequency. Where
/// that is not looked for, it is not made a mode.
#[test]
fn verify_a_tone_is_not_taken_for_a_hidden_mass() {
    let top = Location::Mass("top".into());
    let truth = [placed("harmonic_force", top, &[0.8, 6.3, 0.4])];
    let withheld = ["harmonic_force", "tone_pickup"];
    let outcome = diagnosed_as(&common::plant(), &truth, &withheld, COARSE_S);
    let effects = named(&outcome);
    let hidden = |kind: &str| ["attached_mode", "flexible_support"].contains(&kind);
    assert!(effects.iter().all(|(kind, _)| !hidden(kind)), "{effects:?}");
}

#[test]
fn verify_two_runs_are_the_same_to_the_last_digit() {
    let truth = [placed("backlash", ground(), &[4e-4])];
    let told = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        let outcome = pool.build().unwrap().install(|| diagnosed(&truth, &[]));
        serde_json::to_string(&outcome.diagnosis).unwrap()
    };
    let first = told(1);
    assert!(first == told(3), "other numbers of threads");
    assert!(first == told(3), "another run");
}

/// One mass on a spring.
const SLIDE: &str = r#"schema = "simgap-model/1"
name = "slide"
[[mass]]
name = "base"
value = 2.0
[[spring]]
name = "k"
between = ["base", "ground"]
stiffness = 800.0
[[damper]]
name = "c"
between = ["base", "ground"]
damping = 6.0
[[input]]
channel = "u"
kind = "force"
at = "base"
[[output]]
channel = "x"
kind = "displacement"
at = "base"
"#;

/// Two converters may take turns, one of them right: the mean of the two is then off as well, and no second fault.
#[test]
fn verify_an_alternation_with_one_half_right_is_one_fault() {
    let truths = [("alternating_gain", 0.04), ("alternating_timing", 4e-4)];
    for (kind, size) in truths {
        for even_share in [0.0, 1.0] {
            let truth = [placed(kind, channel("x"), &[size, even_share])];
            let outcome = diagnosed(&truth, &[]);
            assert_eq!(named(&outcome), [(kind.to_string(), channel("x"))]);
            let share = outcome.diagnosis.verdict.effects[0].parameters[1].value;
            assert!((share - even_share).abs() < 0.1, "{kind}: {share}");
        }
    }
}

/// What catches a mass also slows it: a contact without damping in it would not be believed.
#[test]
fn verify_a_stop_is_found_with_its_damping() {
    let truth = [placed("end_stop", ground(), &[2.5e-3, 1.0, 4e4, 1e-3])];
    let outcome = diagnosed_as(&common::plant(), &truth, &[], COARSE_S);
    assert_eq!(named(&outcome), [("end_stop".to_string(), ground())]);
    let values = &outcome.diagnosis.verdict.effects[0].parameters;
    for (k, needed) in [(0, 2.5e-3), (2, 4e4), (3, 1e-3)] {
        assert!((values[k].value / needed - 1.0).abs() < 0.1, "{values:?}");
    }
}

/// Friction gives like a spring before it slides, with a damper beside that spring or without: one kind either way.
#[test]
fn verify_friction_before_it_slides_is_found_with_its_damping() {
    for damping_time in [6e-3, 0.0] {
        let truth = [placed(
            "presliding_friction",
            ground(),
            &[6.0, 2e-3, damping_time, 0.0],
        )];
        let outcome = diagnosed(&truth, &[]);
        let kind = "presliding_friction".to_string();
        assert_eq!(named(&outcome), [(kind, ground())]);
        let effect = &outcome.diagnosis.verdict.effects[0];
        assert!(outcome.diagnosis.verdict.complete, "{:?}", effect.evidence);
        let values = &effect.parameters;
        assert!((values[0].value / 6.0 - 1.0).abs() < 0.05, "{values:?}");
        assert!(
            (values[2].value - damping_time).abs() < 1e-3,
            "{damping_time}: {values:?}"
        );
    }
}

/// A drift is slow from end to end: by its colour the channel would count as one sample.
#[test]
fn verify_a_drift_is_seen_past_trifles() {
    let truth = [
        placed("sensor_drift", channel("x"), &[4e-4]),
        placed("stiffness_error", ground(), &[1.02]),
    ];
    let outcome = diagnosed(&truth, &[]);
    let found = named(&outcome);
    assert_eq!(found[0], ("sensor_drift".to_string(), channel("x")));
}

/// Along a force that repeats a simulation that is a little off is soon a lap ahead of the machine: over whole records
/// no fit finds its way, over stretches of them one does.
#[test]
fn verify_a_law_is_found_where_motions_part() {
    let slide = Model::from_toml(SLIDE).unwrap();
    let truth = [placed(
        "position_periodic_force",
        ground(),
        &[8.0, 3.2, 0.012],
    )];
    let outcome = diagnosed_as(&slide, &truth, &[], 4e-3);
    let found = named(&outcome);
    assert_eq!(found, [("position_periodic_force".to_string(), ground())]);
    let values = &outcome.diagnosis.verdict.effects[0].parameters;
    assert!((values[2].value / 0.012 - 1.0).abs() < 1e-3, "{values:?}");
}

/// A strut that is moved by one end.
const STRUT: &str = r#"schema = "simgap-model/1"
name = "strut"
[[spring]]
name = "k"
between = ["rod", "ground"]
stiffness = 4e4
[[damper]]
name = "c"
between = ["rod", "ground"]
damping = 1500.0
[[input]]
channel = "z"
kind = "displacement"
at = "rod"
[[output]]
channel = "F"
kind = "force"
between = ["rod", "ground"]
"#;

/// A damper differentiates the noise of what moves it. Lags, late clocks and soft supports smooth that noise, and would
/// leave less of it than the machine as it is.
#[test]
fn verify_the_noise_of_an_input_is_not_smoothed_by_what_is_not_there() {
    let strut = Model::from_toml(STRUT).unwrap();
    let clean = diagnosed_with_noise(&strut, &[], &[], 2e-3, 0.01);
    let verdict = clean.diagnosis.verdict;
    assert!(
        matches!(verdict.status, Status::None | Status::Parameters),
        "{verdict:?}"
    );
    let gap = clean.diagnosis.gap;
    let noise = gap.noise_floor.hypot(gap.input_noise);
    assert!((0.9..1.3).contains(&(noise / gap.nominal)), "{gap:?}");
}

/// The same beside dry friction, which turns the noise of what moves the strut into blows about every reversal.
#[test]
#[ignore = "not met: noise of an input through dry friction is not in the noise model (docs/limits.md)"]
fn verify_friction_is_not_smoothed_by_what_is_not_there() {
    let strut = Model::from_toml(STRUT).unwrap();
    let rod = || Location::Between(["rod".into(), "ground".into()]);
    let truth = [placed("coulomb_friction", rod(), &[5e5])];
    let outcome = diagnosed_with_noise(&strut, &truth, &[], 2e-3, 0.01);
    assert_eq!(named(&outcome), [("coulomb_friction".to_string(), rod())]);
}

/// What closes the gap is told first: a spring at 0.7 of its value, not the sensor that is two hundredths off besides.
#[test]
fn verify_a_wrong_parameter_that_closes_the_gap_comes_first() {
    let between = Location::Between(["top".into(), "base".into()]);
    let truth = [
        placed("stiffness_error", between.clone(), &[0.7]),
        placed("sensor_gain", Location::Channel("x".into()), &[0.98]),
    ];
    let outcome = diagnosed(&truth, &[]);
    let named = common::named(&outcome);
    let wanted = truth.map(|placed| (placed.effect.kind().to_string(), placed.at));
    assert_eq!(named, wanted);
}
