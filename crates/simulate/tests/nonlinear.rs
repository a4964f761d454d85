//! Nonlinear forces on the march, against closed forms.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use std::f64::consts::TAU;

use crate::support::{
    between, elliptic_k, force_input, force_output, jacobi_cn, largest_difference, model,
    oscillator, output, placed, predict, rising_zeros, run, sampled,
};
use simgap_effects::Placed;
use simgap_model::Location;
use simgap_simulate::{Run, Simulator, substeps_for};

fn arm() -> simgap_model::Model {
    model(
        &[
            "[[mass]]\nname = \"arm\"\nvalue = 0.02\n",
            "[[pendulum]]\nat = \"arm\"\nvalue = 0.48\n",
            &output("q", "displacement", "arm"),
        ]
        .concat(),
    )
}

/// ω₀ = √(m g l / J) of [`arm`], rad/s.
fn arm_freq_rad() -> f64 {
    (0.48_f64 / 0.02).sqrt()
}

/// Mean period of the arm let go at an angle.
fn period(amplitude: f64, step: f64, len: usize, substeps: usize) -> f64 {
    let angle = &predict(
        &arm(),
        &[],
        substeps,
        &run(step, len, vec![]),
        &[amplitude, 0.0],
    )[0];
    let zeros = rising_zeros(angle, step);
    assert!(zeros.len() > 3);
    (zeros[zeros.len() - 1] - zeros[0]) / (zeros.len() - 1) as f64
}

/// T = (4/ω₀) K(sin(θ/2)); 2π/ω₀ (1 + θ²/16) for small angles.
#[test]
fn verify_the_period_of_a_pendulum_at_small_and_large_angles() {
    // Trapezoidal treatment of the force: (ω₀h)²/12 = 2e-6 at 1 kHz; rounding of the crossings.
    const STEP: f64 = 1e-5;
    let small = std::f64::consts::TAU / arm_freq_rad() * (1.0 + 0.01_f64.powi(2) / 16.0);
    let off = period(0.01, 1e-3, 12_000, 1) / small - 1.0;
    assert!(off.abs() < STEP, "small angle: {off:e}");
    for amplitude in [0.5_f64, 1.5, 2.5, 3.0] {
        let exact = 4.0 / arm_freq_rad() * elliptic_k((0.5 * amplitude).sin());
        let off = period(amplitude, 1e-3, 20_000, 1) / exact - 1.0;
        assert!(off.abs() < STEP, "{amplitude} rad: {off:e}");
    }
}

/// Gravity has a natural frequency too, and coarse records need steps between their samples.
#[test]
fn verify_a_coarsely_sampled_pendulum_is_stepped_finely_enough() {
    // 0.3 % of the nonlinear part is what `substeps_for` promises.
    const PROMISED: f64 = 3e-3;
    let step = 0.16;
    let empty = run(step, 400, vec![]);
    let substeps = substeps_for(&arm(), &[empty]).unwrap();
    assert!(substeps as f64 >= arm_freq_rad() * step / 0.2, "{substeps}");
    for amplitude in [0.05_f64, 0.3, 1.0, 2.0] {
        let exact = 4.0 / arm_freq_rad() * elliptic_k((0.5 * amplitude).sin());
        let off = period(amplitude, step, 4000, substeps) / exact - 1.0;
        // What is marched is gravity beyond its tangent at rest: its slope is up to this of the tangent.
        let nonlinear = 1.0 - amplitude.cos();
        assert!(off.abs() < PROMISED * nonlinear, "{amplitude} rad: {off:e}");
    }
}

/// m ẍ + k x + k₃ x³ = 0 from rest at A: x = A cn(λt, κ), λ² = (k + k₃A²)/m, κ² = k₃A²/(2mλ²).
struct Duffing;

impl Duffing {
    const MASS: f64 = 2.0;
    const STIFFNESS: f64 = 800.0;
    const CUBIC: f64 = 6e6;
    const AMPLITUDE: f64 = 0.02;

    fn exact(t: f64) -> f64 {
        let hardening = Self::CUBIC * Self::AMPLITUDE * Self::AMPLITUDE;
        let lambda = ((Self::STIFFNESS + hardening) / Self::MASS).sqrt();
        let modulus = (hardening / (2.0 * Self::MASS * lambda * lambda)).sqrt();
        Self::AMPLITUDE * jacobi_cn(lambda * t, modulus)
    }

    /// Largest error over half a second at 1 kHz, relative to the amplitude.
    fn error(substeps: usize) -> f64 {
        let text = [
            oscillator(Self::MASS, Self::STIFFNESS, 0.0, "ground"),
            output("x", "displacement", "block"),
        ]
        .concat();
        let cubic = placed(
            "cubic_stiffness",
            between("block", "ground"),
            &[Self::CUBIC],
        );
        let run = run(1e-3, 500, vec![]);
        let predicted = predict(
            &model(&text),
            &[cubic],
            substeps,
            &run,
            &[Self::AMPLITUDE, 0.0],
        );
        largest_difference(&predicted[0], &sampled(1e-3, 500, Self::exact)) / Self::AMPLITUDE
    }
}

