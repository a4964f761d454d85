//! The adaptive method: accuracy against tolerance, stops at samples, continuous output, refusals.
#![allow(clippy::unwrap_used)]

use crate::support::{free_decay, oscillator};
use faer::Mat;
use simgap_integrate::{
    AdaptiveTolerance, Excitation, Method, Problem, Solution, TimeGrid, dormand_prince, simulate,
};

const OMEGA: f64 = 15.0;
const ZETA: f64 = 0.05;

fn tolerance(relative: f64) -> AdaptiveTolerance {
    AdaptiveTolerance::new(relative, relative * 1e-3, relative * 1e-2).unwrap()
}

/// Free decay over 5 s, 101 samples; largest errors relative to the first amplitude.
fn decay(relative: f64) -> (Solution, [f64; 3]) {
    let matrices = oscillator(OMEGA, ZETA);
    let problem = Problem::new(&matrices)
        .unwrap()
        .with_initial_state(&[0.02], &[0.0])
        .unwrap();
    let grid = TimeGrid::new(1.0, 0.05, 101).unwrap();
    let solution = dormand_prince(&problem, &grid, tolerance(relative)).unwrap();
    let mut error = [0.0_f64; 3];
    for k in 0..101 {
        let (x, v) = free_decay(OMEGA, ZETA, 0.02, 0.0, 0.05 * k as f64);
        let a = -2.0 * ZETA * OMEGA * v - OMEGA * OMEGA * x;
        let motion = &solution.motion;
        error[0] = error[0].max((motion.displacement[(0, k)] - x).abs() / 0.02);
        error[1] = error[1].max((motion.velocity[(0, k)] - v).abs() / (0.02 * OMEGA));
        error[2] = error[2].max((motion.acceleration[(0, k)] - a).abs() / (0.02 * OMEGA * OMEGA));
    }
    (solution, error)
}

/// Error proportional to the tolerance, work to its power −1/5, samples between the steps included.
#[test]
fn verify_error_and_work_follow_the_tolerance() {
    let (mut steps, mut errors) = (Vec::new(), Vec::new());
    for exponent in [-5, -7, -9, -11] {
        let relative = 10f64.powi(exponent);
        let (solution, error) = decay(relative);
        // Errors of the single steps add up over 12 periods.
        assert!(
            error.iter().all(|e| *e < 30.0 * relative),
            "1e{exponent}: {error:?}"
        );
        steps.push(solution.work.steps as f64);
        errors.push(error[0]);
    }
    for pair in 0..3 {
        let work = (steps[pair + 1] / steps[pair]).log10();
        assert!((0.3..0.5).contains(&work), "work: {steps:?}");
        let gain = (errors[pair] / errors[pair + 1]).log10();
        assert!((1.3..2.7).contains(&gain), "error: {errors:?}");
    }
}

#[test]
fn regress_work() {
    let mut table = String::new();
    for exponent in [-4, -6, -8, -10] {
        let work = decay(10f64.powi(exponent)).0.work;
        table += &format!(
            "1e{exponent}: {} steps, {} rejected, {} right-hand sides\n",
            work.steps, work.rejected_steps, work.right_hand_sides
        );
    }
    insta::assert_snapshot!(table);
}

/// A force with a kink at every sample against the classical method with steps that end on them.
#[test]
fn verify_sampled_force_with_kinks() {
    let matrices = oscillator(OMEGA, ZETA);
    let force = Mat::from_fn(1, 81, |_, k| f64::from((k as u32 * 7919) % 13) - 6.0);
    let problem = Problem::new(&matrices)
        .unwrap()
        .with_excitation(Excitation::Sampled(force.as_ref()))
        .unwrap();
    let grid = TimeGrid::new(0.0, 0.03, 81).unwrap();
    let fine = grid.with_substeps(256).unwrap();
    let reference = simulate(&problem, &fine, Method::RungeKutta4)
        .unwrap()
        .motion;
    let solution = dormand_prince(&problem, &grid, tolerance(1e-10)).unwrap();
    let difference = &solution.motion.displacement - &reference.displacement;
    // The reference has (ωh)⁴/120 × angle = 1e-9 × 36/… below 1e-11; the tolerance adds up to 1e-9.
    assert!(difference.norm_max() < 1e-9 * reference.displacement.norm_max());
    let difference = &solution.motion.acceleration - &reference.acceleration;
    assert!(difference.norm_max() < 1e-8 * reference.acceleration.norm_max());
    // No step straddles a kink, so hardly any is refused.
    assert!(
        solution.work.rejected_steps * 10 < solution.work.steps,
        "{:?}",
        solution.work
    );
}

/// The samples that are asked for do not change the steps under a smooth force.
#[test]
fn verify_output_does_not_change_the_steps() {
    let matrices = oscillator(OMEGA, ZETA);
    let push = |t: f64, out: &mut [f64]| out[0] = (4.0 * t).sin();
    let problem = Problem::new(&matrices)
        .unwrap()
        .with_excitation(Excitation::Function(&push))
        .unwrap();
    let run = |h: f64, samples: usize| {
        let grid = TimeGrid::new(0.0, h, samples).unwrap();
        dormand_prince(&problem, &grid, tolerance(1e-7)).unwrap()
    };
    let (coarse, fine) = (run(0.5, 5), run(0.001, 2001));
    assert!(
        coarse.work.steps.abs_diff(fine.work.steps) <= 4,
        "{:?} {:?}",
        coarse.work,
        fine.work
    );
    for k in 0..5 {
        let difference =
            coarse.motion.displacement[(0, k)] - fine.motion.displacement[(0, 500 * k)];
        assert!(difference.abs() < 1e-7, "{difference:e}");
    }
}

#[test]
fn verify_refusals_name_what_was_found() {
    let matrices = oscillator(1.0, 0.0);
    // ẍ = x² − x from far out runs away in finite time.
    let runaway = |_t: f64, x: &[f64], _v: &[f64], g: &mut [f64]| g[0] = -x[0] * x[0];
    let problem = Problem::new(&matrices)
        .unwrap()
        .with_initial_state(&[10.0], &[0.0])
        .unwrap()
        .with_nonlinear_force(&runaway);
    let grid = TimeGrid::new(0.0, 0.1, 100).unwrap();
    let message = dormand_prince(&problem, &grid, tolerance(1e-8))
        .unwrap_err()
        .to_string();
    assert!(message.starts_with("the step shrank to "), "{message}");
    assert!(
        message.contains(" s at t = 1.") || message.contains(" s at t = 0."),
        "{message}"
    );

    let few = tolerance(1e-8).with_step_limit(10);
    let calm = Problem::new(&matrices)
        .unwrap()
        .with_initial_state(&[1.0], &[0.0])
        .unwrap();
    let message = dormand_prince(&calm, &grid, few).unwrap_err().to_string();
    assert!(
        message.starts_with("10 steps were spent at t = "),
        "{message}"
    );
    assert!(
        message.ends_with("needed: the end at 9.9 s within that many"),
        "{message}"
    );

    assert_eq!(
        AdaptiveTolerance::new(0.0, 1.0, 1.0)
            .unwrap_err()
            .to_string(),
        "relative tolerance is 0, needed: at least 1e-14 and less than 1"
    );
}
