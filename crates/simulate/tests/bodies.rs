//! Rigid bodies and beams in the simulation: every effect at a point, lanes, moving bases.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use crate::support::{
    base_input, between, largest_difference, model, output, placed, predict, run, sampled,
};
use simgap_effects::{Effect, Family, Placed, SiteKind, SiteScale, catalogue};
use simgap_model::{Location, Model, OutputKind};
use simgap_simulate::{Job, Run, Simulator, predict_all};

const MASS: f64 = 40.0;
const ARM: f64 = 0.7;

/// With J = m b² the points at ±b do not feel each other: each is a mass m/2 of its own.
fn body() -> Model {
    model(&format!(
        "[[body]]\nname = \"table\"\nmass = {MASS:?}\ninertia = {:?}\n\
        [[point]]\nname = \"left\"\nbody = \"table\"\noffset = {:?}\n\
        [[point]]\nname = \"right\"\nbody = \"table\"\noffset = {ARM:?}\n{}",
        MASS * ARM * ARM,
        -ARM,
        members("table.left", "table.right")
    ))
}

fn two_masses() -> Model {
    let mass = |name: &str| format!("[[mass]]\nname = \"{name}\"\nvalue = {:?}\n", MASS / 2.0);
    model(&(mass("left") + &mass("right") + &members("left", "right")))
}

fn members(left: &str, right: &str) -> String {
    let mut text = String::new();
    for (name, stiffness) in [(left, 8000.0), (right, 18000.0)] {
        text += &format!(
            "[[spring]]\nname = \"k {name}\"\nbetween = [\"{name}\", \"ground\"]\nstiffness = {stiffness:?}\n\
            [[damper]]\nname = \"c {name}\"\nbetween = [\"{name}\", \"ground\"]\ndamping = 30.0\n\
            [[load]]\nat = \"{name}\"\nvalue = -3.0\n\
            [[input]]\nchannel = \"u {name}\"\nkind = \"force\"\nat = \"{name}\"\n"
        );
    }
    text + &output("y", "displacement", left)
        + &output("z", "displacement", right)
        + &output("a", "acceleration", left)
}

fn drive() -> Run {
    let wave = |amplitude: f64, omega: f64| {
        sampled(0.002, 1500, move |t| {
            amplitude * (omega * t).sin() + 0.3 * amplitude * (2.3 * omega * t).cos()
        })
    };
    run(0.002, 1500, vec![wave(30.0, 15.0), wave(20.0, 22.0)])
}

/// Every kind of the machine as it sits on the left of both models, in one of its usual instances.
fn instances(effect: &'static dyn Effect) -> Option<[Placed; 2]> {
    let at = |left: &str| match effect.site() {
        SiteKind::Member | SiteKind::Spring | SiteKind::GroundSpring | SiteKind::Damper => {
            Some(between(left, "ground"))
        }
        SiteKind::Mass if effect.family() != Family::NominalParameter => {
            Some(Location::Mass(left.into()))
        }
        SiteKind::Load => Some(Location::Mass(left.into())),
        _ => None,
    };
    let scale = SiteScale {
        stiffness_n_per_m: 8000.0,
        mass_kg: MASS / 2.0,
        lines_hz: [3.0; 4],
        motion_hz: [2.4; 4],
        ..SiteScale::plain(5e-3, 0.08, 30.0)
    };
    let values = effect.usual(&scale).into_iter().next()?;
    let of = |left: &str| Some(Placed::new(effect, at(left)?, values.clone()));
    Some([of("table.left")?, of("left")?])
}

/// Element forces are solved to 1e-8 of themselves; over hundreds of steps the errors of the two agree to less.
const SOLVED: f64 = 1e-6;