#[test]
fn order_a_cubic_spring_is_followed_to_second_order() {
    let errors = [1, 2, 4, 8].map(Duffing::error);
    assert!(errors[0] < 0.02, "{errors:?}");
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!((order - 2.0).abs() < 0.05, "order {order:.3} of {errors:?}");
    }
}

/// A free mass thrown at a damped stop, which pushes from the first touch on and lets go where it would pull:
/// δ = v₀/ω_d e^(−ζωt) sin ω_d t, ω² = k/m, 2ζω = kτ/m, until δ + τ δ' = 0.
struct Blow;

impl Blow {
    const MASS: f64 = 2.0;
    const STOP: [f64; 4] = [0.01, 1.0, 8e4, 2e-3];
    const SPEED: f64 = 0.4;

    /// Where it is when it has come back a while ago, thrown from `start`.
    fn exact(start: f64, end_s: f64) -> f64 {
        let [at, _, stiffness, tau] = Self::STOP;
        let freq = (stiffness / Self::MASS).sqrt();
        let ratio = 0.5 * freq * tau;
        let damped = freq * (1.0 - ratio * ratio).sqrt();
        let turn = (tau * damped).atan2(-(1.0 - tau * ratio * freq));
        let away_s = turn / damped;
        let decay = Self::SPEED * (-ratio * freq * away_s).exp();
        let inside = decay / damped * turn.sin();
        let speed = decay * (turn.cos() - ratio * freq / damped * turn.sin());
        let touched_s = (at - start) / Self::SPEED;
        at + inside + speed * (end_s - touched_s - away_s)
    }

    /// Largest error over all ways in which a step falls on the first touch.
    fn error(substeps: usize) -> f64 {
        let text = [
            "[[mass]]\nname = \"block\"\nvalue = 2.0\n",
            &output("x", "displacement", "block"),
        ]
        .concat();
        let stop = placed("end_stop", between("block", "ground"), &Self::STOP);
        let (step, len) = (1e-3, 90);
        let errors = (0..40).map(|k| {
            let start = -0.005 - f64::from(k) / 40.0 * Self::SPEED * step;
            let simulated = predict(
                &model(&text),
                std::slice::from_ref(&stop),
                substeps,
                &run(step, len, vec![]),
                &[start, Self::SPEED],
            );
            let exact = Self::exact(start, (len - 1) as f64 * step);
            (simulated[0][len - 1] - exact).abs()
        });
        errors.fold(0.0, f64::max)
    }
}

/// An accelerometer is sampled of the jump itself: at the touch it shows all of the damper's force or none.
#[test]
fn verify_a_sample_at_a_blow_shows_the_force_there() {
    let [at, _, stiffness, tau] = Blow::STOP;
    let text = [
        "[[mass]]\nname = \"block\"\nvalue = 2.0\n",
        &output("x", "displacement", "block"),
        &output("v", "velocity", "block"),
        &output("a", "acceleration", "block"),
    ]
    .concat();
    let stop = placed("end_stop", between("block", "ground"), &Blow::STOP);
    for k in 0..20 {
        let start = -0.005 - f64::from(k) / 20.0 * Blow::SPEED * 1e-3;
        let simulated = predict(
            &model(&text),
            std::slice::from_ref(&stop),
            1,
            &run(1e-3, 60, vec![]),
            &[start, Blow::SPEED],
        );
        for n in 0..60 {
            let [x, v, a] = [0, 1, 2].map(|c: usize| simulated[c][n]);
            let pushed = if x > at {
                (x - at + tau * v).max(0.0)
            } else {
                0.0
            };
            let needed = -stiffness * pushed / Blow::MASS;
            assert!((a - needed).abs() < 1e-6 * stiffness, "{a} for {needed}");
        }
    }
}

/// The force jumps at the touch, wherever that falls within a step: of the largest error over all ways to fall, six halvings
/// of the step leave what an order of nearly two does.
#[test]
fn order_a_damped_blow_is_followed_to_nearly_second_order() {
    let errors = [1, 2, 4, 8, 16, 32, 64].map(Blow::error);
    assert!(errors[0] < 3e-5, "{errors:?}");
    let order = (errors[0] / errors[6]).log2() / 6.0;
    assert!(order > 1.7, "order {order:.3} of {errors:?}");
}

