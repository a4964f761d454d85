//! The exact propagation: closed forms for the linear part, order for the nonlinear forces.
#![allow(clippy::unwrap_used)]

use faer::{Mat, mat};
use simgap_integrate::exact::{
    Element, ExactPropagator, Excitation, ForceLaw, MemberMotion, Snapshot,
};
use simgap_model::{Node, StructuralMatrices};

/// Rounding accumulated over some thousand steps.
const ROUNDING: f64 = 1e-11;

fn one(m: f64, c: f64, k: f64) -> StructuralMatrices {
    StructuralMatrices {
        mass_matrix: mat![[m]],
        damping_matrix: mat![[c]],
        stiffness_matrix: mat![[k]],
    }
}

struct Law(fn(MemberMotion) -> f64);
impl ForceLaw for Law {
    fn force(&self, motion: MemberMotion) -> f64 {
        (self.0)(motion)
    }
}

struct Coulomb(f64);
impl ForceLaw for Coulomb {
    fn force(&self, _: MemberMotion) -> f64 {
        0.0
    }
    fn dry_level(&self, _: f64) -> Option<f64> {
        Some(self.0)
    }
}

fn to_ground(law: impl ForceLaw + 'static) -> Vec<Element> {
    vec![Element::between(Node::Dof(0), Node::Ground, Box::new(law))]
}

/// Marches one mass; returns displacement, velocity, acceleration and element force per sample.
fn march(
    structure: &StructuralMatrices,
    elements: &[Element],
    step: f64,
    substeps: usize,
    force: &[f64],
    start: [f64; 2],
) -> Vec<[f64; 4]> {
    let propagator = ExactPropagator::new(structure, step / substeps as f64).unwrap();
    let excitation = Excitation {
        dof_force: force,
        base_displacement: &[],
        base_velocity: &[],
        base_count: 0,
        sample_count: force.len(),
        start_s: 0.0,
        substeps,
    };
    let mut path = Vec::new();
    propagator.march(
        elements,
        &excitation,
        &start[..1],
        &start[1..],
        &mut |at: &Snapshot<'_>| {
            let mut a = [0.0];
            propagator.acceleration(at, &mut a);
            let carried = at.element_force.first().copied().unwrap_or(0.0);
            path.push([at.displacement[0], at.velocity[0], a[0], carried]);
        },
    );
    path
}

#[test]
fn verify_free_decay() {
    let (m, c, k) = (2.0, 3.0, 800.0);
    let path = march(&one(m, c, k), &[], 0.05, 1, &vec![0.0; 200], [0.01, -0.2]);
    let (d, w) = (
        c / (2.0 * m),
        (k / m - (c / (2.0 * m)) * (c / (2.0 * m))).sqrt(),
    );
    for (i, at) in path.iter().enumerate() {
        let t = i as f64 * 0.05;
        let exact = (-d * t).exp() * (0.01 * (w * t).cos() + (-0.2 + d * 0.01) / w * (w * t).sin());
        assert!((at[0] - exact).abs() < ROUNDING, "sample {i}");
    }
}

#[test]
fn verify_ramp_is_exact_at_any_step_and_stiffness() {
    // f = r t: particular solution x = (r/k) (t − c/k); started on it, it stays on it.
    for (m, c, k, h) in [
        (1.0, 2.0, 50.0, 0.3),
        (33e3, 3e5, 8e6, 0.01),
        (1.0, 1e3, 1e12, 0.001),
    ] {
        let r = 4.0;
        let force: Vec<f64> = (0..50).map(|i| r * i as f64 * h).collect();
        let start = [-r * c / (k * k), r / k];
        for (i, at) in march(&one(m, c, k), &[], h, 1, &force, start)
            .iter()
            .enumerate()
        {
            let exact = r / k * (i as f64 * h - c / k);
            assert!(
                (at[0] - exact).abs() <= 1e-9 * (r / k * 50.0 * h),
                "{k}: {i}"
            );
        }
    }
}

#[test]
fn verify_free_mass_under_constant_force() {
    let path = march(&one(4.0, 0.0, 0.0), &[], 0.1, 1, &[2.0; 100], [1.0, -1.0]);
    for (i, at) in path.iter().enumerate() {
        let t = i as f64 * 0.1;
        assert!((at[0] - (1.0 - t + 0.25 * t * t)).abs() < ROUNDING);
        assert!((at[2] - 0.5).abs() < ROUNDING);
    }
}

