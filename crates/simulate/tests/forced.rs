//! Forces of time alone on the march, against closed forms.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use std::f64::consts::TAU;

use crate::support::{model, oscillator, output, placed, predict, run};
use simgap_model::Location;

/// m ẍ + k x = A sin(ωt + φ) on its steady state x = A sin(ωt + φ) / (k − m ω²): the largest errors of displacement,
/// velocity and acceleration over 200 samples, relative to their amplitudes.
fn errors(samples_a_period: f64, substeps: usize) -> [f64; 3] {
    const MASS: f64 = 2.0;
    const STIFFNESS: f64 = 1.8e4;
    const FORCE: f64 = 5.0;
    const PHASE: f64 = 0.4;
    let freq_hz = 17.0;
    let omega = TAU * freq_hz;
    let step = 1.0 / (freq_hz * samples_a_period);
    let text = [
        oscillator(MASS, STIFFNESS, 0.0, "ground"),
        output("x", "displacement", "block"),
        output("v", "velocity", "block"),
        output("a", "acceleration", "block"),
    ]
    .concat();
    let at = Location::Mass("block".into());
    let tone = placed("harmonic_force", at, &[FORCE, freq_hz, PHASE]);
    let size = FORCE / (STIFFNESS - MASS * omega * omega);
    let exact = |t: f64| {
        let (sin, cos) = (omega * t + PHASE).sin_cos();
        [size * sin, omega * size * cos, -omega * omega * size * sin]
    };
    let [x, v, _] = exact(0.0);
    let still = run(step, 200, vec![]);
    let predicted = predict(&model(&text), &[tone], substeps, &still, &[x, v]);
    let error = |channel: usize| {
        let samples = predicted[channel].iter().enumerate();
        let errors = samples.map(|(n, y)| (y - exact(n as f64 * step)[channel]).abs());
        errors.fold(0.0, f64::max) / (size.abs() * omega.powi(channel as i32))
    };
    [0, 1, 2].map(error)
}

/// Seven samples a period: straight lines between them would leave 7 % of the force out; three, a third of it.
#[test]
fn verify_a_tone_of_few_samples_a_period_pushes_as_much_as_it_does() {
    for (samples_a_period, largest) in [(7.0, 2e-3), (3.0, 0.08)] {
        let errors = errors(samples_a_period, 1);
        assert!(
            errors.iter().all(|error| *error < largest),
            "{errors:?} at {samples_a_period} samples a period"
        );
    }
}

/// What is left are the images of the tone between the samples, of the square of the step.
#[test]
fn order_of_the_displacement_under_a_tone() {
    let errors = [1, 2, 4, 8].map(|substeps| errors(7.0, substeps)[0]);
    let order = (errors[0] / errors[3]).log2() / 3.0;
    assert!(order > 1.9, "order {order:.3} of {errors:?}");
}
