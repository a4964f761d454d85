//! Linearisation and sensitivities against finite differences and closed forms.
#![allow(clippy::unwrap_used)]

use faer::{Mat, c64, mat};
use proptest::prelude::*;
use simgap_model::{
    Damper, FrfKind, GROUND, Load, Mass, Model, ModelError, Parameter, Pendulum, Spring,
    StructuralMatrices, frequency_response, pole_sensitivities, receptance_sensitivity,
    undamped_modes,
};

/// Relative step of the central differences: their error of second order and that of rounding are both below
/// [`DIFFERENCE`].
const STEP: f64 = 1e-5;

/// What central differences of a pole may be off, over the pole: rounding 1e-15 over the step, and its square.
const DIFFERENCE: f64 = 1e-6;

/// A chain of masses, each on a spring and a damper to the one before, the last one on an arm.
fn chain(masses: &[f64], stiffnesses: &[f64], dampings: &[f64], arm: f64) -> Model {
    let name = |i: usize| format!("m{i}");
    let before = |i: usize| {
        if i == 0 {
            GROUND.to_owned()
        } else {
            name(i - 1)
        }
    };
    let count = masses.len();
    Model {
        name: "chain".into(),
        masses: (0..count)
            .map(|i| Mass {
                name: name(i),
                value: masses[i],
                uncertainty: None,
            })
            .collect(),
        springs: (0..count)
            .map(|i| Spring {
                name: format!("k{i}"),
                between: [name(i), before(i)],
                stiffness: stiffnesses[i],
                uncertainty: None,
            })
            .collect(),
        dampers: (0..count)
            .map(|i| Damper {
                name: format!("c{i}"),
                between: [name(i), before(i)],
                damping: dampings[i],
                uncertainty: None,
            })
            .collect(),
        pendulums: vec![Pendulum {
            at: name(count - 1),
            value: arm,
            uncertainty: None,
        }],
        loads: vec![Load {
            at: name(count - 1),
            value: 0.3 * arm,
            uncertainty: None,
        }],
        ..Model::default()
    }
}

fn with(model: &Model, parameter: Parameter, value: f64) -> Model {
    let mut changed = model.clone();
    match parameter {
        Parameter::Mass(i) => changed.masses[i].value = value,
        Parameter::Spring(i) => changed.springs[i].stiffness = value,
        Parameter::Damper(i) => changed.dampers[i].damping = value,
        Parameter::Pendulum(i) => changed.pendulums[i].value = value,
        Parameter::Element(_) => unreachable!("a chain has no element"),
    }
    changed
}

proptest! {
    #[test]
    fn prop_pole_derivatives(
        masses in proptest::collection::vec(0.5_f64..5.0, 3),
        stiffnesses in proptest::collection::vec(50.0_f64..500.0, 3),
        dampings in proptest::collection::vec(0.1_f64..2.0, 3),
        arm in 1.0_f64..50.0,
    ) {
        let model = chain(&masses, &stiffnesses, &dampings, arm);
        let at = model.equilibrium().unwrap();
        let found = model.pole_sensitivities(&at).unwrap();
        prop_assert_eq!(found.len(), 3);
        let apart = found.windows(2).all(|pair| (pair[1].pole - pair[0].pole).norm() > 0.3);
        prop_assume!(apart);
        for (place, parameter) in model.parameters().into_iter().enumerate() {
            let value = model.parameter_value(parameter).unwrap();
            let moved = |sign: f64| {
                with(&model, parameter, value * (1.0 + sign * STEP)).pole_sensitivities(&at).unwrap()
            };
            let (up, down) = (moved(1.0), moved(-1.0));
            for r in 0..3 {
                let difference = (up[r].pole - down[r].pole) / (2.0 * STEP);
                let closed = value * found[r].derivative.as_ref().unwrap()[place];
                let off = (difference - closed).norm() / found[r].pole.norm();
                prop_assert!(off < DIFFERENCE, "{parameter:?} {r}: {off:e}");
                let [freq, ratio] = found[r].freq_and_damping_derivative(place).unwrap();
                let central = |of: fn(&simgap_model::PoleSensitivity) -> f64| {
                    (of(&up[r]) - of(&down[r])) / (2.0 * STEP)
                };
                let by = central(simgap_model::PoleSensitivity::natural_freq_hz);
                prop_assert!((by - value * freq).abs() < DIFFERENCE * found[r].natural_freq_hz());
                let by = central(simgap_model::PoleSensitivity::damping_ratio);
                prop_assert!((by - value * ratio).abs() < DIFFERENCE);
            }
        }
    }

    /// Left and right vectors that differ: matrices without symmetry.
    #[test]
    fn prop_pole_derivatives_without_symmetry(entries in proptest::collection::vec(-1.0_f64..1.0, 24)) {
        let part = |from: usize, scale: f64, main: f64| mat![
            [main + scale * entries[from], scale * entries[from + 1]],
            [scale * entries[from + 2], 3.0 * main + scale * entries[from + 3]],
        ];
        let structure = StructuralMatrices {
            mass_matrix: part(0, 0.2, 1.0),
            damping_matrix: part(4, 0.5, 1.0),
            stiffness_matrix: part(8, 20.0, 100.0),
        };
        let derivative = StructuralMatrices {
            mass_matrix: part(12, 1.0, 0.0),
            damping_matrix: part(16, 1.0, 0.0),
            stiffness_matrix: part(20, 10.0, 0.0),
        };
        let along = |step: f64| {
            let sum = |a: &Mat<f64>, b: &Mat<f64>| Mat::from_fn(2, 2, |i, j| a[(i, j)] + step * b[(i, j)]);
            StructuralMatrices {
                mass_matrix: sum(&structure.mass_matrix, &derivative.mass_matrix),
                damping_matrix: sum(&structure.damping_matrix, &derivative.damping_matrix),
                stiffness_matrix: sum(&structure.stiffness_matrix, &derivative.stiffness_matrix),
            }
        };
        let found = pole_sensitivities(&structure, std::slice::from_ref(&derivative)).unwrap();
        prop_assume!(found.len() == 2 && (found[1].pole - found[0].pole).norm() > 1.0);
        let [up, down] = [STEP, -STEP].map(|step| pole_sensitivities(&along(step), &[]).unwrap());
        for r in 0..2 {
            let difference = (up[r].pole - down[r].pole) / (2.0 * STEP);
            let closed = found[r].derivative.as_ref().unwrap()[0];
            prop_assert!((difference - closed).norm() < 10.0 * DIFFERENCE * found[r].pole.norm());
        }
        let receptance = |m: &StructuralMatrices| frequency_response(m, 1.3, FrfKind::Receptance).unwrap();
        let closed = receptance_sensitivity(&structure, &derivative, 1.3).unwrap();
        let (up, down) = (receptance(&along(STEP)), receptance(&along(-STEP)));
        let size = receptance(&structure).norm_max();
        for i in 0..2 {
            for j in 0..2 {
                let difference = (up[(i, j)] - down[(i, j)]) / c64::new(2.0 * STEP, 0.0);
                prop_assert!((difference - closed[(i, j)]).norm() < DIFFERENCE * size);
            }
        }
    }
}

