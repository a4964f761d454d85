//! Laws that remember, each against its closed form.
#![allow(clippy::unwrap_used, clippy::panic)]

use crate::common::{self, effect, law};
use proptest::prelude::*;
use simgap_integrate::exact::{ForceLaw, MemberMotion};

/// A few roundings of double precision.
const ROUNDING: f64 = 1e-13;
/// Of the yield force: Runge-Kutta steps of at most 1/(4 n) of the yield displacement, each off by
/// h⁵/120 times the fifth derivative; longer near the level, where that derivative is as much smaller.
const STEPS: f64 = 1e-4;
/// Of the yield force, for moves of 1/300 of the yield displacement: (4/300)⁵/120 a step, as z falls up
/// to four times as fast as the displacement, 300 steps.
const SMALL_STEPS: f64 = 1e-9;

fn assert_near(found: f64, needed: f64, absolute: f64) {
    assert!(
        (found - needed).abs() <= absolute,
        "{found} instead of {needed}"
    );
}

fn at(displacement: f64) -> MemberMotion {
    MemberMotion {
        displacement,
        ..MemberMotion::default()
    }
}

/// Forces after each of a series of moves, from where the law starts at zero.
fn walk(law: &dyn ForceLaw, path: impl IntoIterator<Item = f64>) -> Vec<f64> {
    let (mut memory, mut from) = (law.first_memory(), at(0.0));
    let step = |to: f64| {
        let end = law.follow(memory, from, at(to));
        (memory, from) = (end.memory, at(to));
        end.force
    };
    path.into_iter().map(step).collect()
}

/// From a to b in equal moves, a left out.
fn line(a: f64, b: f64, moves: u32) -> impl Iterator<Item = f64> {
    (1..=moves).map(move |i| a + (b - a) * f64::from(i) / f64::from(moves))
}

const FRICTION: f64 = 50.0;
const SIGMA: f64 = 2e4;

fn dahl(start_share: f64) -> Box<dyn ForceLaw> {
    law(
        "presliding_friction",
        &[FRICTION, FRICTION / SIGMA, 0.0, start_share],
    )
}

/// Loaded from nothing and turned: F = F_c (1 − e^(−σ d / F_c)), then (F₁ + F_c) e^(−σ (d₁ − d) / F_c) − F_c.
#[test]
fn verify_presliding_friction_loads_and_turns() {
    let law = dahl(0.0);
    assert!(law.remembers() && law.dry_level(0.0).is_none());
    let d1 = 0.004;
    let up: Vec<f64> = line(0.0, d1, 7).collect();
    let down: Vec<f64> = line(d1, -d1, 5).collect();
    let found = walk(law.as_ref(), up.iter().chain(&down).copied());
    let loaded = |d: f64| FRICTION * (1.0 - (-SIGMA * d / FRICTION).exp());
    for (d, force) in up.iter().zip(&found) {
        assert_near(*force, loaded(*d), FRICTION * ROUNDING);
    }
    for (d, force) in down.iter().zip(&found[7..]) {
        let decay = (-SIGMA * (d1 - d) / FRICTION).exp();
        let needed = (loaded(d1) + FRICTION) * decay - FRICTION;
        assert_near(*force, needed, FRICTION * ROUNDING);
    }
    // At first it is a spring.
    let spring = walk(law.as_ref(), [1e-9])[0];
    assert_near(spring, SIGMA * 1e-9, 1e-6 * SIGMA * 1e-9);
}

