//! Modes, frequency responses and static deflection against closed forms.
#![allow(clippy::unwrap_used)]

use std::f64::consts::TAU;

use faer::{Mat, mat};
use proptest::prelude::*;
use simgap_model::{
    FrfKind, Model, ModelError, StructuralMatrices, damped_modes, frequency_response, state_matrix,
    undamped_modes,
};

/// Relative accuracy of small, well-conditioned eigenproblems: a hundred units in the last place.
const CLOSED_FORM: f64 = 2e-14 * 100.0;

fn one(m: f64, c: f64, k: f64) -> StructuralMatrices {
    StructuralMatrices {
        mass_matrix: mat![[m]],
        damping_matrix: mat![[c]],
        stiffness_matrix: mat![[k]],
    }
}

/// A chain ground - 1 - 2 - ... - n of equal masses and springs, free at the end.
fn chain(n: usize, m: f64, c: f64, k: f64) -> StructuralMatrices {
    let band = |value: f64| {
        Mat::from_fn(n, n, |i, j| {
            if i == j {
                if i + 1 == n { value } else { 2.0 * value }
            } else if i.abs_diff(j) == 1 {
                -value
            } else {
                0.0
            }
        })
    };
    StructuralMatrices {
        mass_matrix: Mat::from_fn(n, n, |i, j| if i == j { m } else { 0.0 }),
        damping_matrix: band(c),
        stiffness_matrix: band(k),
    }
}

#[test]
fn verify_chain_natural_frequencies() {
    // ω_r = 2 sqrt(k/m) sin((2r − 1) π / (2 (2n + 1))), fixed-free chain.
    let (n, m, k) = (7, 3.0, 5.0e4);
    let modes = undamped_modes(&chain(n, m, 0.0, k)).unwrap();
    for r in 1..=n {
        let exact = 2.0
            * (k / m).sqrt()
            * ((2 * r - 1) as f64 * std::f64::consts::PI / (2.0 * (2 * n + 1) as f64)).sin();
        let got = modes.natural_freq_rad[r - 1];
        assert!(
            (got / exact - 1.0).abs() < CLOSED_FORM,
            "mode {r}: {got} against {exact}"
        );
    }
}

#[test]
fn verify_damped_mode_of_one_mass() {
    let (m, zeta, k): (f64, f64, f64) = (33_000.0, 0.3, 8_287_639.0);
    let omega = (k / m).sqrt();
    let modes = damped_modes(&one(m, 2.0 * zeta * omega * m, k)).unwrap();
    assert_eq!(modes.len(), 1);
    assert!((modes[0].damping_ratio - zeta).abs() < CLOSED_FORM);
    assert!((modes[0].natural_freq_hz - omega / TAU).abs() < CLOSED_FORM);
    let damped = omega * (1.0 - zeta * zeta).sqrt() / TAU;
    assert!((modes[0].damped_freq_hz - damped).abs() < CLOSED_FORM);
}

#[test]
fn verify_overdamped_and_free_masses() {
    // s (m s + c) = 0: λ = 0 and λ = −c/m.
    let modes = damped_modes(&one(2.0, 6.0, 0.0)).unwrap();
    assert_eq!(modes.len(), 2);
    assert_eq!(modes[0].natural_freq_hz, 0.0);
    assert!((modes[1].eigenvalue.re + 3.0).abs() < CLOSED_FORM);
    assert_eq!(
        undamped_modes(&one(2.0, 6.0, 0.0)).unwrap().natural_freq_hz,
        [0.0]
    );
}

#[test]
fn verify_frequency_response_of_one_mass() {
    let (m, c, k) = (2.0, 3.0, 500.0);
    for freq_hz in [0.0, 0.7, 2.5, 40.0] {
        let w = TAU * freq_hz;
        let exact = faer::c64::new(k - m * w * w, c * w).inv();
        let structure = one(m, c, k);
        let h = frequency_response(&structure, freq_hz, FrfKind::Receptance).unwrap()[(0, 0)];
        let v = frequency_response(&structure, freq_hz, FrfKind::Mobility).unwrap()[(0, 0)];
        let a = frequency_response(&structure, freq_hz, FrfKind::Accelerance).unwrap()[(0, 0)];
        assert!((h - exact).norm() <= CLOSED_FORM * exact.norm());
        assert!((v - exact * faer::c64::new(0.0, w)).norm() <= CLOSED_FORM * v.norm());
        assert!((a + exact * (w * w)).norm() <= CLOSED_FORM * a.norm());
    }
}

/// A mass between a spring to the ground and one to a moving base: what each output shows of a force on it.
#[test]
fn verify_responses_of_outputs_of_one_mass() {
    let model = Model::from_toml(
        r#"
        schema = "simgap-model/1"
        name = "between two springs"
        mass = [{ name = "a", value = 2.0 }]
        spring = [
          { name = "k1", between = ["a", "ground"], stiffness = 500.0 },
          { name = "k2", between = ["b", "a"], stiffness = 300.0 },
        ]
        damper = [{ name = "c2", between = ["a", "b"], damping = 3.0 }]
        input = [{ channel = "u", kind = "displacement", at = "b" }]
        output = [
          { channel = "x", kind = "displacement", at = "a" },
          { channel = "v", kind = "velocity", at = "a" },
          { channel = "a", kind = "acceleration", at = "a" },
          { channel = "f", kind = "force", between = ["b", "a"] },
        ]
        "#,
    )
    .unwrap();
    for freq_hz in [0.0, 0.7, 2.5, 40.0] {
        let w = TAU * freq_hz;
        let x = faer::c64::new(800.0 - 2.0 * w * w, 3.0 * w).inv();
        let exact = [
            x,
            x * faer::c64::new(0.0, w),
            x * (-w * w),
            -x * faer::c64::new(300.0, 3.0 * w),
        ];
        let found = model.output_response(freq_hz).unwrap();
        for (row, exact) in exact.iter().enumerate() {
            let error = (found[(row, 0)] - exact).norm();
            assert!(error <= CLOSED_FORM * exact.norm(), "{row} at {freq_hz} Hz");
        }
    }
}