/// ∂f/∂p = φᵀ (∂K/∂p − ω² ∂M/∂p) φ / (8π² f) of an undamped structure.
#[test]
fn verify_undamped_closed_form() {
    let model = chain(&[1.0, 2.0, 0.7], &[300.0, 200.0, 150.0], &[0.0; 3], 20.0);
    let at = model.equilibrium().unwrap();
    let structure = model.linearise(&at).unwrap();
    let modes = undamped_modes(&structure).unwrap();
    let found = model.pole_sensitivities(&at).unwrap();
    for (place, parameter) in model.parameters().into_iter().enumerate() {
        let part = model.parameter_matrices(parameter, &at).unwrap();
        for (r, pole) in found.iter().enumerate() {
            let omega = modes.natural_freq_rad[r];
            let mut form = 0.0;
            for i in 0..3 {
                for j in 0..3 {
                    let entry =
                        part.stiffness_matrix[(i, j)] - omega * omega * part.mass_matrix[(i, j)];
                    form += modes.mode_shape[(i, r)] * entry * modes.mode_shape[(j, r)];
                }
            }
            let freq = modes.natural_freq_hz[r];
            let closed = form / (8.0 * std::f64::consts::PI.powi(2) * freq);
            let [ours, _] = pole.freq_and_damping_derivative(place).unwrap();
            assert!(
                (ours - closed).abs() < 1e-10 * freq,
                "{parameter:?} {r}: {ours} {closed}"
            );
        }
    }
}

/// An arm held at an angle by a constant torque is softer by the cosine.
#[test]
fn verify_operating_point_of_an_arm() {
    let mut model = chain(&[2.0], &[0.0], &[0.0], 8.0);
    model.loads[0].value = 4.0;
    let at = model.equilibrium().unwrap();
    assert!((at[0] - 0.5_f64.asin()).abs() < 1e-12);
    let stiffness = model.linearise(&at).unwrap().stiffness_matrix[(0, 0)];
    assert!((stiffness - 8.0 * 0.75_f64.sqrt()).abs() < 1e-12);
    model.loads[0].value = 9.0;
    assert!(
        model.equilibrium().is_err(),
        "no rest beyond the arm's largest torque"
    );
}

#[test]
fn verify_what_has_no_derivative() {
    // A free axis without damping: zero is there twice.
    let mut free = chain(&[2.0], &[0.0], &[0.0], 0.0);
    free.loads.clear();
    let found = free
        .pole_sensitivities(&free.equilibrium().unwrap())
        .unwrap();
    assert!(found.iter().all(|pole| pole.derivative.is_none()));
    // With damping it has two poles of its own.
    free.dampers[0].damping = 3.0;
    let found = free.pole_sensitivities(&[0.0]).unwrap();
    assert_eq!(found.len(), 2);
    let slow = found[1].derivative.as_ref().unwrap();
    assert!((slow[2].re + 0.5).abs() < 1e-12, "−c/m");
    free.loads.push(Load {
        at: "m0".into(),
        value: 1.0,
        uncertainty: None,
    });
    assert!(matches!(
        free.equilibrium(),
        Err(ModelError::Singular { .. })
    ));
    assert!(free.linearise(&[0.0, 0.0]).is_err());
    assert!(free.parameter_matrices(Parameter::Mass(7), &[0.0]).is_err());
    assert!(Model::default().pole_sensitivities(&[]).unwrap().is_empty());
}
