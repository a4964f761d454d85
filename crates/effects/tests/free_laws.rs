//! The free laws: tables that a corrected model may hold.
#![allow(clippy::unwrap_used, clippy::panic)]

use std::collections::BTreeSet;

use crate::common::{self, force, model, scale, through};
use simgap_effects::{
    Action, Effect, Placed, SignalMap, SiteKind, VELOCITY_NODES, find_law, free_laws, sites,
};
use simgap_integrate::exact::ForceLaw;
use simgap_model::{Location, Model};

/// A few roundings of double precision of values about one.
const ROUNDING: f64 = 1e-14;

const NODES: usize = 9;

fn start(law: &dyn Effect) -> Vec<f64> {
    law.starts(&scale()).swap_remove(0)
}

fn force_law(values: &[f64]) -> Box<dyn ForceLaw> {
    match free_laws()[0].action(values) {
        Action::Force(law) => law,
        _ => panic!("the free law of a member is a force"),
    }
}

fn curve(law: &dyn Effect, values: &[f64]) -> Box<dyn SignalMap> {
    match law.action(values) {
        Action::Input(map) | Action::Output(map) => map,
        _ => panic!("the free law of a channel is a curve"),
    }
}

/// Values of a force with these nodes, from −0.2 to 0.6 m and up to 0.5 m/s.
fn force_values(of_displacement: [f64; NODES], of_velocity: [f64; 10]) -> Vec<f64> {
    let shapes = [-0.2, 0.6, 0.5];
    [&shapes[..], &of_displacement, &of_velocity].concat()
}

#[test]
fn verify_names_are_unique_and_starts_fit() {
    for law in free_laws() {
        let parameters = law.parameters();
        let names: BTreeSet<&str> = parameters.iter().map(|p| p.name).collect();
        assert_eq!(names.len(), parameters.len(), "{}", law.kind());
        let start = start(law);
        assert_eq!(start.len(), parameters.len());
        for (i, (parameter, value)) in parameters.iter().zip(&start).enumerate() {
            assert!((parameter.lower..=parameter.upper).contains(value));
            assert_eq!(parameter.neutral.is_none(), law.is_chosen(i));
        }
        assert!(start[0] < start[1]);
    }
}

#[test]
fn verify_free_laws_vanish_with_their_nodes() {
    for law in free_laws() {
        let mut values = start(law);
        for (value, parameter) in values.iter_mut().zip(law.parameters()) {
            *value = parameter.neutral.unwrap_or(*value);
        }
        if law.site() == SiteKind::Member {
            assert_eq!(force(force_law(&values).as_ref(), 2e-3, -0.2), 0.0);
        } else {
            let signal = [0.5, -0.7, 40.0];
            let map = curve(law, &values);
            assert_eq!(through(map.as_ref(), &signal, 1e-3), signal);
        }
    }
}

/// At its nodes a table has the values of the nodes, between two of them their mean.
#[test]
fn verify_the_force_at_its_nodes_and_between_them() {
    let f: [f64; NODES] = [3.0, -1.0, 4.0, 1.0, -5.0, 9.0, 2.0, -6.0, 5.0];
    let g = [-8.0, -7.0, -9.0, -3.0, -2.0, 3.0, 8.0, 4.0, 6.0, 2.5];
    let law = force_law(&force_values(f, g));
    let node_m = |k: f64| -0.2 + 0.1 * k;
    let check = |d: f64, v: f64, expected: f64| {
        let found = force(law.as_ref(), d, v);
        assert!(
            (found - expected).abs() < 10.0 * ROUNDING,
            "{d} {v}: {found}"
        );
    };
    for k in 0..NODES {
        check(node_m(k as f64), 0.0, f[k]);
    }
    for k in 0..NODES - 1 {
        check(node_m(k as f64 + 0.5), 0.0, 0.5 * (f[k] + f[k + 1]));
    }
    let at_rest = node_m(0.0);
    for (k, share) in VELOCITY_NODES.into_iter().enumerate() {
        check(at_rest, 0.5 * share, f[0] + g[5 + k]);
        check(at_rest, -0.5 * share, f[0] + g[4 - k]);
    }
    // Through zero at rest.
    check(at_rest, 0.005, f[0] + 0.5 * g[5]);
    check(at_rest, -0.005, f[0] + 0.5 * g[4]);
    check(at_rest, 0.5 * 0.75, f[0] + 0.5 * (g[8] + g[9]));
    // Constant beyond.
    check(9.0, 7.0, f[8] + g[9]);
    check(-9.0, -7.0, f[0] + g[0]);
}

