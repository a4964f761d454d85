//! What the search relies on: initial states, the score of an effect before its fit, and the same
//! answer every time.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use std::f64::consts::TAU;

use crate::support::{
    OSCILLATOR, between, candidate, drive, model, noisy, placed, problem, scale, start, truth,
};
use proptest::prelude::*;
use simgap_estimate::{
    Candidate, Fit, FitOptions, JointScore, Start, fit, fit_initial_states, joint_scores,
    linearise_at, score,
};
use simgap_model::Location;

fn strict() -> FitOptions {
    FitOptions {
        converged: 1e-12,
        ..FitOptions::white(1)
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// A linear model's output is linear in its initial state: one step finds it.
    #[test]
    fn prop_initial_states_of_linear_models_are_found_exactly(
        x0 in -0.05..0.05_f64,
        v0 in -1.0..1.0_f64,
    ) {
        // The sensitivities are differences of relative size 1e-4, exact for a linear model but for
        // rounding of 1e-16 / 1e-4; the second step takes most of that away as well.
        const ROUNDING: f64 = 1e-9;
        let model = model(OSCILLATOR);
        let run = truth(&model, &[], drive(0.01, 300, 6.0), 0.01, &[x0, v0]);
        let fit = fit_initial_states(&problem(&model, run), &[], &strict()).unwrap();
        let found = &fit.estimate.initial[0];
        prop_assert!((found[0] - x0).abs() < ROUNDING, "{} for {x0}", found[0]);
        prop_assert!((found[1] - v0).abs() < ROUNDING * 20.0, "{} for {v0}", found[1]);
    }
}

/// Two runs have two initial states, and the effects given count.
#[test]
fn verify_each_run_gets_its_own_initial_state() {
    let model = model(OSCILLATOR);
    let rubbing = [placed(
        "coulomb_friction",
        between("block", "ground"),
        &[1.4],
    )];
    let states = [[0.02, -0.3], [-0.01, 0.5]];
    let runs = states.map(|s| truth(&model, &rubbing, drive(0.01, 300, 6.0), 0.01, &s));
    let mut problem = problem(&model, runs[0].clone());
    problem.runs.push(runs[1].clone());
    let fit = fit_initial_states(&problem, &rubbing, &strict()).unwrap();
    for (found, wanted) in fit.estimate.initial.iter().zip(states) {
        assert!(
            (found[0] - wanted[0]).abs() < 1e-5,
            "{found:?} for {wanted:?}"
        );
        assert!(
            (found[1] - wanted[1]).abs() < 1e-3,
            "{found:?} for {wanted:?}"
        );
    }
    assert!(fit.estimate.effects.is_empty() && fit.estimate.nominal.is_empty());
}

/// Along a force that repeats every few millimetres, two motions that begin nearly alike are soon a period apart: over
/// a whole record the objective has many valleys, over its first samples one.
#[test]
fn verify_initial_states_are_found_where_motions_part() {
    let model = model(OSCILLATOR);
    let cogging = [placed(
        "position_periodic_force",
        between("block", "ground"),
        &[4.0, 0.0, 0.006],
    )];
    for v0 in [-1.3, -0.8, -0.3, 0.3, 0.8, 1.3] {
        let run = truth(
            &model,
            &cogging,
            drive(0.002, 3000, 6.0),
            0.002,
            &[0.01, v0],
        );
        let fit = fit_initial_states(&problem(&model, run), &cogging, &strict()).unwrap();
        let found = &fit.estimate.initial[0];
        assert!(
            (found[0] - 0.01).abs() < 1e-6 && (found[1] - v0).abs() < 1e-4,
            "{found:?} for {v0}"
        );
    }
}

/// A shaft without a spring whose speed is measured.
const SHAFT: &str = r#"schema = "simgap-model/1"
name = "shaft"
[[mass]]
name = "shaft"
value = 2.0
[[input]]
channel = "u"
kind = "force"
at = "shaft"
[[output]]
channel = "v"
kind = "velocity"
at = "shaft"
"#;

/// v = a t and x = a t²/2: as far as the shaft comes in its records is how far away it may begin.
#[test]
fn verify_the_prior_of_a_state_is_as_wide_as_the_motion_goes() {
    let model = model(SHAFT);
    let runs = [300, 200].map(|len| truth(&model, &[], vec![3.0; len], 0.01, &[0.0, 0.0]));
    let mut problem = problem(&model, runs[0].clone());
    problem.runs.push(runs[1].clone());
    let fit = fit_initial_states(&problem, &[], &strict()).unwrap();
    let std = problem.state_std_of(&[], &fit.estimate.initial).unwrap();
    let (time_s, a) = (2.99_f64, 1.5);
    assert!(
        (std[0] / (0.5 * a * time_s * time_s) - 1.0).abs() < 1e-6,
        "{std:?}"
    );
    assert!((std[1] / (a * time_s) - 1.0).abs() < 1e-6, "{std:?}");
}

/// No record shows where the shaft stands: under the prior it stands at zero, without it wherever it began.
#[test]
fn verify_a_state_that_nothing_shows_is_drawn_to_the_mean_of_its_prior() {
    let model = model(SHAFT);
    let run = truth(&model, &[], vec![3.0; 300], 0.01, &[0.0, 0.0]);
    let mut problem = problem(&model, run);
    let far = start(vec![], vec![], &[5000.0, 0.0]);
    let free = fit(&problem, &far, &strict()).unwrap();
    assert_eq!(free.estimate.initial[0][0], 5000.0);
    problem.state_std = problem.state_std_of(&[], &free.estimate.initial).unwrap();
    problem.state_std[0] = 7.0;
    let held = fit(&problem, &far, &strict()).unwrap();
    assert!(
        held.estimate.initial[0][0].abs() < 1e-6,
        "{:?}",
        held.estimate.initial
    );
}

fn baseline(std: f64) -> (simgap_estimate::Problem, Fit, FitOptions) {
    let model = model(OSCILLATOR);
    let pushed = [placed(
        "constant_force",
        Location::Mass("block".into()),
        &[0.4],
    )];
    let run = noisy(
        &truth(&model, &pushed, drive(0.01, 400, 6.0), 0.01, &[0.0; 2]),
        std,
        9,
    );
    let problem = problem(&model, run);
    let weights = strict();
    let fit = fit(&problem, &start(vec![], vec![], &[0.0; 2]), &weights).unwrap();
    (problem, fit, weights)
}

fn with(start: &Start, effect: simgap_effects::Placed) -> Start {
    let mut start = start.clone();
    start.effects.push(effect);
    start
}

/// The output is linear in a constant force and in a bias, so that the score knows what a fit
/// will bring, and where it will end.
#[test]
fn verify_the_score_of_a_linear_effect_is_what_its_fit_gains() {
    let mass = Location::Mass("block".into());
    let channel = Location::Channel("y".into());
    for (kind, at) in [("constant_force", mass), ("sensor_bias", channel)] {
        let (problem, base, weights) = baseline(5e-4);
        let linear = linearise_at(&problem, &base, &weights).unwrap();
        let scores = score(&linear, &candidate(kind, at), &scale()).unwrap();
        let best = &scores[0];
        let from = with(&base.estimate, best.start.clone());
        let fitted = fit(&problem, &from, &weights).unwrap();
        let gained = base.objective - fitted.objective;
        // What (2) leaves out is the accuracy of 5e-4 of the motion beside the noise of 5 %.
        assert!(
            (best.gain / gained - 1.0).abs() < 1e-3,
            "{kind}: {} for {gained}",
            best.gain
        );
        assert!(
            gained > 20.0,
            "{kind}: {gained} would be too little to tell"
        );
        let (asked, found) = (best.start.values[0], fitted.estimate.effects[0].values[0]);
        assert!(
            (asked / found - 1.0).abs() < 1e-4,
            "{kind}: {asked} asked, {found} found"
        );
    }
}

/// Both act on the output in proportion, together as well. What further candidates there are changes nothing.
#[test]
fn verify_the_joint_score_of_linear_effects_is_what_their_fit_gains() {
    // All columns are solved for at once: what rounding leaves of that.
    const ROUNDING: f64 = 1e-6;
    let model = model(OSCILLATOR);
    let (mass, channel) = (
        Location::Mass("block".into()),
        Location::Channel("y".into()),
    );
    let both = [
        placed("constant_force", mass.clone(), &[0.9]),
        placed("sensor_drift", channel.clone(), &[4e-4]),
    ];
    let run = truth(&model, &both, drive(0.01, 400, 6.0), 0.01, &[0.0; 2]);
    let problem = problem(&model, noisy(&run, 5e-4, 11));
    let base = fit(&problem, &start(vec![], vec![], &[0.0; 2]), &strict()).unwrap();
    let linear = linearise_at(&problem, &base, &strict()).unwrap();
    let leg = || between("block", "ground");
    let known = [("constant_force", mass), ("sensor_drift", channel)];
    let further = [
        ("viscous_damping", leg()),
        ("quadratic_damping", leg()),
        ("linear_stiffness", leg()),
    ];
    let shapes: Vec<_> = known
        .into_iter()
        .chain(further)
        .map(|(kind, at)| {
            let candidate = candidate(kind, at);
            let shape = candidate.effect.starts(&scale()).swap_remove(0);
            (candidate, shape)
        })
        .collect();
    let is_both = |score: &&JointScore| {
        let kinds: Vec<&str> = score.starts.iter().map(|p| p.effect.kind()).collect();
        kinds == ["constant_force", "sensor_drift"]
    };
    let of = |shapes: &[(Candidate, Vec<f64>)]| {
        let scores = joint_scores(&linear, shapes, 16);
        scores.iter().find(is_both).expect("the pair").clone()
    };
    let (alone, among) = (of(&shapes[..2]), of(&shapes));
    assert!((among.gain / alone.gain - 1.0).abs() < ROUNDING);
    let mut from = base.estimate.clone();
    from.effects.extend(among.starts.iter().cloned());
    let fitted = fit(&problem, &from, &strict()).unwrap();
    let gained = base.objective - fitted.objective;
    assert!(
        (among.gain / gained - 1.0).abs() < 1e-3,
        "{} for {gained}",
        among.gain
    );
    assert!(gained > 20.0, "{gained} would be too little to tell");
    for (asked, found) in among.starts.iter().zip(&fitted.estimate.effects) {
        let (asked, found) = (asked.values[0], found.values[0]);
        assert!(
            (asked / found - 1.0).abs() < 1e-4,
            "{asked} asked, {found} found"
        );
    }
}

/// What is not there scores what noise scores: half a unit a parameter on average.
#[test]
fn verify_an_absent_effect_scores_no_more_than_noise() {
    let model = model(OSCILLATOR);
    let clean = truth(&model, &[], drive(0.01, 400, 6.0), 0.01, &[0.0; 2]);
    let mut sum = 0.0;
    for seed in 0..40 {
        let problem = problem(&model, noisy(&clean, 5e-4, 50 + seed));
        let base = fit(&problem, &start(vec![], vec![], &[0.0; 2]), &strict()).unwrap();
        let linear = linearise_at(&problem, &base, &strict()).unwrap();
        let push = candidate("constant_force", Location::Mass("block".into()));
        sum += score(&linear, &push, &scale()).unwrap()[0].gain;
    }
    // Half of chi-squared of one degree: mean 0.5, standard deviation 0.71 / √40 = 0.11.
    let mean = sum / 40.0;
    assert!((mean - 0.5).abs() < 0.34, "mean gain from noise {mean}");
}

/// A shape whose size would have to be unphysical is no start.
#[test]
fn verify_a_negative_friction_is_not_offered() {
    let model = model(OSCILLATOR);
    let feeding = [placed("damping_error", between("block", "ground"), &[0.2])];
    let run = truth(&model, &feeding, drive(0.01, 400, 6.0), 0.01, &[0.0; 2]);
    let problem = problem(&model, noisy(&run, 1e-4, 3));
    let base = fit(&problem, &start(vec![], vec![], &[0.0; 2]), &strict()).unwrap();
    let linear = linearise_at(&problem, &base, &strict()).unwrap();
    let friction = candidate("coulomb_friction", between("block", "ground"));
    assert!(score(&linear, &friction, &scale()).unwrap().is_empty());
}

#[test]
fn verify_the_same_fit_comes_out_to_the_last_bit() {
    let model = model(OSCILLATOR);
    let place = || between("block", "ground");
    let rubbing = [placed("coulomb_friction", place(), &[1.4])];
    let run = noisy(
        &truth(&model, &rubbing, drive(0.01, 400, 6.0), 0.01, &[0.0; 2]),
        1e-4,
        3,
    );
    let once = || {
        let effects = vec![placed("coulomb_friction", place(), &[0.5])];
        let nominal = vec![placed("stiffness_error", place(), &[1.0])];
        let from = start(effects, nominal, &[0.0; 2]);
        fit(&problem(&model, run.clone()), &from, &FitOptions::white(1)).unwrap()
    };
    let (a, b) = (once(), once());
    assert_eq!(a.objective.to_bits(), b.objective.to_bits());
    assert_eq!(a.estimate.effects[0].values, b.estimate.effects[0].values);
    assert_eq!(a.estimate.nominal[0].values, b.estimate.nominal[0].values);
    assert_eq!(a.estimate.initial, b.estimate.initial);
    assert_eq!((a.iterations, a.intervals), (b.iterations, b.intervals));
}

/// No step makes the objective worse, wherever the fit starts.
#[test]
fn verify_a_fit_never_ends_above_its_start() {
    let model = model(OSCILLATOR);
    let place = || between("block", "ground");
    let hardening = [placed("cubic_stiffness", place(), &[3e5])];
    let run = noisy(
        &truth(&model, &hardening, drive(0.01, 400, 6.0), 0.01, &[0.0; 2]),
        1e-4,
        3,
    );
    let problem = problem(&model, run);
    let nothing = start(vec![], vec![], &[0.0; 2]);
    let base = fit(&problem, &nothing, &strict()).unwrap();
    for size in [1e3, 1e5, -1e5, 1e6] {
        let from = with(&base.estimate, placed("cubic_stiffness", place(), &[size]));
        let fitted = fit(&problem, &from, &strict()).unwrap();
        assert!(fitted.objective <= base.objective, "from {size}");
        let found = fitted.estimate.effects[0].values[0];
        assert!((found / 3e5 - 1.0).abs() < 0.05, "{found} from {size}");
    }
}

/// A tone in four of its cycles, an hour after time zero: its phase there and its frequency stand in for each other
/// but for a ten-thousandth.
#[test]
fn verify_a_tone_is_followed_long_after_time_zero() {
    let model = model(&OSCILLATOR.replace("damping = 6.0", "damping = 1.0"));
    let mass = || Location::Mass("block".into());
    let (step, len) = (0.001, 1250);
    for start_s in [0.0, 62.0, 3600.0] {
        let phase = |freq: f64, of_record: f64| of_record - TAU * freq * start_s;
        let tone = placed("harmonic_force", mass(), &[5.0, 3.2, 0.6]);
        let force = drive(step, len, 10.0);
        let mut run = truth(&model, &[tone], force, step, &[1e-3, 0.0]);
        run.start_s = start_s;
        let problem = problem(&model, noisy(&run, 1e-6, 3));
        let near = placed("harmonic_force", mass(), &[4.9, 3.21, phase(3.21, 0.5)]);
        let search = FitOptions {
            most_steps: 10,
            ..FitOptions::white(1)
        };
        let fitted = fit(&problem, &start(vec![near], vec![], &[0.0; 2]), &search).unwrap();
        let interval = fitted.intervals[0][1];
        let (found, [low, high]) = (interval.value, interval.ci95);
        assert!(
            fitted.variance[0] < 1.1e-12,
            "{:?} at {start_s} s",
            fitted.variance
        );
        assert!(
            (low..high).contains(&3.2) && high - low < 2e-3,
            "{found} at {start_s} s"
        );
        // At time zero the phase is as uncertain as the frequency makes it.
        let [low, high] = fitted.intervals[0][2].ci95;
        assert!(
            (low..high).contains(&phase(3.2, 0.6)),
            "{low} to {high} at {start_s} s"
        );
    }
}
