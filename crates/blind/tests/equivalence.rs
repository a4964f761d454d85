//! The table of equivalents, held against simulations.
#![allow(clippy::unwrap_used)]

use simgap_blind::{Level, Recipe, Status, generate};
use simgap_effects::equivalents;
use simgap_effects::{Action, Placed, Sampled, find};
use simgap_model::{Location, Model};
use simgap_simulate::{Run, Simulator};

/// Transients of the different rest positions and speeds have died out to this share of the signal
/// by the second half of the runs.
const SETTLED: f64 = 1e-6;

fn model(members: &str, output: &str) -> Model {
    Model::from_toml(&format!(
        r#"
schema = "simgap-model/1"
name = "m"
{members}
[[input]]
channel = "u"
kind = "force"
at = "m1"
[[output]]
channel = "y1"
kind = "{output}"
at = "m1"
"#
    ))
    .unwrap()
}

const SPRUNG: &str = r#"
mass = [{ name = "m1", value = 2.0 }]
spring = [{ name = "s", between = ["m1", "ground"], stiffness = 800.0 }]
damper = [{ name = "d", between = ["m1", "ground"], damping = 8.0 }]
"#;

const FREE: &str = r#"
mass = [{ name = "m1", value = 2.0 }]
damper = [{ name = "d", between = ["m1", "ground"], damping = 8.0 }]
"#;

const LOOSE: &str = r#"mass = [{ name = "m1", value = 2.0 }]"#;

fn place(kind: &str, at: Location, values: &[f64]) -> Placed {
    Placed::new(find(kind).unwrap(), at, values.to_vec())
}

fn mass() -> Location {
    Location::Mass("m1".into())
}

fn channel() -> Location {
    Location::Channel("y1".into())
}

fn input() -> Location {
    Location::Input("u".into())
}

/// Second half of the output of a model with one effect.
fn settled(model: &Model, effect: &Placed) -> Vec<f64> {
    let u: Vec<f64> = (0..8000)
        .map(|i| 30.0 * (0.05 * f64::from(i)).sin())
        .collect();
    let run = Run {
        first_index: 0,
        name: String::new(),
        start_s: 0.0,
        time_step_s: 2e-3,
        len: u.len(),
        inputs: vec![u],
        measured: vec![None],
        mended: simgap_simulate::Mended::default(),
    };
    let plant: Vec<Placed> = match effect.action() {
        Action::Output(_) => vec![],
        _ => vec![effect.clone()],
    };
    let simulator = Simulator::new(model, &plant, 4).unwrap();
    let mut y = simulator.predict(&run, &[0.0, 0.0]).unwrap().remove(0);
    if let Action::Output(map) = effect.action() {
        y = map.apply(Sampled::from_start(&y, 2e-3));
    }
    y.split_off(4000)
}

fn listed(model: &Model, a: &Placed, b: &Placed) -> bool {
    equivalents(a.effect.kind(), &a.at, model)
        .iter()
        .any(|e| e.kind == b.effect.kind() && e.at == b.at)
}

#[track_caller]
fn check_same(model: &Model, a: &Placed, b: &Placed) {
    assert!(listed(model, a, b) && listed(model, b, a));
    let (ya, yb) = (settled(model, a), settled(model, b));
    let size = ya.iter().fold(0.0_f64, |m, y| m.max(y.abs()));
    let apart = ya
        .iter()
        .zip(&yb)
        .fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()));
    assert!(apart < SETTLED * size, "{apart} of {size}");
}

#[test]
fn verify_a_late_input_is_a_late_sensor_whatever_the_law() {
    const SWINGING: &str = r#"
mass = [{ name = "m1", value = 2.0 }]
damper = [{ name = "d", between = ["m1", "ground"], damping = 8.0 }]
pendulum = [{ at = "m1", value = 60.0 }]
"#;
    let model = model(SWINGING, "displacement");
    // Whole samples: between them the two interpolate other signals.
    let late = place("input_delay", input(), &[0.01]);
    check_same(&model, &late, &place("sensor_delay", channel(), &[0.01]));
    let lag = place("input_lag", input(), &[0.01]);
    assert!(!listed(
        &model,
        &lag,
        &place("sensor_lag", channel(), &[0.01])
    ));
}