/// Dry friction on a spring: every half cycle ends 2 Fc/k lower, until k x is at most Fc.
#[test]
fn verify_friction_takes_the_same_from_every_half_cycle_and_then_holds() {
    let (mass, stiffness, level, start) = (2.0, 800.0, 4.0, 0.0333);
    let text = [
        oscillator(mass, stiffness, 0.0, "ground"),
        output("x", "displacement", "block"),
        output("v", "velocity", "block"),
    ]
    .concat();
    let friction = placed("coulomb_friction", between("block", "ground"), &[level]);
    let predicted = predict(
        &model(&text),
        &[friction],
        4,
        &run(1e-3, 1500, vec![]),
        &[start, 0.0],
    );
    let drop = 2.0 * level / stiffness;
    let half = std::f64::consts::PI * (mass / stiffness).sqrt();
    // A reversal falls between two steps of 0.25 ms: the peak is at most ½ a h² = 5e-7 m off, and
    // the friction acts the wrong way for part of a step at each.
    const STEP: f64 = 2e-6;
    for turn in 0..=3_u32 {
        let peak = predicted[0][(f64::from(turn) * half / 1e-3).round() as usize].abs();
        let wanted = start - f64::from(turn) * drop;
        assert!(
            (peak - wanted).abs() < STEP,
            "turn {turn}: {peak} for {wanted}"
        );
    }
    let held = start - 3.0 * drop;
    assert!(held * stiffness < level, "the example ends here");
    let after = (3.2 * half / 1e-3) as usize;
    let creep = predicted[1][after..]
        .iter()
        .fold(0.0, |top: f64, v| top.max(v.abs()));
    // Zero but for rounding of terms of the size ω x = 0.07 m/s.
    assert!(creep < 1e-14, "it creeps at {creep:e} m/s");
    let rest = predicted[0][after];
    assert!(
        predicted[0][after..]
            .iter()
            .all(|x| (x - rest).abs() < 1e-12)
    );
}

/// Below its level friction holds. Between two steps of h the excitation rises while the friction
/// of the step stands still, so the mass gives way by h² F/(12 m), there and back again: the only
/// motion, and of second order.
#[test]
fn verify_friction_holds_against_any_force_below_its_level() {
    let (mass, level) = (2.0, 10.0);
    let text = [
        "[[mass]]\nname = \"block\"\nvalue = 2.0\n",
        &force_input("block"),
        &output("x", "displacement", "block"),
        &output("v", "velocity", "block"),
        &force_output("F", "block", "ground"),
    ]
    .concat();
    let model = model(&text);
    let moved = |share: f64, substeps: usize| {
        let force = sampled(1e-3, 1000, |t| share * level * (40.0 * t).sin());
        let friction = placed("coulomb_friction", between("block", "ground"), &[level]);
        let run = run(1e-3, 1000, vec![force.clone()]);
        let predicted = predict(&model, &[friction], substeps, &run, &[]);
        let largest = |c: usize| {
            predicted[c]
                .iter()
                .fold(0.0, |top: f64, x| top.max(x.abs()))
        };
        (largest(0), largest(1), predicted[2].clone(), force)
    };
    for substeps in [1, 3, 8] {
        let (travel, speed, carried, force) = moved(0.999, substeps);
        assert!(speed < 1e-12, "it stands still: {speed:e} m/s");
        let h = 1e-3 / substeps as f64;
        let gives = h * h * 0.999 * level / (12.0 * mass);
        assert!(
            (travel / gives - 1.0).abs() < 1e-3,
            "{travel:e} for {gives:e}"
        );
        // The friction of a step balances the mean of the force over it.
        let lag = 0.5 * h * 40.0 * level;
        assert!(
            largest_difference(&carried, &force) < 1.01 * lag,
            "{substeps}"
        );
    }
    assert!(moved(1.05, 3).0 > 1e-5, "above the level it moves");
}

/// Steady sliding under a constant force: a = (u − Fc)/m, friction at its level.
#[test]
fn verify_sliding_friction_is_exact() {
    let text = [
        "[[mass]]\nname = \"block\"\nvalue = 2.0\n",
        &force_input("block"),
        &output("x", "displacement", "block"),
        &force_output("F", "block", "ground"),
    ]
    .concat();
    let friction = placed("coulomb_friction", between("block", "ground"), &[10.0]);
    let run = run(1e-3, 1000, vec![vec![16.0; 1000]]);
    let predicted = predict(&model(&text), &[friction], 1, &run, &[0.0, 0.5]);
    let wanted = sampled(1e-3, 1000, |t| 0.5 * t + 0.5 * 3.0 * t * t);
    assert!(largest_difference(&predicted[0], &wanted) < 1e-10);
    assert!(predicted[1][1..].iter().all(|f| (f - 10.0).abs() < 1e-9));
}

