//! Hydraulic effects against their closed forms.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use crate::common::{effect, hydraulic};
use simgap_effects::{Action, sites};
use simgap_model::{Model, PRESSURE_UNIT_PA};

/// A few operations on numbers of one size.
const ROUNDING: f64 = 1e-12;

/// The drive with an effect of these values.
fn with(kind: &str, values: &[f64]) -> Model {
    let mut model = hydraulic();
    let effect = effect(kind);
    let at = sites(&model, effect.site()).swap_remove(0);
    let Action::Model(change) = effect.action(values) else {
        panic!("{kind} changes the model");
    };
    change(&mut model, &at);
    model.check().unwrap();
    model
}

/// Entries of M and C at the two pressures.
fn of_pressures(model: &Model) -> [[[f64; 2]; 2]; 2] {
    let at = ["drive.p1", "drive.p2"]
        .map(|name| model.masses.iter().position(|m| m.name == name).unwrap());
    let matrices = model.matrices().unwrap();
    [&matrices.mass_matrix, &matrices.damping_matrix]
        .map(|matrix| at.map(|i| at.map(|j| matrix[(i, j)])))
}

fn near(found: f64, needed: f64) {
    assert!(
        (found - needed).abs() <= ROUNDING * needed.abs(),
        "{found} instead of {needed}"
    );
}

#[test]
fn verify_leakage_flows_from_the_higher_pressure_and_out() {
    let unit = PRESSURE_UNIT_PA * PRESSURE_UNIT_PA;
    let [_, before] = of_pressures(&hydraulic());
    let [_, internal] = of_pressures(&with("internal_leakage", &[3e-12]));
    let [_, external] = of_pressures(&with("external_leakage", &[3e-12]));
    for i in 0..2 {
        for j in 0..2 {
            let sign = if i == j { 1.0 } else { -1.0 };
            near(internal[i][j] - before[i][j], sign * unit * 3e-12);
            near(
                external[i][j] - before[i][j],
                if i == j { unit * 3e-12 } else { 0.0 },
            );
        }
    }
    // What flows at the pressures of the start: 4 and 5 MPa.
    let flow = |model: &Model| {
        let loads = model.load_vector();
        loads[loads.len() - 3..]
            .iter()
            .map(|l| l / PRESSURE_UNIT_PA)
            .collect::<Vec<_>>()
    };
    let found = flow(&with("internal_leakage", &[3e-12]));
    near(found[0], 3e-6);
    near(found[1], -3e-6);
    let found = flow(&with("external_leakage", &[3e-12]));
    near(found[0], -12e-6);
    near(found[1], -15e-6);
}

#[test]
fn verify_air_makes_the_oil_softer() {
    let [before, _] = of_pressures(&hydraulic());
    let [after, _] = of_pressures(&with("bulk_modulus", &[0.8]));
    near(after[0][0], before[0][0] / 0.8);
    let model = with("bulk_modulus", &[0.8]);
    let (air, none) = (
        &model.elements.cylinders[0],
        &hydraulic().elements.cylinders[0],
    );
    near(air.oil_stiffness(), 0.8 * none.oil_stiffness());
}

/// Flow into chamber 1 at 4 MPa.
fn flow(model: &Model, spool: f64) -> f64 {
    model.elements.valves[0].flow(0, spool, 4e6)
}

/// Turbulent flow: the laminar part is off by (δ/Δp)²/4.
const TURBULENT: f64 = 1e-4;

#[test]
fn verify_a_valve_passes_its_rated_flow() {
    let model = hydraulic();
    let gain = 1e-3 / 3.5e6_f64.sqrt();
    for (spool, drop) in [(0.3, 6e6_f64), (-0.3, 4e6)] {
        let needed = gain * spool * drop.sqrt();
        assert!((flow(&model, spool) / needed - 1.0).abs() < TURBULENT);
    }
    // No more than fully open.
    assert_eq!(flow(&model, 3.0), flow(&model, 1.0));
    // Out of the other chamber as the valve opens.
    let out = model.elements.valves[0].flow(1, 0.3, 4e6);
    assert!((out / (-gain * 0.3 * 4e6_f64.sqrt()) - 1.0).abs() < TURBULENT);
}

#[test]
fn verify_a_dead_band_passes_nothing_about_the_middle() {
    let (plain, model) = (hydraulic(), with("valve_dead_band", &[0.05]));
    for spool in [-0.05, -0.01, 0.0, 0.03, 0.05] {
        assert_eq!(flow(&model, spool).abs(), 0.0);
    }
    near(flow(&model, 0.35), flow(&plain, 0.35 - 0.05));
    near(flow(&model, -0.35), flow(&plain, -0.35 + 0.05));
}

#[test]
fn verify_an_asymmetric_valve_has_a_gain_for_each_direction() {
    let (plain, model) = (hydraulic(), with("valve_asymmetry", &[0.1]));
    near(flow(&model, 0.2), 1.1 * flow(&plain, 0.2));
    near(flow(&model, -0.2), 0.9 * flow(&plain, -0.2));
}

#[test]
fn verify_a_supply_sags_with_the_flow_it_gives() {
    let droop = 2e9;
    let (plain, model) = (hydraulic(), with("supply_sag", &[droop]));
    let found = flow(&model, 0.8);
    // Q² = w² (p_s − R Q − p)
    let mut sagged = plain.clone();
    sagged.elements.valves[0].supply -= droop * found;
    assert!((flow(&sagged, 0.8) / found - 1.0).abs() < TURBULENT);
    // The draining edge does not feel it.
    assert_eq!(flow(&model, -0.8), flow(&plain, -0.8));
}

#[test]
fn verify_a_lazy_spool_has_a_lower_frequency() {
    let at = |model: &Model| {
        let spool = model.masses.len() - 1;
        model.matrices().unwrap().mass_matrix[(spool, spool)]
    };
    near(at(&with("spool_lag", &[0.5])), 4.0 * at(&hydraulic()));
}