/// A table of a straight line is that line, so that a spring and a damper are special cases.
#[test]
fn verify_a_table_of_a_line_is_a_spring_and_a_damper() {
    let (k, c) = (300.0, 20.0);
    let f = std::array::from_fn(|node| k * (-0.2 + 0.1 * node as f64));
    let g = std::array::from_fn(|node| match node {
        0..5 => -c * 0.5 * VELOCITY_NODES[4 - node],
        _ => c * 0.5 * VELOCITY_NODES[node - 5],
    });
    let law = force_law(&force_values(f, g));
    for n in 0..100 {
        let d = -0.2 + 0.008 * f64::from(n);
        let v = 0.5 * (0.37 * f64::from(n)).sin();
        let found = force(law.as_ref(), d, v);
        assert!((found - k * d - c * v).abs() < 200.0 * ROUNDING, "{found}");
    }
}

/// Doubled node values double the force, and the forces of two tables add.
#[test]
fn verify_free_laws_are_linear_in_their_nodes() {
    let wave = |seed: f64| -> Vec<f64> {
        let node = |k: usize| (seed + 1.7 * k as f64).sin();
        (0..19).map(node).collect()
    };
    let shapes = [-0.2, 0.6, 0.5];
    let with = |nodes: &[f64]| force_law(&[&shapes[..], nodes].concat());
    let (one, other) = (wave(0.3), wave(2.1));
    let sum: Vec<f64> = one.iter().zip(&other).map(|(a, b)| 2.0 * a + b).collect();
    for n in 0..50 {
        let d = 0.5 * (0.9 * f64::from(n)).sin();
        let v = 0.7 * (1.3 * f64::from(n)).cos();
        let of = |nodes: &[f64]| force(with(nodes).as_ref(), d, v);
        assert!((of(&sum) - 2.0 * of(&one) - of(&other)).abs() < ROUNDING);
    }
}

#[test]
fn verify_the_curve_at_its_nodes_and_beyond() {
    let h: [f64; NODES] = [0.5, 0.0, -0.25, 1.0, 0.0, 0.75, -1.0, 0.25, 2.0];
    let values = [&[-4.0, 4.0][..], &h].concat();
    for law in &free_laws()[1..] {
        let map = curve(*law, &values);
        let signal = [-9.0, -4.0, -3.5, 0.0, 0.5, 4.0, 30.0];
        let found = through(map.as_ref(), &signal, 1e-3);
        assert_eq!(found, [-8.5, -3.5, -3.25, 0.0, 0.875, 6.0, 32.0]);
    }
}

#[test]
fn verify_a_table_of_no_width_is_a_step_and_no_fault() {
    let mut values = force_values([1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 2.0], [0.0; 10]);
    values[1] = values[0];
    let law = force_law(&values);
    let forces = [-0.3, -0.2, -0.1].map(|d| force(law.as_ref(), d, 0.0));
    assert_eq!(forces, [1.0, 1.0, 2.0]);
}

#[test]
fn verify_free_laws_survive_a_model_file() {
    let model = model();
    for law in free_laws() {
        for at in sites(&model, law.site()) {
            let placed = Placed::new(law, at.clone(), start(law));
            let mut written = model.clone();
            written.effects.push(placed.to_entry());
            let read = Model::from_toml(&written.to_toml().unwrap()).unwrap();
            let back = Placed::from_entry(&read, &read.effects[0]).unwrap();
            assert_eq!(back.effect.site(), law.site());
            assert_eq!((back.at, back.values), (placed.at, placed.values));
        }
    }
}

#[test]
fn verify_a_file_may_leave_out_nodes() {
    let entry = "\n[[effect]]\nkind = \"tabulated_curve\"\nchannel = \"y\"\n\
        lower_level = -1.0\nupper_level = 1.0\nchange_8 = 0.5\n";
    let model = Model::from_toml(&format!("{}{entry}", common::MODEL)).unwrap();
    let placed = Placed::from_entry(&model, &model.effects[0]).unwrap();
    assert_eq!(placed.values[2..10], [0.0; 8]);
    assert_eq!(placed.values[10], 0.5);
}

#[test]
fn verify_a_wrong_place_is_refused() {
    let at_mass = Location::Mass("load".into());
    assert!(find_law("tabulated_force", &at_mass).is_some());
    let entry = Placed::new(free_laws()[1], at_mass, start(free_laws()[1])).to_entry();
    let Err(error) = Placed::from_entry(&model(), &entry) else {
        panic!("accepted");
    };
    let line = error.to_string();
    assert!(
        line.contains("it sits mass load") && line.contains("input"),
        "{line}"
    );
    assert!(find_law("gremlin", &Location::Input("u".into())).is_none());
}