#[test]
fn verify_singular_systems_are_refused() {
    let refused = frequency_response(&one(2.0, 0.0, 0.0), 0.0, FrfKind::Receptance);
    assert_eq!(
        refused.unwrap_err().to_string(),
        "dynamic stiffness matrix is singular (at 0 Hz), needed is an invertible matrix"
    );
    assert!(matches!(
        state_matrix(&one(0.0, 1.0, 1.0)),
        Err(ModelError::Singular { .. })
    ));
    assert!(matches!(
        undamped_modes(&one(-1.0, 1.0, 1.0)),
        Err(ModelError::Singular { .. })
    ));
}

#[test]
fn verify_static_deflection_under_weight() {
    let model = Model::from_toml(
        r#"
        schema = "simgap-model/1"
        name = "two springs in series"
        mass = [{ name = "a", value = 2.0 }, { name = "b", value = 3.0 }]
        spring = [
            { name = "lower", between = ["a", "ground"], stiffness = 1000.0 },
            { name = "upper", between = ["b", "a"], stiffness = 500.0 },
        ]
        output = [{ channel = "y", kind = "displacement", at = "b" }]
        load = [{ at = "a", value = -20.0 }, { at = "b", value = -30.0 }]
        "#,
    )
    .unwrap();
    let deflection = model.static_deflection(&model.load_vector()).unwrap();
    // The lower spring carries 50 N, the upper one 30 N.
    assert!((deflection[0] + 0.05).abs() < CLOSED_FORM);
    assert!((deflection[1] + 0.05 + 0.06).abs() < CLOSED_FORM);
}

proptest! {
    #[test]
    fn prop_modes_are_mass_orthonormal(
        masses in prop::collection::vec(0.1_f64..50.0, 2..6),
        k in 1e2_f64..1e7,
    ) {
        let n = masses.len();
        let mut structure = chain(n, 1.0, 0.0, k);
        for i in 0..n {
            structure.mass_matrix[(i, i)] = masses[i];
        }
        let modes = undamped_modes(&structure).unwrap();
        let phi = &modes.mode_shape;
        let unit = phi.transpose() * &structure.mass_matrix * phi;
        let stiff = phi.transpose() * &structure.stiffness_matrix * phi;
        let top = modes.natural_freq_rad[n - 1].powi(2);
        for i in 0..n {
            for j in 0..n {
                let delta = if i == j { 1.0 } else { 0.0 };
                prop_assert!((unit[(i, j)] - delta).abs() < 1e-12);
                let expected = delta * modes.natural_freq_rad[i].powi(2);
                prop_assert!((stiff[(i, j)] - expected).abs() < 1e-12 * top);
            }
        }
    }

    #[test]
    fn prop_frequency_response_is_symmetric_and_a_sum_of_modes(
        k in 1e3_f64..1e6, freq_hz in 0.1_f64..80.0,
    ) {
        let structure = chain(4, 2.0, k * 1e-3, k);
        let h = frequency_response(&structure, freq_hz, FrfKind::Receptance).unwrap();
        let modes = undamped_modes(&structure).unwrap();
        // Stiffness-proportional damping C = β K keeps the undamped shapes:
        // H = Σ φ φᵀ / (ω_r² (1 + iωβ) − ω²).
        let (w, beta) = (TAU * freq_hz, 1e-3);
        for i in 0..4 {
            for j in 0..4 {
                let mut sum = faer::c64::new(0.0, 0.0);
                for r in 0..4 {
                    let w2 = modes.natural_freq_rad[r].powi(2);
                    let shape = modes.mode_shape[(i, r)] * modes.mode_shape[(j, r)];
                    sum += faer::c64::new(w2 - w * w, w2 * w * beta).inv() * shape;
                }
                prop_assert!((h[(i, j)] - sum).norm() < 1e-10 * h[(i, i)].norm().max(sum.norm()));
                prop_assert!((h[(i, j)] - h[(j, i)]).norm() < 1e-10 * h[(i, i)].norm());
            }
        }
    }

    #[test]
    fn prop_eigenvalues_make_the_characteristic_matrix_singular(
        c in 0.0_f64..50.0, k in 1e3_f64..1e6,
    ) {
        let structure = chain(3, 2.0, c, k);
        for mode in damped_modes(&structure).unwrap() {
            // (λ² M + λ C + K) φ = 0
            let lambda = mode.eigenvalue;
            for i in 0..3 {
                let mut sum = faer::c64::new(0.0, 0.0);
                for j in 0..3 {
                    let entry = lambda * lambda * structure.mass_matrix[(i, j)]
                        + lambda * structure.damping_matrix[(i, j)]
                        + structure.stiffness_matrix[(i, j)];
                    sum += entry * mode.mode_shape[j];
                }
                prop_assert!(sum.norm() < 1e-9 * k, "row {i}: {sum}");
            }
        }
    }
}
