//! The simulator against closed forms.
#![allow(clippy::unwrap_used)]

use simgap_rigs::bench::{Bench, draw_setup};
use simgap_rigs::effect::Effect;
use simgap_rigs::excite::Shape;
use simgap_rigs::families::draw_plant;
use simgap_rigs::law::Law;
use simgap_rigs::machine::{Dry, LawAt, Machine};
use simgap_rigs::march::{KEPT, Span, march};
use simgap_rigs::plant::{Node, Output, Place, Quantity, Unit};
use simgap_rigs::rng::Rng;

const SPAN: Span = Span {
    before: 0,
    samples: 400,
    step_s: 0.01,
    substeps: 8,
};

fn oscillator(c: f64) -> Machine {
    Machine {
        masses: vec![2.0],
        springs: vec![(Node::Mass(0), Node::Ground, 800.0)],
        dampers: vec![(Node::Mass(0), Node::Ground, c)],
        outputs: vec![Output {
            channel: "x".into(),
            unit: Unit("m", 1.0),
            quantity: Quantity::Displacement,
            a: Node::Mass(0),
            b: Node::Ground,
        }],
        ..Machine::default()
    }
}

#[test]
fn verify_a_free_decay_is_the_closed_form() {
    let run = march(&oscillator(4.0), &[], &[0.01, 0.0], SPAN);
    // c/2m = 1 1/s, k/m = 400 1/s²: x = x0 e⁻ᵗ (cos wt + sin(wt)/w), w = √399.
    let w = 399.0_f64.sqrt();
    for (k, x) in run.outputs[0].iter().enumerate() {
        let t = 0.01 * k as f64 / KEPT as f64;
        let exact = 0.01 * (-t).exp() * ((w * t).cos() + (w * t).sin() / w);
        // Rest of Runge-Kutta 4: (0.025)⁵/120 per substep, 3200 of them.
        assert!((x - exact).abs() < 1e-8, "{t} {x} {exact}");
    }
}

#[test]
fn verify_dry_friction_takes_off_a_constant_per_half_swing_and_sticks() {
    let machine = Machine {
        dry: Some(Dry {
            a: Node::Mass(0),
            b: Node::Ground,
            sliding: 1.0,
            rest: 1.0,
            speed: 1.0,
        }),
        ..oscillator(0.0)
    };
    let run = march(&machine, &[], &[0.01, 0.0], SPAN);
    let x = &run.outputs[0];
    // Every half swing takes off 2 Fc / k = 2.5 mm: 10, −7.5, 5, −2.5, 0 mm, and there it rests.
    let lowest = x.iter().copied().fold(f64::INFINITY, f64::min);
    assert!((lowest + 0.0075).abs() < 1e-6, "{lowest}");
    let end = x[x.len() - 1];
    assert!(end.abs() < 1e-6, "{end}");
    // The switch is found to 2⁻⁴⁰ of a substep; the speed left there times 2 s is far below this.
    let drift = x[x.len() - 800..].iter().map(|v| (v - end).abs());
    assert!(drift.fold(0.0, f64::max) < 1e-12);
}

#[test]
fn verify_a_dahl_loop_levels_off_at_its_friction() {
    let law = Law::Presliding(3.0, 0.002, 0.0);
    let mut z = 0.0;
    for _ in 0..20_000 {
        z += 1e-6 * law.state_rate(0.0, 1.0, z);
    }
    // After a way of 20 mm = 10 presliding displacements: 3 (1 − e⁻¹⁰) N.
    assert!((z - 3.0 * (1.0 - (-10.0_f64).exp())).abs() < 1e-3, "{z}");
}

#[test]
fn verify_laws_are_their_formulas() {
    let pairs = [
        (Law::QuadraticDamping(2.0), -18.0),
        (Law::CubicStiffness(2.0), 16.0),
        (Law::QuadraticStiffness(2.0), 8.0),
        (Law::AsymmetricDamping(1.0, 5.0), -15.0),
        (Law::Backlash(10.0, 1.0), -5.0),
        (Law::Bilinear(10.0, 0.5, 1.0), 15.0),
        (Law::EndStop(0.5, 1.0, 10.0, 0.1), 12.0),
        (Law::Periodic(3.0, 4.0, 8.0), 3.0),
        (Law::VaryingStiffness(3.0, 0.25, 0.0), 6.0),
        (Law::CubicDamping(2.0), -54.0),
        (Law::PowerSpring(3.0, 2.0), 12.0),
        (Law::PlaceDamping(2.0), -24.0),
    ];
    for (law, wanted) in pairs {
        // d = 2, v = −3, t = 1.
        let found = law.force(2.0, -3.0, 1.0, 0.0);
        assert!((found - wanted).abs() < 1e-12, "{law:?}: {found}");
    }
}

#[test]
fn verify_a_law_acts_on_both_of_its_nodes() {
    let machine = Machine {
        masses: vec![1.0, 3.0],
        laws: vec![LawAt {
            a: Node::Mass(0),
            b: Node::Mass(1),
            law: Law::CubicStiffness(100.0),
        }],
        ..oscillator(0.0)
    };
    let machine = Machine {
        springs: vec![],
        dampers: vec![],
        ..machine
    };
    let run = march(&machine, &[], &[0.1, 0.0, 0.0, 0.0], SPAN);
    let last = |i: usize| run.states[i][run.states[i].len() - 1];
    assert!((last(2) + 3.0 * last(3)).abs() < 1e-12);
    assert!(last(2).abs() > 1e-3);
}

/// A road of which half reaches the wheel, or all of it late: the recorder sees the road as it is, the sensors do not.
#[test]
fn verify_a_recorder_sees_what_was_sent() {
    let mut rng = Rng::new("road");
    let plant = draw_plant("quarter_car", &mut rng);
    let setup = draw_setup(&plant, &[Shape::Multisine], 0.002, 500, &mut rng);
    let bench = Bench {
        without: plant.clone(),
        plant,
        setups: vec![setup],
    };
    let run = |kind: &'static str, name: &'static str, value: f64| {
        let effect = Effect {
            kind,
            at: Place::Input(0),
            values: vec![(name, value)],
            phases: vec![],
        };
        bench.run(&bench.plant, &[effect], 0, 8).unwrap().1
    };
    let plain = bench.run(&bench.plant, &[], 0, 8).unwrap().1;
    let half = run("input_gain", "gain_factor", 0.5);
    let late = run("input_delay", "delay_s", 0.0031);
    for (c, reading) in plain.outputs.iter().enumerate() {
        let largest = reading.iter().fold(0.0_f64, |most, y| most.max(y.abs()));
        for (y, half) in reading.iter().zip(&half.outputs[c]) {
            assert!((0.5 * y - half).abs() < 1e-9 * largest, "{y} {half}");
        }
        assert_ne!(reading, &late.outputs[c]);
    }
    assert_eq!(plain.inputs, half.inputs);
    assert_eq!(plain.inputs, late.inputs);
}
