//! Filled samples count for nothing, and nothing lives in the single samples of a resampled run.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use crate::support::{OSCILLATOR, between, drive, model, noisy, placed, start, truth};
use simgap_effects::{Placed, catalogue};
use simgap_estimate::{Fit, FitOptions, Problem, Whitening, fit};
use simgap_model::{Location, Model};
use simgap_simulate::{Mended, Run};

const ROWS: usize = 600;
const NOISE_M: f64 = 1e-5;
const SINGLE: [&str; 5] = [
    "dropouts",
    "outliers",
    "alternating_timing",
    "alternating_gain",
    "clock_skew",
];

fn stiffer() -> Placed {
    placed("stiffness_error", between("block", "ground"), &[1.1])
}

fn run(model: &Model) -> Run {
    let run = truth(
        model,
        &[stiffer()],
        drive(0.01, ROWS, 2.0),
        0.01,
        &[0.0, 0.0],
    );
    noisy(&run, NOISE_M, 11)
}

/// Every seventh sample is filled with something else.
fn filled(run: &Run, with: impl Fn(usize) -> f64) -> Run {
    let mut run = run.clone();
    let is_filled = |k: &usize| k % 7 == 3;
    let values = run.measured[0].as_mut().unwrap();
    for k in (0..ROWS).filter(is_filled) {
        values[k] = with(k);
    }
    run.mended = Mended {
        filled: vec![(0..ROWS).map(|k| is_filled(&k)).collect()],
        is_resampled: false,
    };
    run
}

fn fitted(model: &Model, run: Run, whitening: &Whitening) -> Fit {
    let mut problem = Problem::new(model, vec![run]).unwrap();
    problem.whitening = whitening.clone();
    let nominal = placed("stiffness_error", between("block", "ground"), &[1.0]);
    let from = start(vec![], vec![nominal], &[0.0; 2]);
    // The prior would hold the factor back.
    let weights = FitOptions {
        nominal_std: Some(1.0),
        ..FitOptions::white(1)
    };
    fit(&problem, &from, &weights).unwrap()
}

/// Whatever stands in the place of a missing sample, it moves nothing but the spread of the channel that accuracies
/// are relative to, and what is left is the noise.
#[test]
fn verify_filled_samples_count_for_nothing() {
    let model = model(OSCILLATOR);
    let run = run(&model);
    let white = Whitening::default();
    // A filter of two coefficients, of a process with the autocovariance 1, 0.5, 0.3.
    let coloured: Vec<f64> = (0..4000).map(|k| f64::from(k % 5)).collect();
    let filter = Whitening::of_noise(&[vec![&coloured]], &[1.0], 2);
    assert_eq!(filter.order(0), 2);
    for whitening in [white, filter] {
        let small = fitted(
            &model,
            filled(&run, |k| 1e-3 * (k as f64).sin()),
            &whitening,
        );
        let large = fitted(
            &model,
            filled(&run, |k| 2e-2 * (k as f64).cos()),
            &whitening,
        );
        let factor = |fit: &Fit| fit.estimate.nominal[0].values[0];
        assert!((factor(&small) - 1.1).abs() < 1e-3, "{}", factor(&small));
        assert!((factor(&small) - factor(&large)).abs() < 1e-7);
        let whole = fitted(&model, run.clone(), &whitening).variance[0];
        for fit in [&small, &large] {
            // Of 514 of 600 samples, the variance is that of the noise within six percent (one standard error).
            assert!(
                (fit.variance[0] / whole - 1.0).abs() < 0.15,
                "{:?}",
                fit.variance
            );
            let left = &fit.discrepancy[0][0];
            assert!((0..ROWS).filter(|k| k % 7 == 3).all(|k| left[k] == 0.0));
        }
    }
}

#[test]
fn verify_what_lives_in_single_samples_is_not_sought_where_all_were_moved() {
    let model = model(OSCILLATOR);
    let taken = run(&model);
    let mut moved = taken.clone();
    moved.mended.is_resampled = true;
    let kinds = |runs: Vec<Run>| -> Vec<&str> {
        let problem = Problem::new(&model, runs).unwrap();
        let all = problem.candidates(|_| true).into_iter();
        all.map(|candidate| candidate.effect.kind()).collect()
    };
    let (all, left) = (kinds(vec![taken.clone()]), kinds(vec![moved.clone()]));
    let missing: Vec<&str> = all.iter().copied().filter(|k| !left.contains(k)).collect();
    let in_order = catalogue().iter().map(|effect| effect.kind());
    let needed: Vec<&str> = in_order.filter(|kind| SINGLE.contains(kind)).collect();
    assert_eq!(missing, needed);
    assert_eq!(kinds(vec![taken.clone(), moved.clone()]), all);

    // In one run there is an alternation, in the other there is nothing it could be of.
    let channel = Location::Channel("y".into());
    let alternation = [placed("alternating_gain", channel, &[0.1, 0.5])];
    let problem = Problem::new(&model, vec![taken, moved]).unwrap();
    let predicted = |effects: &[Placed], run: usize| {
        let simulator = problem.simulator(effects, run).unwrap();
        simulator.predict(&problem.runs[run], &[0.0; 2]).unwrap()
    };
    assert_ne!(predicted(&alternation, 0), predicted(&[], 0));
    assert_eq!(predicted(&alternation, 1), predicted(&[], 1));
}
