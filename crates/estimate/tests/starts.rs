//! Where fits and scores begin: states held by friction, sensitivities from elsewhere, clocks without a line.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod support;

use simgap_effects::SiteScale;
use simgap_estimate::{Start, Weights, fit, fit_initial_states, linearise_at, score, score_shapes};
use simgap_model::Location;
use support::{
    Normal, OSCILLATOR, between, candidate, drive, model, noisy, placed, problem, scale, start,
    truth,
};

/// The oscillator with its velocity measured: no sample says how far out it begins.
fn seen_by_its_velocity() -> String {
    OSCILLATOR.replace("kind = \"displacement\"", "kind = \"velocity\"")
}

/// Let go from where its spring overcomes the friction, and measured by its velocity: from rest at zero, where the
/// friction holds it, no small change of the state moves it.
#[test]
fn verify_a_decay_under_friction_is_found_from_rest() {
    let model = model(&seen_by_its_velocity());
    let rubbing = [placed(
        "coulomb_friction",
        between("block", "ground"),
        &[3.0],
    )];
    for x0 in [-0.05, 0.02, 0.04] {
        let run = truth(&model, &rubbing, vec![0.0; 600], 0.005, &[x0, 0.0]);
        let run = noisy(&run, 1e-3, 5);
        let weights = Weights::independent(1);
        let fit = fit_initial_states(&problem(&model, run), &rubbing, &weights).unwrap();
        let found = &fit.estimate.initial[0];
        assert!((found[0] - x0).abs() < 2e-4, "{found:?} for {x0}");
    }
}

/// Damping changes how long a start is remembered: the sensitivities of the plant that is hardly damped would
/// lead nowhere.
#[test]
fn verify_a_fit_does_not_keep_sensitivities_of_another_plant() {
    let model = model(&OSCILLATOR.replace("damping = 6.0", "damping = 0.1"));
    let at = between("block", "ground");
    let damped = [placed("viscous_damping", at.clone(), &[0.3])];
    let run = truth(&model, &damped, drive(0.01, 400, 0.2), 0.01, &[0.05, 1.0]);
    let problem = problem(&model, noisy(&run, 1e-5, 3));
    let search = Weights {
        keep_nuisance: true,
        most_steps: 5,
        ..Weights::independent(1)
    };
    let nominal = ["mass_error", "stiffness_error"].map(|kind| {
        let at = match kind {
            "mass_error" => Location::Mass("block".into()),
            _ => at.clone(),
        };
        placed(kind, at, &[1.0])
    });
    let from = start(vec![], nominal.to_vec(), &[0.0; 2]);
    let base = fit(&problem, &from, &search).unwrap();
    let linear = linearise_at(&problem, &base, &search).unwrap();
    let from = Start {
        effects: vec![placed("viscous_damping", at, &[30.0])],
        ..base.estimate.clone()
    };
    let fitted = linear.fit(&from, &search).unwrap();
    assert!(fitted.variance[0] < 1.2e-10, "{:?}", fitted.variance);
}

/// A weight sags by g m / k, and an offset of the sensor looks like another stiffness: what the motion and the prior
/// say of that leaves a small part of a millionth of the energy of the offset.
#[test]
fn verify_an_offset_beside_a_sag_has_a_score() {
    let text = format!("{OSCILLATOR}[[load]]\nat = \"block\"\nvalue = -8000.0\n");
    let model = model(&text);
    let channel = Location::Channel("y".into());
    let bias = [placed("sensor_bias", channel.clone(), &[0.2])];
    // At rest it hangs ten metres down.
    let run = truth(&model, &bias, drive(0.01, 400, 0.5), 0.01, &[-10.0, 0.0]);
    let problem = problem(&model, noisy(&run, 1e-5, 3));
    let weights = Weights::independent(1);
    let soft = placed("stiffness_error", between("block", "ground"), &[1.0]);
    let heavy = placed("mass_error", Location::Mass("block".into()), &[1.0]);
    let from = start(vec![], vec![soft, heavy], &[-10.0, 0.0]);
    let base = fit(&problem, &from, &weights).unwrap();
    let linear = linearise_at(&problem, &base, &weights).unwrap();
    let scale = SiteScale {
        signal: 1e-3,
        ..scale()
    };
    let scores = score(&linear, &candidate("sensor_bias", channel), &scale).unwrap();
    let asked = scores.first().map(|score| score.start.values[0]);
    assert!(asked.is_some_and(|asked| asked > 0.1), "{asked:?}");
}

/// A spring beside one whose stiffness is free brings next to nothing, however far that one is off; held, it does.
#[test]
fn verify_what_a_free_parameter_explains_is_no_gain() {
    let model = model(OSCILLATOR);
    let at = between("block", "ground");
    let stiff = placed("stiffness_error", at.clone(), &[1.01]);
    let run = truth(&model, &[stiff], drive(0.01, 400, 6.0), 0.01, &[0.0; 2]);
    let problem = problem(&model, noisy(&run, 1e-5, 3));
    let as_given = Weights {
        most_steps: 0,
        ..Weights::independent(1)
    };
    let free = placed("stiffness_error", at.clone(), &[1.0]);
    let spring = candidate("linear_stiffness", at);
    let gain = |effects: Vec<simgap_effects::Placed>| {
        let base = fit(&problem, &start(effects, vec![], &[0.0; 2]), &as_given).unwrap();
        let linear = linearise_at(&problem, &base, &as_given).unwrap();
        let scores = score(&linear, &spring, &scale()).unwrap();
        scores.first().map_or(0.0, |score| score.gain)
    };
    let (beside, alone) = (gain(vec![free]), gain(vec![]));
    assert!(
        beside < 0.01 * alone && alone > 100.0,
        "{beside} of {alone}"
    );
}

/// Beside a broadband motion a stiffness that swings leaves no line; the sweep finds its frequency.
#[test]
fn verify_a_sweep_finds_a_swinging_stiffness() {
    let model = model(OSCILLATOR);
    let at = between("block", "ground");
    let freq = 0.83;
    let swinging = [placed(
        "time_varying_stiffness",
        at.clone(),
        &[120.0, freq, 0.7],
    )];
    let (step, len) = (0.01, 1200);
    let mut normal = Normal(11);
    let force: Vec<f64> = (0..len).map(|_| 30.0 * normal.draw()).collect();
    let run = truth(&model, &swinging, force, step, &[0.0; 2]);
    let problem = problem(&model, noisy(&run, 1e-5, 3));
    let weights = Weights::independent(1);
    let base = fit(&problem, &start(vec![], vec![], &[0.0; 2]), &weights).unwrap();
    let linear = linearise_at(&problem, &base, &weights).unwrap();
    let candidate = candidate("time_varying_stiffness", at);
    let scale = problem.site_scale(&base, &candidate.at).unwrap();
    let sweep = candidate.effect.sweep(&scale);
    let scores = score_shapes(&linear, &candidate, &sweep).unwrap();
    let found = scores[0].start.values[1];
    let resolution = 1.0 / (step * len as f64);
    assert!((found - freq).abs() < 0.5 * resolution, "{found}");
    let lines = candidate.effect.starts(&scale);
    let by_line = lines.iter().any(|s| (s[1] - freq).abs() < 0.5 * resolution);
    assert!(!by_line, "a line would have told");
}