/// Settled between −A and A, it turns at ±F_c tanh(σ A / F_c) = ±F_A and takes 4 F_c (A − F_A / σ)
/// a cycle.
#[test]
fn verify_presliding_friction_settles_into_its_loop() {
    for amplitude in [0.0002, 0.002, 0.01] {
        let law = dahl(0.9);
        let settle = (0..200).flat_map(|_| [amplitude, -amplitude]);
        let moves = 2000;
        let loop_of = line(-amplitude, amplitude, moves).chain(line(amplitude, -amplitude, moves));
        let path: Vec<f64> = settle.chain(loop_of).collect();
        let forces = walk(law.as_ref(), path.iter().copied());
        let turned = FRICTION * (SIGMA * amplitude / FRICTION).tanh();
        assert_near(forces[399], -turned, FRICTION * ROUNDING);
        let work: f64 = (400..path.len())
            .map(|i| 0.5 * (forces[i] + forces[i - 1]) * (path[i] - path[i - 1]))
            .sum();
        let needed = 4.0 * FRICTION * (amplitude - turned / SIGMA);
        // The trapezoidal rule, relative: (σ Δd / F_c)² / 12 with Δd = A / 1000.
        let step = SIGMA * amplitude / FRICTION / 1000.0;
        let curvature = 4.0 * FRICTION * amplitude * step * step / 12.0;
        assert_near(
            work,
            needed,
            curvature.max(FRICTION * amplitude * ROUNDING * 1e3),
        );
    }
}

#[test]
fn verify_presliding_friction_at_its_limits() {
    // Stiff, it is Coulomb's: the level, with the sign of the motion.
    let stiff = law(
        "presliding_friction",
        &[FRICTION, FRICTION / 1e12, 0.0, 0.3],
    );
    let found = walk(stiff.as_ref(), [0.001, 0.002, 0.0019, 0.003]);
    assert_eq!(found, [FRICTION, FRICTION, -FRICTION, FRICTION]);
    // Without friction there is nothing, whatever it starts with.
    for displacement in [FRICTION / SIGMA, 0.0] {
        let none = law("presliding_friction", &[0.0, displacement, 0.1, 0.8]);
        assert_eq!(walk(none.as_ref(), [0.0, 0.1, -0.1]), [0.0; 3]);
    }
    // At rest it holds what it carries.
    let held = dahl(-0.4);
    assert_eq!(walk(held.as_ref(), [0.0, 0.0]), [-0.4 * FRICTION; 2]);
}

/// F = σ₀ z + σ₁ ż with ż = v − σ₀ |v| z / F_c, along a motion that turns, by the classical Runge-Kutta method.
#[test]
fn verify_damped_presliding_friction_is_lugre() {
    let (damping, step) = (60.0, 1e-5);
    let damped = law(
        "presliding_friction",
        &[FRICTION, FRICTION / SIGMA, damping / SIGMA, 0.0],
    );
    let way = |t: f64| 4e-3 * (t * 30.0).sin() + 1e-3 * (t * 110.0).sin();
    let speed = |t: f64| 0.12 * (t * 30.0).cos() + 0.11 * (t * 110.0).cos();
    let rate = |t: f64, z: f64| speed(t) - SIGMA * speed(t).abs() * z / FRICTION;
    let at = |t: f64| MemberMotion {
        displacement: way(t),
        velocity: speed(t),
        time_s: t,
        step_s: 0.0,
    };
    let (mut memory, mut z) = (damped.first_memory(), 0.0);
    let mut worst: f64 = 0.0;
    let mut most: f64 = 0.0;
    for n in 0..40_000 {
        let t = f64::from(n) * step;
        let k1 = rate(t, z);
        let k2 = rate(t + 0.5 * step, z + 0.5 * step * k1);
        let k3 = rate(t + 0.5 * step, z + 0.5 * step * k2);
        let k4 = rate(t + step, z + step * k3);
        z += step / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
        let end = damped.follow(memory, at(t), at(t + step));
        memory = end.memory;
        let needed = SIGMA * z + damping * rate(t + step, z);
        worst = worst.max((end.force - needed).abs());
        most = most.max((end.force - end.memory).abs());
    }
    // Moves in which the motion turns are taken as one; elsewhere (2) is exact.
    assert!(worst < 1e-4 * FRICTION, "{worst}");
    assert!(most > 0.2 * FRICTION, "the damper does {most}");
    // In full sliding it rests.
    let sliding = damped.follow(FRICTION, at(0.0), at(1e-4));
    assert_eq!(sliding.force, FRICTION);
}

