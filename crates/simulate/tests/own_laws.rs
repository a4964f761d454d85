//! Laws of the user's beside those of the catalogue: the same text gives the same motion.
#![allow(clippy::unwrap_used, clippy::panic)]

use crate::support::{between, force_input, model, oscillator, output, placed, run, sampled};
use simgap_effects::{Placed, find_of};
use simgap_model::{Law, LawParameter, Model};
use simgap_simulate::{Job, Run, Simulator, predict_all};

const STEP_S: f64 = 2e-3;
const SAMPLES: usize = 3000;

/// Rounding, and what the solution of a step leaves, relative to the largest value: the operations of a text are those of the
/// law of the catalogue, in another order.
const SAME: f64 = 1e-12;

fn machine(laws: Vec<Law>) -> Model {
    let text = format!(
        "{}{}{}{}",
        oscillator(2.0, 800.0, 3.0, "ground"),
        force_input("block"),
        output("y", "displacement", "block"),
        output("a", "acceleration", "block"),
    );
    let mut model = model(&text);
    model.laws = laws;
    model.check().unwrap();
    model
}

fn law(name: &str, force: &str, parameters: &[&str]) -> Law {
    let parameters = parameters.iter();
    Law {
        name: name.into(),
        summary: None,
        between: vec![],
        force: force.into(),
        parameters: parameters
            .map(|name| LawParameter::of_size(name, "1", 1.0))
            .collect(),
    }
}

fn pushed() -> Run {
    let push = |t: f64| 30.0 * (6.0 * t).sin() + 12.0 * (21.0 * t + 0.4).cos();
    run(STEP_S, SAMPLES, vec![sampled(STEP_S, SAMPLES, push)])
}

fn own(model: &Model, kind: &str, values: &[f64]) -> Placed {
    let effect = find_of(model, kind).unwrap();
    Placed::new(effect, between("block", "ground"), values.to_vec())
}

fn predicted(model: &Model, effects: &[Placed]) -> Vec<Vec<f64>> {
    let simulator = Simulator::new(model, effects, 2).unwrap();
    simulator.predict(&pushed(), &[]).unwrap()
}

#[test]
fn verify_a_law_of_the_catalogue_written_as_text_moves_alike() {
    let at = || between("block", "ground");
    for (force, names, values, kind, theirs) in [
        (
            "q * abs(v) * v",
            vec!["q"],
            vec![7.0],
            "quadratic_damping",
            vec![7.0],
        ),
        (
            "k * d^3",
            vec!["k"],
            vec![4e5],
            "cubic_stiffness",
            vec![4e5],
        ),
        (
            "a * sin(2 * pi * d / p) + b * cos(2 * pi * d / p)",
            vec!["a", "b", "p"],
            vec![3.0, -1.0, 0.02],
            "position_periodic_force",
            vec![3.0, -1.0, 0.02],
        ),
    ] {
        let model = machine(vec![law("own", force, &names)]);
        let ours = predicted(&model, &[own(&model, "own", &values)]);
        let theirs = predicted(&model, &[placed(kind, at(), &theirs)]);
        for (ours, theirs) in ours.iter().zip(&theirs) {
            let largest = theirs.iter().fold(0.0_f64, |most, y| most.max(y.abs()));
            let apart = ours.iter().zip(theirs).map(|(a, b)| (a - b).abs());
            let apart = apart.fold(0.0, f64::max) / largest;
            assert!(apart <= SAME, "{force}: {apart:e}");
        }
    }
}

/// Every function and operation, in sets side by side and alone: the same bits.
#[test]
fn verify_a_batch_gives_the_bits_of_one() {
    let force = "c * (tanh(v / s) + 0.3 * sin(40 * d) * cos(v) + exp(-(v / s)^2) * atan(v) + sign(d) * sqrt(abs(d))) \
                 + c * (ln(1 + d^2) * (2 + v)^3 + min(d, v) - max(v, abs(v) ^ 1.5) + (1 + d)^-2 + v^2 * t * 1e-3)";
    let model = machine(vec![law("own", force, &["c", "s"])]);
    let effects: Vec<Placed> = (0..11)
        .map(|k| {
            own(
                &model,
                "own",
                &[0.5 + 0.1 * f64::from(k), 0.05 + 0.02 * f64::from(k)],
            )
        })
        .collect();
    let simulators: Vec<Simulator> = effects
        .into_iter()
        .map(|effect| Simulator::new(&model, &[effect], 2).unwrap())
        .collect();
    let run = pushed();
    let jobs = simulators.iter().map(|simulator| Job {
        simulator,
        run: &run,
        initial: &[],
        smooth: false,
    });
    let together = predict_all(&jobs.collect::<Vec<_>>());
    for (simulator, together) in simulators.iter().zip(together) {
        let alone = simulator.predict(&run, &[]).unwrap();
        assert_eq!(alone, together.unwrap());
        assert!(alone[0].iter().all(|y| y.is_finite()));
    }
}

/// A force that has no value at some motion makes a prediction that is no number, and no more.
#[test]
fn verify_a_force_without_a_value_is_no_panic() {
    let model = machine(vec![law("own", "c * (sqrt(1 - 1e4 * d^2) - 1)", &["c"])]);
    let effects = vec![own(&model, "own", &[5.0]); 9];
    let simulators: Vec<Simulator> = effects
        .into_iter()
        .map(|effect| Simulator::new(&model, &[effect], 2).unwrap())
        .collect();
    let run = pushed();
    let jobs = simulators.iter().map(|simulator| Job {
        simulator,
        run: &run,
        initial: &[],
        smooth: false,
    });
    for predicted in predict_all(&jobs.collect::<Vec<_>>()) {
        assert!(predicted.unwrap()[0].iter().any(|y| !y.is_finite()));
    }
}

#[test]
fn verify_an_effect_of_a_file_has_its_law() {
    let mut model = machine(vec![law("own", "q * abs(v) * v", &["q"])]);
    let with = predicted(&model, &[own(&model, "own", &[7.0])]);
    model.effects.push(own(&model, "own", &[7.0]).to_entry());
    let written = Model::from_toml(&model.to_toml().unwrap()).unwrap();
    let simulator = Simulator::of_file(&written, &[pushed()]).unwrap();
    let of_file = simulator.predict(&pushed(), &[]).unwrap();
    let apart = of_file[0].iter().zip(&with[0]).map(|(a, b)| (a - b).abs());
    assert!(
        apart.fold(0.0, f64::max) < 1e-3 * with[0].iter().fold(0.0, |m, y| f64::max(m, y.abs()))
    );
}
