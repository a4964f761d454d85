//! Effects in the place of others.
#![allow(clippy::unwrap_used)]

use simgap_estimate::{
    FitOptions, Start, fit, fit_initial_states, linearise_at, score_in_place_of,
};
use simgap_model::Location;

use crate::support::{OSCILLATOR, candidate, drive, model, noisy, placed, problem, start, truth};

/// A set point that is renewed every 13.27 samples is fitted as a delay of half of that. What this leaves tells, of all holds about twice
/// as long, the one that a fit finds the way from.
#[test]
fn verify_what_a_delay_leaves_tells_the_hold_it_stands_for() {
    const STEP_S: f64 = 0.005;
    const DURATION_S: f64 = 20.0;
    let hold = [13.27 * STEP_S, 4.1 * STEP_S];
    let at = Location::Input("u".into());
    let model = model(OSCILLATOR);
    let held = placed("held_input", at.clone(), &hold);
    let samples = (DURATION_S / STEP_S) as usize;
    let run = truth(
        &model,
        &[held],
        drive(STEP_S, samples, 5.0),
        STEP_S,
        &[0.0; 2],
    );
    let count = samples as f64;
    let spread = run.measured[0].iter().flatten().map(|y| y * y).sum::<f64>() / count;
    let problem = problem(&model, noisy(&run, 0.003 * spread.sqrt(), 3));
    let options = FitOptions::white(1);
    let delay = placed("input_delay", at.clone(), &[0.5 * hold[0]]);
    let late = fit(&problem, &start(vec![delay], vec![], &[0.0; 2]), &options).unwrap();
    let delay = &late.estimate.effects[0];

    let linear = linearise_at(&problem, &late, &options).unwrap();
    let held = candidate("held_input", at.clone());
    let sizes = problem.site_scale(&late, &at).unwrap();
    let grown = held.effect.grown_from("input_delay", &delay.values, &sizes);
    let best = score_in_place_of(&linear, 0, &held, &grown)
        .unwrap()
        .swap_remove(0);
    assert!(best.gain > 10.0, "{}", best.gain);
    // By the end of the record the grid has not slipped by half of a hold.
    let slips = DURATION_S * (best.start.values[0] / hold[0] - 1.0).abs();
    assert!(slips < 0.5 * hold[0], "{:?}", best.start.values);

    let from = start(vec![best.start], vec![], &late.estimate.initial[0]);
    let found = fit(&problem, &from, &options).unwrap();
    let values = &found.estimate.effects[0].values;
    assert!((values[0] / hold[0] - 1.0).abs() < 3e-4, "{values:?}");
    assert!(found.misfit < late.misfit - best.gain, "{values:?}");
}

/// The clock of a set point knows nothing of when records begin: of each, where its first hold begins is found, and of a record to judge by
/// with the hold as it is known.
#[test]
fn verify_holds_begin_where_they_do_in_each_record() {
    const STEP_S: f64 = 0.005;
    let hold_s = 13.27 * STEP_S;
    let begun = [4.1, 9.7, 0.6].map(|samples| samples * STEP_S);
    let at = Location::Input("u".into());
    let model = model(&OSCILLATOR.replace("displacement", "velocity"));
    let runs = begun.map(|start_s| {
        let held = placed("held_input", at.clone(), &[hold_s, start_s]);
        let mut run = truth(&model, &[held], drive(STEP_S, 3000, 5.0), STEP_S, &[0.0; 2]);
        run.name = format!("{start_s}");
        let square = run.measured[0].iter().flatten().map(|y| y * y).sum::<f64>();
        noisy(&run, 0.003 * (square / 3000.0).sqrt(), 3)
    });
    let [first, second, other] = runs;
    // A record without a motion tells nothing, and hides nothing.
    let still = truth(&model, &[], vec![0.0; 3000], STEP_S, &[0.0; 2]);
    let still = noisy(&still, 1e-5, 7);
    let train = problem(&model, first.clone()).with_runs(vec![first, second, still]);
    let options = FitOptions::white(1);
    let delay = placed("input_delay", at.clone(), &[0.5 * hold_s]);
    let from = Start {
        effects: vec![delay],
        nominal: vec![],
        initial: vec![vec![0.0; 2]; 3],
    };
    let late = fit(&train, &from, &options).unwrap();
    let linear = linearise_at(&train, &late, &options).unwrap();
    let held = candidate("held_input", at.clone());
    let sizes = train.site_scale(&late, &at).unwrap();
    let delay = &late.estimate.effects[0];
    let grown = held.effect.grown_from("input_delay", &delay.values, &sizes);
    let best = score_in_place_of(&linear, 0, &held, &grown)
        .unwrap()
        .swap_remove(0);
    let from = Start {
        effects: vec![best.start],
        nominal: vec![],
        initial: late.estimate.initial.clone(),
    };
    let found = fit(&train, &from, &options).unwrap();
    let near = |found_s: f64, start_s: f64| {
        let holds = (found_s - start_s) / hold_s;
        assert!(
            (holds - holds.round()).abs() < 0.02,
            "{found_s} for {start_s}"
        );
    };
    let effect = &found.estimate.effects[0];
    assert!((effect.values[0] / hold_s - 1.0).abs() < 3e-4);
    for (own, start_s) in effect.of_record.iter().zip(&begun[..2]) {
        near(own[0], *start_s);
    }
    let judged = problem(&model, other);
    let known = placed("held_input", at, &effect.values);
    let found = fit_initial_states(&judged, &[known], &options).unwrap();
    near(found.estimate.effects[0].of_record[0][0], begun[2]);
}