/// The contract: what the members between two nodes carry. A force from outside and gravity on an
/// arm are no members, wherever they push.
#[test]
fn verify_a_force_output_leaves_out_what_no_member_carries() {
    let text = [
        &oscillator(2.0, 800.0, 0.0, "ground"),
        "[[pendulum]]\nat = \"block\"\nvalue = 3.0\n",
        &force_output("F", "block", "ground"),
    ]
    .concat();
    let push = placed("constant_force", Location::Mass("block".into()), &[25.0]);
    let at = [0.1, 0.0];
    let predicted = predict(&model(&text), &[push], 1, &run(1e-3, 8, vec![]), &at);
    assert!(
        (predicted[0][0] - 80.0).abs() < 1e-9,
        "{} N",
        predicted[0][0]
    );
    // A member that the model lacks counts.
    let cubic = placed("cubic_stiffness", between("ground", "block"), &[1000.0]);
    let predicted = predict(&model(&text), &[cubic], 1, &run(1e-3, 8, vec![]), &at);
    assert!(
        (predicted[0][0] - 81.0).abs() < 1e-9,
        "{} N",
        predicted[0][0]
    );
}

/// The effects that a model file lists do what the same effects do when they are put on it.
#[test]
fn verify_effects_of_the_file_and_effects_on_top_are_the_same() {
    let nominal = [
        oscillator(2.0, 800.0, 5.0, "ground"),
        force_input("block"),
        output("x", "displacement", "block"),
    ]
    .concat();
    let listed = r#"
[[effect]]
kind = "stiffness_error"
between = ["ground", "block"]
stiffness_factor = 1.2
[[effect]]
kind = "coulomb_friction"
between = ["block", "ground"]
friction_force_n = 1.5
[[effect]]
kind = "input_gain"
input = "u"
gain_factor = 0.8
[[effect]]
kind = "sensor_bias"
channel = "x"
bias = 0.001
"#;
    let force = sampled(2e-3, 800, |t| 9.0 * (15.0 * t).sin());
    let run = run(2e-3, 800, vec![force]);
    let file = model(&[&nominal, listed].concat());
    let of_file = Simulator::of_file(&file, std::slice::from_ref(&run)).unwrap();
    let effects = [
        placed("stiffness_error", between("block", "ground"), &[1.2]),
        placed("coulomb_friction", between("block", "ground"), &[1.5]),
        placed("input_gain", Location::Input("u".into()), &[0.8]),
        placed("sensor_bias", Location::Channel("x".into()), &[0.001]),
    ];
    let substeps = substeps_for(&file, std::slice::from_ref(&run)).unwrap();
    let on_top = predict(&model(&nominal), &effects, substeps, &run, &[]);
    assert_eq!(of_file.predict(&run, &[]).unwrap(), on_top);
    // The order in which they are listed is no matter where they do not touch one another.
    let bias: Run = run.clone();
    let plain = predict(&model(&nominal), &effects[..3], substeps, &bias, &[]);
    let shifted: Vec<f64> = plain[0].iter().map(|x| x + 0.001).collect();
    assert!(largest_difference(&on_top[0], &shifted) < 1e-15);
}

/// Forces at a member that stands on a support stand on it too: on one that hardly gives way they are those on the
/// ground, on the mass and in the load cell.
#[test]
fn verify_forces_at_a_member_go_with_it_onto_a_support() {
    let text = [
        oscillator(2.0, 800.0, 3.0, "ground"),
        force_input("block"),
        output("y", "displacement", "block"),
        force_output("leg", "block", "ground"),
    ]
    .concat();
    let (nominal, leg) = (model(&text), between("ground", "block"));
    let force = sampled(0.002, 500, |t| 8.0 * (TAU * 4.0 * t).sin());
    let run = run(0.002, 500, vec![force]);
    let predicted = |effects: &[Placed]| predict(&nominal, effects, 8, &run, &[0.0, 0.0]);
    let support = placed(
        "flexible_support",
        leg.clone(),
        &[8e7, 0.01, 0.05, 0.0, 0.0],
    );
    for law in [
        placed("coulomb_friction", leg.clone(), &[2.0]),
        placed("backlash", leg.clone(), &[4e-3]),
        placed("cubic_stiffness", leg.clone(), &[1e7]),
    ] {
        let kind = law.effect.kind();
        let on_ground = predicted(std::slice::from_ref(&law));
        let alone = predicted(std::slice::from_ref(&support));
        let on_support = predicted(&[support.clone(), law]);
        for ((ground, support), alone) in on_ground.iter().zip(&on_support).zip(&alone) {
            // Friction jumps a step earlier or later: one sample is off by all of it.
            let apart = |other: &[f64]| -> f64 {
                let pairs = ground.iter().zip(other);
                pairs.map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
            };
            let size = apart(&vec![0.0; ground.len()]);
            let (off, without) = (apart(support), apart(alone));
            assert!(
                off < 0.05 * size && without > 0.1 * size,
                "{kind}: off by {off}, without it {without}, of {size}"
            );
        }
    }
}