#[test]
fn verify_sliding_with_coulomb_friction() {
    // m x'' = −F sgn(x'): stops after v₀ m / F at v₀² m / 2F and stays.
    let (m, f, v0) = (3.0, 6.0, 1.0);
    let path = march(
        &one(m, 0.0, 0.0),
        &to_ground(Coulomb(f)),
        0.01,
        1,
        &[0.0; 101],
        [0.0, v0],
    );
    for (i, at) in path.iter().enumerate() {
        let t = (i as f64 * 0.01).min(v0 * m / f);
        let exact = v0 * t - 0.5 * f / m * t * t;
        assert!(
            (at[0] - exact).abs() < 1e-4 * exact.max(1e-2),
            "sample {i}: {} {exact}",
            at[0]
        );
    }
    assert_eq!(path[100][1], 0.0);
}

#[test]
fn verify_sticking_carries_the_force_without_ringing() {
    // Below break-away the friction carries exactly the excitation; above it the rest accelerates.
    let force: Vec<f64> = (0..400).map(|i| 8.0 * (i as f64 * 0.02).sin()).collect();
    let path = march(
        &one(1.0, 0.0, 0.0),
        &to_ground(Coulomb(10.0)),
        0.01,
        2,
        &force,
        [0.0, 0.0],
    );
    // Dry force held over a step against a force that changes linearly leaves a displacement of
    // h² Δf / 12 m a step, which telescopes to at most h² max f / 12 m.
    let bound = 0.005_f64.powi(2) * 8.0 / 12.0;
    for (i, at) in path.iter().enumerate() {
        assert!(at[0].abs() <= bound && at[1].abs() < 1e-12);
        assert!(
            (at[3] - force[i]).abs() < 0.1,
            "sample {i}: {} against {}",
            at[3],
            force[i]
        );
    }
}

#[test]
fn order_of_the_nonlinear_force() {
    // Duffing: the nonlinear force is second order in the step.
    let end = |substeps: usize| {
        let force: Vec<f64> = (0..41).map(|i| 30.0 * (i as f64 * 0.5).sin()).collect();
        let law = to_ground(Law(|m| {
            4e3 * m.displacement.powi(3) + 2.0 * m.velocity * m.velocity.abs()
        }));
        march(
            &one(1.0, 0.5, 100.0),
            &law,
            0.05,
            substeps,
            &force,
            [0.1, 0.0],
        )[40][0]
    };
    let reference = end(2048);
    let errors: Vec<f64> = [8, 16, 32, 64]
        .iter()
        .map(|&s| (end(s) - reference).abs())
        .collect();
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!((order - 2.0).abs() < 0.1, "observed order {order}");
    }
}

/// Observed order of a driven oscillator with a dry force, and its errors at 4, 16 and 64 steps a sample.
fn order_with(law: impl Fn() -> Vec<Element>) -> (f64, Vec<f64>) {
    let end = |substeps: usize| {
        let force: Vec<f64> = (0..61).map(|i| 60.0 * (i as f64 * 0.31).sin()).collect();
        let plant = one(1.0, 0.5, 100.0);
        march(&plant, &law(), 0.05, substeps, &force, [0.1, 0.0])[60][0]
    };
    let reference = end(4096);
    let errors: Vec<f64> = [4, 16, 64]
        .iter()
        .map(|&s| (end(s) - reference).abs())
        .collect();
    ((errors[0] / errors[2]).log2() / 4.0, errors)
}

#[test]
fn order_of_the_dry_force() {
    // Friction reverses within the steps: the share of a step before each reversal is resolved, so that the
    // error falls faster than in proportion to the step.
    let (order, errors) = order_with(|| to_ground(Coulomb(9.0)));
    assert!(order > 1.6, "observed order {order}, errors {errors:?}");
    assert!(errors[0] < 1e-3 * 0.6, "relative to the motion: {errors:?}");
}

#[test]
fn order_of_a_dry_force_that_depends_on_the_speed() {
    // It slides through the Stribeck speed and back within a few steps: the mean over a step is that at its
    // mean speed. With that at its end the order is one.
    struct Stribeck;
    impl ForceLaw for Stribeck {
        fn force(&self, _: MemberMotion) -> f64 {
            0.0
        }

        fn dry_level(&self, speed: f64) -> Option<f64> {
            Some(5.0 + 4.0 * (-(speed / 0.4).powi(2)).exp())
        }
    }
    let (order, errors) = order_with(|| to_ground(Stribeck));
    assert!(order > 1.6, "observed order {order}, errors {errors:?}");
}