#[test]
fn verify_every_effect_sits_at_a_point_as_at_a_mass() {
    let (body, masses, run) = (body(), two_masses(), drive());
    let mut seen = 0;
    for effect in catalogue() {
        let Some([at_point, at_mass]) = instances(*effect) else {
            continue;
        };
        seen += 1;
        let kind = effect.kind();
        let entry = at_point.to_entry();
        if !matches!(effect.site(), SiteKind::Load) {
            Placed::from_entry(&body, &entry).unwrap_or_else(|error| panic!("{kind}: {error}"));
        }
        let on_body = predict(&body, &[at_point], 4, &run, &[]);
        let on_mass = predict(&masses, &[at_mass], 4, &run, &[]);
        for (one, other) in on_body.iter().zip(&on_mass) {
            let spread = largest_difference(other, &vec![0.0; other.len()]);
            let off = largest_difference(one, other) / spread;
            assert!(off < SOLVED, "{kind}: {off}");
        }
    }
    assert!(seen > 15, "{seen} kinds");
}

#[test]
fn verify_lanes_are_the_march_of_one_set() {
    let (body, run) = (body(), drive());
    let of = |level: f64| {
        let friction = placed(
            "coulomb_friction",
            between("table.left", "ground"),
            &[level],
        );
        let cubic = placed(
            "cubic_stiffness",
            between("table.right", "table.left"),
            &[1e6 * level],
        );
        Simulator::new(&body, &[friction, cubic], 2).unwrap()
    };
    let simulators: Vec<Simulator> = (1..=8).map(|i| of(f64::from(i))).collect();
    let jobs: Vec<Job<'_>> = simulators
        .iter()
        .map(|simulator| Job {
            simulator,
            run: &run,
            initial: &[],
            smooth: false,
        })
        .collect();
    for (simulator, lanes) in simulators.iter().zip(predict_all(&jobs)) {
        assert_eq!(lanes.unwrap(), simulator.predict(&run, &[]).unwrap());
    }
}

#[test]
fn verify_the_roll_is_the_difference_of_two_points() {
    let mut body = body();
    body.outputs[2].kind = OutputKind::Roll;
    body.outputs[2].at = Some("table".into());
    body.check().unwrap();
    let [left, right, roll] = &predict(&body, &[], 1, &drive(), &[])[..] else {
        panic!("three outputs");
    };
    for ((l, r), angle) in left.iter().zip(right).zip(roll) {
        assert!((angle - (r - l) / (2.0 * ARM)).abs() < 1e-15);
    }
}

/// A cantilever whose base moves with constant acceleration bends as under its weight: w = ρ b h a L⁴/(8 E I).
#[test]
fn verify_a_beam_on_an_accelerated_base_bends_as_under_its_weight() {
    let text = "[[beam]]\nname = \"leaf\"\nbetween = [\"base\", \"leaf.tip\"]\nlength = 0.5\nwidth = 0.02\n\
        thickness = 0.004\nyoungs_modulus = 2.1e11\ndensity = 7850.0\nmodes = 6\ndamping_ratio = 0.3\n"
        .to_string()
        + &base_input("base")
        + &output("tip", "displacement", "leaf.tip")
        + &output("b", "displacement", "base");
    let mut model = model(&text);
    // The static shape has no damping of its own.
    model.dampers.push(simgap_model::Damper {
        name: "c".into(),
        between: ["leaf.tip".into(), "base".into()],
        damping: 2.0,
        uncertainty: None,
    });
    let base = sampled(1e-3, 4000, |t| 0.5 * 3.0 * t * t);
    let found = predict(&model, &[], 1, &run(1e-3, 4000, vec![base]), &[]);
    let bent = found[0][3999] - found[1][3999];
    let inertia = 0.004_f64.powi(2) / 12.0;
    let weight = 7850.0 * 3.0 * 0.5_f64.powi(4) / (8.0 * 2.1e11 * inertia);
    // Six modes of the clamped shape leave out the rest of a series; differences of 24 m at 1e-16.
    assert!((bent / -weight - 1.0).abs() < 1e-4, "{bent} {weight}");
}