#[test]
fn verify_presliding_friction_grows_from_coulomb_friction() {
    let grown =
        effect("presliding_friction").grown_from("coulomb_friction", &[33.0], &common::scale());
    assert!(grown.len() > 1);
    assert!(grown.iter().all(|values| values[0] == 33.0));
    // The presliding displacements differ by more than a factor of five.
    for pair in grown.windows(2) {
        assert!(pair[1][1] > 5.0 * pair[0][1], "{grown:?}");
    }
}

const STIFFNESS: f64 = 4000.0;
const YIELD: f64 = 0.003;

fn bouc_wen(loop_share: f64, exponent: f64, start_share: f64) -> Box<dyn ForceLaw> {
    law(
        "hysteresis",
        &[STIFFNESS, YIELD, loop_share, exponent, start_share],
    )
}

/// z / u_y after each move in yield displacements.
fn shares(law: &dyn ForceLaw, path: impl IntoIterator<Item = f64>) -> Vec<f64> {
    let forces = walk(law, path.into_iter().map(|x| x * YIELD));
    forces.iter().map(|f| f / (STIFFNESS * YIELD)).collect()
}

/// From rest, z = 1 − e⁻ˣ for n = 1 and tanh x for n = 2, in yield displacements, whatever β.
#[test]
fn verify_hysteresis_loads_from_rest() {
    for loop_share in [0.05, 0.5, 1.0, 2.0] {
        for (exponent, loaded) in [
            (1.0, (|x| -f64::exp_m1(-x)) as fn(f64) -> f64),
            (2.0, f64::tanh),
        ] {
            let law = bouc_wen(loop_share, exponent, 0.0);
            for x in [0.01, 0.2, 1.0, 3.6, 4.5, 5.0, 7.0, 300.0, 1e300] {
                let found = shares(law.as_ref(), [x, -x]);
                assert_near(found[0], loaded(x), STEPS);
                let mirrored = shares(law.as_ref(), [-x])[0];
                assert_eq!(mirrored, -found[0]);
            }
            let path: Vec<f64> = line(0.0, 3.0, 900).collect();
            for (x, found) in path.iter().zip(shares(law.as_ref(), path.iter().copied())) {
                assert_near(found, loaded(*x), SMALL_STEPS);
            }
        }
    }
}

/// z / u_y on the way back from 1 over x yield displacements: −u for u = |z| falling as
/// du/dx = −(1 + c uⁿ), c = 2β − 1, then loading the other way.
fn turned(loop_share: f64, exponent: f64, x: f64) -> f64 {
    let c = 2.0 * loop_share - 1.0;
    let root = c.abs().sqrt();
    let (to_zero, left): (f64, f64) = if exponent == 1.0 {
        if c == 0.0 {
            (1.0, 1.0 - x)
        } else {
            (c.ln_1p() / c, (1.0 + 1.0 / c) * (-c * x).exp() - 1.0 / c)
        }
    } else if c > 0.0 {
        let angle = root.atan();
        (angle / root, (angle - root * x).tan() / root)
    } else if c < 0.0 {
        let angle = root.atanh();
        (angle / root, (angle - root * x).tanh() / root)
    } else {
        (1.0, 1.0 - x)
    };
    if x <= to_zero {
        left
    } else if exponent == 1.0 {
        (to_zero - x).exp_m1()
    } else {
        (to_zero - x).tanh()
    }
}

