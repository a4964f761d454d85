//! A force that keeps its values between samples, against the closed form.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use crate::support::{model, oscillator, output, predict, run};

const MASS: f64 = 2.0;
const STIFFNESS: f64 = 800.0;

/// Two levels for 5 to 14 samples each, of a force that is zero at first.
fn jumps(samples: usize) -> Vec<f64> {
    let mut force = vec![0.0; 10];
    let mut level = 3.0;
    for k in 0_usize.. {
        force.extend(std::iter::repeat_n(level, 5 + 7 * k % 10));
        level = -level;
        if force.len() > samples {
            break;
        }
    }
    force.truncate(samples);
    force
}

/// Largest error of displacement, velocity and acceleration over their largest values: of m ẍ + k x = u under a constant u,
/// with w² = k/m, x − u/k turns as cos wt and sin wt.
fn errors(samples_a_period: f64) -> [f64; 3] {
    let omega = (STIFFNESS / MASS).sqrt();
    let step = std::f64::consts::TAU / omega / samples_a_period;
    let force = jumps(600);
    let (sin, cos) = (omega * step).sin_cos();
    let (mut x, mut v) = (0.0, 0.0);
    let exact: Vec<[f64; 3]> = force
        .iter()
        .map(|u| {
            let now = [x, v, (u - STIFFNESS * x) / MASS];
            let off = x - u / STIFFNESS;
            (x, v) = (
                u / STIFFNESS + off * cos + v / omega * sin,
                v * cos - omega * off * sin,
            );
            now
        })
        .collect();
    let text = [
        oscillator(MASS, STIFFNESS, 0.0, "ground"),
        "[[input]]\nchannel = \"u\"\nkind = \"force\"\nat = \"block\"\nbetween_samples = \"held\"\n".into(),
        output("x", "displacement", "block"),
        output("v", "velocity", "block"),
        output("a", "acceleration", "block"),
    ]
    .concat();
    let predicted = predict(
        &model(&text),
        &[],
        1,
        &run(step, 600, vec![force]),
        &[0.0, 0.0],
    );
    [0, 1, 2].map(|channel| {
        let size = exact
            .iter()
            .map(|now| now[channel].abs())
            .fold(0.0, f64::max);
        let apart = predicted[channel].iter().zip(&exact);
        apart
            .map(|(y, now)| (y - now[channel]).abs())
            .fold(0.0, f64::max)
            / size
    })
}

/// Straight lines through the samples would be off by half an interval: 8 % of the motion at 40 samples a period.
#[test]
fn verify_a_held_force_pushes_as_held() {
    let [x, v, a] = errors(40.0);
    assert!(x < 1e-4 && v < 1e-3 && a < 1e-4, "{x} {v} {a}");
    let finer = errors(80.0);
    assert!(
        finer[0] < x / 1.5 && finer[1] < v / 1.5,
        "{finer:?} {x} {v}"
    );
}

#[test]
fn verify_a_displacement_is_not_held() {
    let text = [
        "schema = \"simgap-model/1\"\nname = \"table\"\n".to_string(),
        oscillator(MASS, STIFFNESS, 0.0, "table"),
        "[[input]]\nchannel = \"u\"\nkind = \"displacement\"\nat = \"table\"\nbetween_samples = \"held\"\n".into(),
        output("x", "displacement", "block"),
    ]
    .concat();
    let error = simgap_model::Model::from_toml(&text)
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("between_samples = \"held\"") && error.contains("smooth"),
        "{error}"
    );
}
