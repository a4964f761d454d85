//! Where fits and scores begin: states held by friction, sensitivities from elsewhere, clocks without a line.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use std::f64::consts::TAU;

use crate::support::{
    Normal, OSCILLATOR, between, candidate, drive, model, noisy, placed, problem, scale, start,
    truth,
};
use simgap_effects::SiteScale;
use simgap_estimate::{
    FitOptions, Start, fit, fit_initial_states, linearise_at, score, score_shapes,
};
use simgap_model::{Location, Model};
use simgap_simulate::Run;

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
        let weights = FitOptions::white(1);
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
    let search = FitOptions {
        keep_nuisance: true,
        most_steps: 5,
        ..FitOptions::white(1)
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
    let weights = FitOptions::white(1);
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
    let as_given = FitOptions {
        most_steps: 0,
        ..FitOptions::white(1)
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
    let weights = FitOptions::white(1);
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

/// A sensor or an input that is late by many swings of the motion: from a short delay a fit ends in another valley; what was measured,
/// shifted along what is predicted, tells the delay.
#[test]
fn verify_a_long_delay_is_told_by_the_records() {
    let model = model(OSCILLATOR);
    let delay = 1.234;
    let mut normal = Normal(11);
    let force: Vec<f64> = (0..1200).map(|_| 30.0 * normal.draw()).collect();
    let places = [
        ("sensor_delay", Location::Channel("y".into())),
        ("input_delay", Location::Input("u".into())),
    ];
    for (kind, at) in places {
        let late = [placed(kind, at.clone(), &[delay])];
        let run = truth(&model, &late, force.clone(), 0.01, &[0.0; 2]);
        let problem = problem(&model, noisy(&run, 1e-4, 3));
        let weights = FitOptions::white(1);
        let nothing = start(vec![], vec![], &[0.0; 2]);
        let base = fit(&problem, &nothing, &weights).unwrap();
        let scale = problem.site_scale(&base, &at).unwrap();
        assert!((scale.late_s - delay).abs() < 0.011, "{}", scale.late_s);
        let linear = linearise_at(&problem, &base, &weights).unwrap();
        let from = |values: &[f64]| {
            let effects = vec![placed(kind, at.clone(), values)];
            let from = start(effects, vec![], &[0.0; 2]);
            let fitted = fit(&problem, &from, &weights).unwrap();
            fitted.estimate.effects[0].values[0]
        };
        let candidate = candidate(kind, at.clone());
        let scores = score(&linear, &candidate, &scale).unwrap();
        let found = from(&scores[0].start.values);
        assert!((found - delay).abs() < 1e-3, "{kind} of {found} s");
        for short in candidate.effect.starts(&scale) {
            let found = from(&short);
            assert!(
                (found - delay).abs() > 0.1,
                "a short one leads to {found} s"
            );
        }
    }
}

/// A slow slide moves against its damper: that, and what drives it, tell the size of forces, and not its inertia.
#[test]
fn verify_forces_on_a_slow_machine_are_those_that_it_moves_against() {
    let text = |damping: f64| {
        format!(
            "schema = \"simgap-model/1\"\nname = \"slide\"\n\
             [[mass]]\nname = \"slide\"\nvalue = 2.0\n\
             [[damper]]\nname = \"c\"\nbetween = [\"slide\", \"ground\"]\ndamping = {damping}\n\
             [[input]]\nchannel = \"u\"\nkind = \"force\"\nat = \"slide\"\n\
             [[output]]\nchannel = \"v\"\nkind = \"velocity\"\nat = \"slide\"\n"
        )
    };
    let wave = |k: i32| 20.0 * (0.5 * 0.01 * f64::from(k)).sin();
    let force: Vec<f64> = (0..4000).map(wave).collect();
    let scale = |damping: f64, place: &Location| {
        let model = model(&text(damping));
        let run = truth(&model, &[], force.clone(), 0.01, &[0.0; 2]);
        let problem = problem(&model, noisy(&run, 1e-5, 3));
        let nothing = start(vec![], vec![], &[0.0; 2]);
        let base = fit(&problem, &nothing, &FitOptions::white(1)).unwrap();
        problem.site_scale(&base, place).unwrap().force_n
    };
    let driven = 20.0 / 2f64.sqrt();
    for place in [between("slide", "ground"), Location::Mass("slide".into())] {
        let slow = scale(150.0, &place);
        assert!((slow / driven - 1.0).abs() < 0.02, "{place}: {slow}");
        // Against its inertia alone it moves by as much.
        let fast = scale(0.02, &place);
        assert!((fast / driven - 1.0).abs() < 0.02, "{place}: {fast}");
    }
}

/// A slide whose speed alone is measured, and a force that repeats along its way.
const SLIDE: &str = r#"schema = "simgap-model/1"
name = "slide"
[[mass]]
name = "slide"
value = 2.0
[[damper]]
name = "guide"
between = ["slide", "ground"]
damping = 40.0
[[input]]
channel = "u"
kind = "force"
at = "slide"
[[output]]
channel = "v"
kind = "velocity"
at = "slide"
"#;
/// Size, N, and period, m, of the force.
const WAVE: [f64; 2] = [1.0, 0.11];
/// Where the records begin, m.
const BEGIN: [f64; 2] = [0.0, 0.041];

fn along(slide: &Model) -> Vec<Run> {
    let cogging = [placed(
        "position_periodic_force",
        between("slide", "ground"),
        &[WAVE[0], 0.0, WAVE[1]],
    )];
    let run = |x0: f64| truth(slide, &cogging, drive(0.005, 1500, 60.0), 0.005, &[x0, 0.2]);
    BEGIN.map(run).to_vec()
}

/// With the force given, the place that a record begins at is found to a period, wherever it is.
#[test]
fn verify_a_record_is_placed_along_a_travel_that_only_a_wave_shows() {
    let slide = model(SLIDE);
    let mut problem = problem(&slide, along(&slide).swap_remove(1));
    for phase in [0.0_f64, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0] {
        let place = between("slide", "ground");
        let values = [WAVE[0] * phase.cos(), WAVE[0] * phase.sin(), WAVE[1]];
        problem.given = vec![placed("position_periodic_force", place, &values)];
        let fit = fit_initial_states(&problem, &[], &FitOptions::white(1)).unwrap();
        let off = fit.estimate.initial[0][0] + phase / TAU * WAVE[1] - BEGIN[1];
        let turns = off / WAVE[1];
        assert!((turns - turns.round()).abs() < 1e-4, "{turns} for {phase}");
    }
}

/// Records that begin at places of their own share the size and the period of the force: the score finds all of it
/// before a fit, and where the travel is counted from is not asked.
#[test]
fn verify_a_wave_is_found_where_each_record_begins_elsewhere() {
    let slide = model(SLIDE);
    let mut problem = problem(&slide, along(&slide).swap_remove(0));
    problem.runs = along(&slide);
    let weights = FitOptions::white(1);
    let base = fit_initial_states(&problem, &[], &weights).unwrap();
    let linear = linearise_at(&problem, &base, &weights).unwrap();
    let wave = candidate("position_periodic_force", between("slide", "ground"));
    let shape = [0.3, 0.3, WAVE[1]];
    let score = score_shapes(&linear, &wave, &[shape.to_vec()])
        .unwrap()
        .swap_remove(0);
    let apart = |initial: &[Vec<f64>]| {
        let turns = (initial[1][0] - initial[0][0] - (BEGIN[1] - BEGIN[0])) / WAVE[1];
        (turns - turns.round()).abs()
    };
    let begin = score.initial.unwrap();
    assert!(apart(&begin) < 0.1, "{begin:?}");
    assert!(
        (score.start.values[0] / WAVE[0] - 1.0).abs() < 0.2,
        "{:?}",
        score.start.values
    );
    let from = Start {
        effects: vec![score.start],
        nominal: vec![],
        initial: begin,
    };
    let found = fit(&problem, &from, &weights).unwrap();
    let values = &found.estimate.effects[0].values;
    let size = values[0].hypot(values[1]);
    assert!((size / WAVE[0] - 1.0).abs() < 1e-3 && (values[2] / WAVE[1] - 1.0).abs() < 1e-4);
    assert!(apart(&found.estimate.initial) < 1e-3);
    // Known but for where the travel begins: a size and a period with intervals, and a turn that is none.
    let spread = |i: usize| found.intervals[0][i].ci95[1] - found.intervals[0][i].ci95[0];
    assert!(spread(0) < 0.01 * WAVE[0] && spread(1) == 0.0 && spread(2) < 0.01 * WAVE[1]);
}

/// A mass that runs into a damped stop, measured by its acceleration: the force jumps at every blow. A march that does not
/// know when within a step would move in stairs as the stop is moved, and a fit stand still on one.
#[test]
fn verify_a_damped_stop_is_found_through_all_its_blows() {
    let model = model(&OSCILLATOR.replace("kind = \"displacement\"", "kind = \"acceleration\""));
    let at = between("block", "ground");
    let values = [0.02, 1.0, 8e4, 2e-3];
    let stop = [placed("end_stop", at.clone(), &values)];
    let run = truth(&model, &stop, drive(0.002, 4000, 30.0), 0.002, &[0.0; 2]);
    let noise = 0.05;
    let problem = problem(&model, noisy(&run, noise, 11));
    for off in [-0.03, -0.02, -0.01, 0.01, 0.02, 0.03] {
        let from = [
            values[0] * (1.0 + off),
            values[1],
            values[2] * (1.0 - off),
            values[3],
        ];
        let from = placed("end_stop", at.clone(), &from);
        let from = start(vec![from], vec![], &[0.0; 2]);
        let found = fit(&problem, &from, &FitOptions::white(1)).unwrap();
        let left = found.variance[0] / noise.powi(2);
        assert!((left - 1.0).abs() < 0.1, "{left} from {off}");
        let gap = found.estimate.effects[0].values[0];
        assert!((gap / values[0] - 1.0).abs() < 1e-4, "{gap} from {off}");
    }
}

/// A motion of many frequencies times a carrier leaves no line; what is left times the motion has one at the carrier.
#[test]
fn verify_a_carrier_of_a_broad_motion_is_found() {
    const CARRIER_HZ: f64 = 17.0;
    let model = model(OSCILLATOR);
    let mut normal = Normal(7);
    let force: Vec<f64> = (0..4000).map(|_| 30.0 * normal.draw()).collect();
    let at = Location::Channel("y".into());
    let ripple = placed("gain_ripple", at.clone(), &[0.02, CARRIER_HZ, 0.4]);
    let run = noisy(&truth(&model, &[ripple], force, 0.005, &[0.0; 2]), 1e-5, 3);
    let problem = problem(&model, run);
    let fit = fit_initial_states(&problem, &[], &FitOptions::white(1)).unwrap();
    let is_carrier = |line: &f64| (line - CARRIER_HZ).abs() < 1.0 / 20.0;
    assert!(!problem.lines_left(&fit, &at).iter().any(is_carrier));
    assert!(is_carrier(&problem.carriers_left(&fit, &at)[0]));
}

/// A set point that is renewed every 13.27 samples: seen through the plant it is a delay, and what is left beyond that has lines about the
/// rate of the renewals, from which a fit finds the time of a hold and where the first one begins. (A displacement hides them here.)
#[test]
fn verify_a_hold_is_found_from_its_carrier() {
    const STEP_S: f64 = 0.005;
    let hold = [13.27 * STEP_S, 4.1 * STEP_S];
    let at = Location::Input("u".into());
    for kind in ["velocity", "acceleration"] {
        let model = model(&OSCILLATOR.replace("displacement", kind));
        let held = placed("held_input", at.clone(), &hold);
        let run = truth(&model, &[held], drive(STEP_S, 4000, 5.0), STEP_S, &[0.0; 2]);
        let spread = run.measured[0].iter().flatten().map(|y| y * y).sum::<f64>() / 4000.0;
        let problem = problem(&model, noisy(&run, 0.01 * spread.sqrt(), 3));
        let options = FitOptions::white(1);
        let base = fit_initial_states(&problem, &[], &options).unwrap();
        let sizes = problem.site_scale(&base, &at).unwrap();
        assert!(
            (sizes.carriers_hz[0] * hold[0] - 1.0).abs() < 1e-3,
            "{kind}: {sizes:?}"
        );

        let linear = linearise_at(&problem, &base, &options).unwrap();
        let held = candidate("held_input", at.clone());
        let best = score_shapes(&linear, &held, &held.effect.starts(&sizes))
            .unwrap()
            .swap_remove(0);
        let from = start(vec![best.start], vec![], &base.estimate.initial[0]);
        let found = fit(&problem, &from, &options).unwrap();
        let values = &found.estimate.effects[0].values;
        assert!(
            (values[0] / hold[0] - 1.0).abs() < 1e-4,
            "{kind}: {values:?}"
        );
        let begun = found.estimate.effects[0].of_record[0][0];
        let late = (begun - hold[1]) / hold[0];
        assert!((late - late.round()).abs() < 0.02, "{kind}: {values:?}");
    }
}

/// The force that is measured counts for too little. Masses, springs, dampers and the drive that all count for as much less leave nothing
/// either: a fit goes through a narrow valley from there to the sensor, whose one wrong value is likelier than four.
#[test]
fn verify_a_fit_follows_what_changes_in_proportion() {
    let force =
        "[[output]]\nchannel = \"f\"\nkind = \"force\"\nbetween = [\"block\", \"ground\"]\n";
    let model = model(&format!("{OSCILLATOR}{force}"));
    let gain = 0.775;
    let sensor = Location::Channel("f".into());
    let wrong = [placed("sensor_gain", sensor.clone(), &[gain])];
    let mut run = truth(&model, &wrong, drive(0.01, 600, 5.0), 0.01, &[0.0, 0.0]);
    let mut normal = Normal(11);
    for (signal, std) in run.measured.iter_mut().zip([1e-5, 5e-3]) {
        let signal = signal.iter_mut().flatten();
        signal.for_each(|value| *value += std * normal.draw());
    }
    let nominal = [
        placed("mass_error", Location::Mass("block".into()), &[gain]),
        placed("stiffness_error", between("block", "ground"), &[gain]),
        placed("damping_error", between("block", "ground"), &[gain]),
        placed("input_gain", Location::Input("u".into()), &[gain]),
    ];
    let start = start(
        vec![placed("sensor_gain", sensor, &[1.0])],
        nominal.to_vec(),
        &[0.0, 0.0],
    );
    let fit = fit(&problem(&model, run), &start, &FitOptions::white(2)).unwrap();
    let found = fit.estimate.effects[0].values[0];
    // As well as the model states its parameters, half of 2 % each.
    assert!((found / gain - 1.0).abs() < 0.02, "{found}");
}

/// The levels of an actuator in newtons are not those of one in volts: what is known of them before any data goes with the input.
#[test]
fn verify_a_place_in_an_input_has_the_range_of_the_input() {
    let model = model(OSCILLATOR);
    let run = truth(&model, &[], drive(0.01, 400, 2e4), 0.01, &[0.0, 0.0]);
    let low = run.inputs[0].iter().copied().fold(f64::INFINITY, f64::min);
    let high = run.inputs[0]
        .iter()
        .copied()
        .fold(f64::NEG_INFINITY, f64::max);
    let problem = problem(&model, run);
    let fit = fit_initial_states(&problem, &[], &FitOptions::white(1)).unwrap();
    let at = Location::Input("u".into());
    let scale = problem.site_scale(&fit, &at).unwrap();
    assert_eq!(scale.signal_range, [low, high]);
}