#[test]
fn verify_constant_force_is_a_bias_of_the_rest_position() {
    let model = model(SPRUNG, "displacement");
    let force = place("constant_force", mass(), &[16.0]);
    check_same(&model, &force, &place("sensor_bias", channel(), &[0.02]));
}

#[test]
fn verify_constant_force_is_a_bias_of_the_final_speed() {
    let model = model(FREE, "velocity");
    let force = place("constant_force", mass(), &[16.0]);
    check_same(&model, &force, &place("sensor_bias", channel(), &[2.0]));
}

#[test]
fn verify_gain_of_the_only_input_is_gain_of_the_only_sensor() {
    let model = model(SPRUNG, "acceleration");
    let gained = settled(&model, &place("input_gain", input(), &[1.2]));
    let plain = settled(&model, &place("input_gain", input(), &[1.0]));
    let size = gained.iter().fold(0.0_f64, |m, y| m.max(y.abs()));
    for (gained, plain) in gained.iter().zip(plain) {
        assert!((gained - 1.2 * plain).abs() < SETTLED * size);
    }
    let same = equivalents("input_gain", &input(), &model);
    assert!(
        same.iter()
            .any(|e| e.kind == "sensor_gain" && e.at == channel())
    );
    let same = equivalents("sensor_gain", &channel(), &model);
    assert!(
        same.iter()
            .any(|e| e.kind == "input_gain" && e.at == input())
    );
}

#[test]
fn verify_gain_is_the_inverse_mass_of_a_loose_body() {
    let model = model(LOOSE, "acceleration");
    let input = place("input_gain", input(), &[1.25]);
    check_same(&model, &input, &place("mass_error", mass(), &[0.8]));
    // With a damper the mass alone is something else.
    let held = self::model(FREE, "acceleration");
    assert!(!listed(&held, &input, &place("mass_error", mass(), &[0.8])));
}

#[test]
fn verify_conditions_keep_the_table_short() {
    let force = |model: &Model| equivalents("constant_force", &mass(), model).len();
    // A constant force leaves no trace in an accelerometer, and moves a free axis away.
    assert_eq!(force(&model(SPRUNG, "acceleration")), 0);
    assert_eq!(force(&model(FREE, "displacement")), 0);
    let mut two = model(SPRUNG, "displacement");
    assert_eq!(force(&two), 1);
    two.outputs.push(simgap_model::Output {
        channel: "y2".into(),
        kind: simgap_model::OutputKind::Displacement,
        ..two.outputs[0].clone()
    });
    assert_eq!(force(&two), 0);
    assert!(equivalents("input_gain", &input(), &two).is_empty());
    assert!(equivalents("coulomb_friction", &mass(), &two).is_empty());
}

#[test]
fn verify_truth_carries_the_equivalents_of_its_effects() {
    let case = (0..20)
        .map(|n| generate(9, n, &Recipe::Kind("input_gain".into()), Level::Standard).unwrap())
        .find(|case| {
            case.model.inputs.len() == 1
                && case.model.outputs.len() == 1
                && case.model.pendulums.is_empty()
        })
        .unwrap();
    assert_eq!(case.truth.status, Status::Parameters);
    assert_eq!(case.truth.equivalents[0][0].kind, "sensor_gain");
}

#[test]
fn verify_an_effect_beside_changes_what_is_equivalent() {
    // A free axis keeps a force and a bias apart; the spring it lacked makes them one.
    let recipe = Recipe::Pair("constant_force".into(), "linear_stiffness".into());
    let case = (0..40)
        .map(|n| generate(21, n, &recipe, Level::Standard).unwrap())
        .find(|case| {
            case.model.name == "axis"
                && case.model.outputs[0].kind == simgap_model::OutputKind::Displacement
        })
        .unwrap();
    assert_eq!(case.truth.equivalents[0][0].kind, "sensor_bias");
    assert!(
        equivalents(
            "constant_force",
            &Location::Mass("carriage".into()),
            &case.model
        )
        .is_empty()
    );
}