#[test]
fn verify_a_spring_as_element_is_the_spring() {
    // The same stiffness and damping, once in the matrices and once as a law on top.
    let force: Vec<f64> = (0..300).map(|i| (0.11 * i as f64).sin()).collect();
    let inside = march(&one(1.0, 4.0, 900.0), &[], 0.01, 64, &force, [0.0, 0.0]);
    let law = to_ground(Law(|m| 900.0 * m.displacement + 4.0 * m.velocity));
    let on_top = march(&one(1.0, 0.0, 0.0), &law, 0.01, 64, &force, [0.0, 0.0]);
    for (a, b) in inside.iter().zip(&on_top) {
        assert!((a[0] - b[0]).abs() < 2e-6 * 2e-3 && (a[2] - b[2]).abs() < 1e-3);
    }
}

#[test]
fn verify_a_hard_stop_returns_the_mass() {
    // Contact resolved by h sqrt(k/m) = 0.25: the mass comes back as fast as it went, and
    // penetrates v sqrt(m/k).
    let stop = to_ground(Law(|m| {
        if m.displacement > 0.0 {
            1e6 * m.displacement
        } else {
            0.0
        }
    }));
    let path = march(
        &one(1.0, 0.0, 0.0),
        &stop,
        0.001,
        4,
        &[0.0; 2000],
        [-0.5, 1.0],
    );
    let deepest = path.iter().map(|at| at[0]).fold(0.0, f64::max);
    // The record may miss the peak by half a sample: cos(0.5) of it is seen at least.
    assert!(
        deepest < 1.02e-3 && deepest > 0.98e-3 * 0.5_f64.cos(),
        "penetration {deepest}"
    );
    assert!(
        (path[1999][1] + 1.0).abs() < 0.02,
        "velocity {}",
        path[1999][1]
    );
}

#[test]
fn verify_two_elements_between_two_masses() {
    // Newton's third law: momentum is kept by forces between the masses, whatever they are.
    let structure = StructuralMatrices {
        mass_matrix: mat![[2.0, 0.0], [0.0, 5.0]],
        damping_matrix: Mat::zeros(2, 2),
        stiffness_matrix: Mat::zeros(2, 2),
    };
    let between = |law: Box<dyn ForceLaw>| Element::between(Node::Dof(0), Node::Dof(1), law);
    let elements = [
        between(Box::new(Coulomb(0.5))),
        between(Box::new(Law(|m| 3e3 * m.displacement.powi(3)))),
    ];
    let propagator = ExactPropagator::new(&structure, 0.001).unwrap();
    let excitation = Excitation {
        dof_force: &[0.0; 2000],
        base_displacement: &[],
        base_velocity: &[],
        base_count: 0,
        sample_count: 1000,
        start_s: 0.0,
        substeps: 1,
    };
    let mut last = 0.0;
    propagator.march(
        &elements,
        &excitation,
        &[0.1, 0.0],
        &[1.0, -0.3],
        &mut |at| {
            let momentum = 2.0 * at.velocity[0] + 5.0 * at.velocity[1];
            assert!((momentum - 0.5).abs() < ROUNDING, "sample {}", at.sample);
            last = (at.velocity[0] - at.velocity[1]).abs();
        },
    );
    assert!(last < 1.3, "friction has taken energy");
}

/// A spring, a damper and friction as one law.
struct Together;
impl ForceLaw for Together {
    fn force(&self, at: MemberMotion) -> f64 {
        stiffening(at) + braking(at)
    }
    fn dry_level(&self, _: f64) -> Option<f64> {
        Some(1.5)
    }
}

fn stiffening(at: MemberMotion) -> f64 {
    2e4 * at.displacement.powi(3)
}

fn braking(at: MemberMotion) -> f64 {
    3.0 * at.velocity * at.velocity.abs()
}

#[test]
fn verify_laws_at_one_port_act_as_their_sum() {
    let force: Vec<f64> = (0..600)
        .map(|k| 6.0 * (0.03 * f64::from(k)).sin() + 3.0 * (0.017 * f64::from(k)).cos())
        .collect();
    let structure = one(1.0, 0.4, 200.0);
    let path = |elements: &[Element]| march(&structure, elements, 0.01, 1, &force, [0.02, -0.3]);
    let apart = path(
        &[
            to_ground(Law(stiffening)),
            to_ground(Coulomb(1.5)),
            to_ground(Law(braking)),
        ]
        .into_iter()
        .flatten()
        .collect::<Vec<_>>(),
    );
    let sum = path(&to_ground(Together));
    let sticks = sum.windows(2).filter(|pair| pair[1][1].abs() < 1e-12);
    assert!(sticks.count() > 20, "the friction never holds");
    for k in 0..3 {
        let size = sum.iter().fold(0.0_f64, |size, at| size.max(at[k].abs()));
        let off = apart.iter().zip(&sum).map(|(a, b)| (a[k] - b[k]).abs());
        let off = off.fold(0.0, f64::max) / size;
        assert!(off < 1e-9, "quantity {k} is off by {off}");
    }
}