#[test]
fn verify_hysteresis_turns() {
    for loop_share in [0.05, 0.3, 0.5, 0.8, 1.0, 2.0] {
        for exponent in [1.0, 2.0] {
            let law = bouc_wen(loop_share, exponent, 1.0);
            for x in [0.01, 0.24, 0.3, 0.9, 1.1, 2.5, 6.0, 40.0] {
                let needed = turned(loop_share, exponent, x);
                let found = shares(law.as_ref(), [-x])[0];
                assert_near(found, needed, STEPS);
            }
            let path: Vec<f64> = line(0.0, -6.0, 1800).collect();
            for (x, found) in path.iter().zip(shares(law.as_ref(), path.iter().copied())) {
                assert_near(found, turned(loop_share, exponent, -x), SMALL_STEPS);
            }
        }
    }
}

#[test]
fn verify_dahl_is_bouc_wen_without_gamma() {
    let dahl = law("presliding_friction", &[STIFFNESS * YIELD, YIELD, 0.0, 0.2]);
    let bouc_wen = bouc_wen(1.0, 1.0, 0.2);
    let path = [0.001, 0.0015, -0.002, 0.004, 0.0041, 0.0];
    let pairs = walk(dahl.as_ref(), path)
        .into_iter()
        .zip(walk(bouc_wen.as_ref(), path));
    for (needed, found) in pairs {
        assert_near(found, needed, STEPS * STIFFNESS * YIELD);
    }
}

#[test]
fn verify_hysteresis_of_an_exponent_between_is_between() {
    for x in [0.1, 0.4, 1.5] {
        let [one, middle, two, four] =
            [1.0, 1.5, 2.0, 4.0].map(|n| shares(bouc_wen(0.5, n, 0.0).as_ref(), [x])[0]);
        assert!(one < middle && middle < two && two < four, "{x}");
    }
}

proptest! {
    /// The way counts, not how it is cut into moves.
    #[test]
    fn prop_hysteresis_is_the_same_in_one_move_or_many(
        loop_share in 0.05..2.0, exponent in 1.0..4.0, start in -1.0..1.0, x in -40.0..40.0,
    ) {
        let law = bouc_wen(loop_share, exponent, start);
        let once = shares(law.as_ref(), [x])[0];
        let often = *shares(law.as_ref(), line(0.0, x, 4000)).last().unwrap();
        prop_assert!((once - often).abs() < STEPS, "{once} {often}");
    }

    /// However it moves, the force stays within its level, and a long way one way leads there.
    #[test]
    fn prop_memory_stays_within_the_level(
        loop_share in 0.05..2.0, exponent in 1.0..4.0, start in -1.0..1.0,
        path in prop::collection::vec(-1e3..1e3, 1..20),
    ) {
        let law = bouc_wen(loop_share, exponent, start);
        for z in shares(law.as_ref(), path.iter().copied()) {
            prop_assert!(z.abs() <= 1.0 + ROUNDING);
        }
        let last = shares(law.as_ref(), path.iter().copied().chain([2e3]));
        prop_assert!((last.last().unwrap() - 1.0).abs() < SMALL_STEPS);
        for force in walk(dahl(start).as_ref(), path.iter().copied()) {
            prop_assert!(force.abs() <= FRICTION * (1.0 + ROUNDING));
        }
    }
}

/// Within the travel of a record it yields, or slides; beyond that nothing is seen of the loop.
#[test]
fn verify_what_never_yields_is_no_hysteresis_and_what_never_slides_no_friction() {
    let scale = common::scale();
    let travel = scale.travel_m;
    let yields = |at: f64| effect("hysteresis").has_support(&[100.0, at, 0.5, 1.0, 0.0], &scale);
    let slides = |at: f64| effect("presliding_friction").has_support(&[3.0, at, 0.0, 0.0], &scale);
    assert!(yields(travel) && slides(travel));
    assert!(!yields(1.01 * travel) && !slides(1.01 * travel));
    for kind in ["hysteresis", "presliding_friction"] {
        let starts = effect(kind).starts(&scale);
        assert!(
            starts
                .iter()
                .all(|values| effect(kind).has_support(values, &scale))
        );
    }
}
