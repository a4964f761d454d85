//! Results leave the crate and come back: through `serde`, and as `ndarray` arrays.
#![cfg(feature = "ndarray")]
#![allow(clippy::unwrap_used)]

use faer::mat;
use simgap_model::{
    DampedMode, ModelError, Parameter, PoleSensitivity, StructuralMatrices, UndampedModes,
    damped_modes, pole_sensitivities, undamped_modes,
};

fn structure() -> StructuralMatrices {
    StructuralMatrices {
        mass_matrix: mat![[2.0, 0.0], [0.0, 1.0 / 3.0]],
        damping_matrix: mat![[0.3, -0.1], [-0.1, 0.1]],
        stiffness_matrix: mat![[300.0, -100.0], [-100.0, 100.0]],
    }
}

/// Through JSON and back; numbers keep every bit.
fn round_trip<T: serde::Serialize + serde::de::DeserializeOwned>(value: &T) -> T {
    serde_json::from_str(&serde_json::to_string(value).unwrap()).unwrap()
}

#[test]
fn verify_results_come_back_from_json() {
    let structure = structure();
    assert_eq!(round_trip(&structure), structure);
    let modes: UndampedModes = undamped_modes(&structure).unwrap();
    assert_eq!(round_trip(&modes), modes);
    let damped: Vec<DampedMode> = damped_modes(&structure).unwrap();
    assert_eq!(round_trip(&damped), damped);
    let unit = StructuralMatrices {
        stiffness_matrix: mat![[1.0, 0.0], [0.0, 0.0]],
        mass_matrix: faer::Mat::zeros(2, 2),
        damping_matrix: faer::Mat::zeros(2, 2),
    };
    let poles: Vec<PoleSensitivity> = pole_sensitivities(&structure, &[unit]).unwrap();
    assert!(poles.iter().all(|pole| pole.derivative.is_some()));
    assert_eq!(round_trip(&poles), poles);
    let parameters = [Parameter::Mass(0), Parameter::Spring(3)];
    assert_eq!(round_trip(&parameters), parameters);
}

/// A matrix is its rows, a complex number its two parts.
#[test]
fn verify_how_matrices_and_complex_numbers_are_written() {
    let written = serde_json::to_value(structure()).unwrap();
    assert_eq!(written["stiffness_matrix"][0][1], -100.0);
    let modes = serde_json::to_value(damped_modes(&structure()).unwrap()).unwrap();
    assert!(modes[0]["eigenvalue"]["im"].as_f64().unwrap() > 0.0);
}

#[test]
fn verify_rows_of_different_lengths_are_refused() {
    let text =
        r#"{"mass_matrix": [[1.0, 2.0], [3.0]], "damping_matrix": [], "stiffness_matrix": []}"#;
    let error = serde_json::from_str::<StructuralMatrices>(text).unwrap_err();
    let told = error.to_string();
    assert!(
        told.starts_with("row 2 of a matrix has 1 entries, the first 2"),
        "{told}"
    );
}

#[test]
fn verify_arrays_hold_the_values_of_the_matrices() {
    let structure = structure();
    let [mass, damping, stiffness] = structure.to_arrays();
    for i in 0..2 {
        for j in 0..2 {
            assert_eq!(mass[(i, j)], structure.mass_matrix[(i, j)]);
            assert_eq!(damping[(i, j)], structure.damping_matrix[(i, j)]);
            assert_eq!(stiffness[(i, j)], structure.stiffness_matrix[(i, j)]);
        }
    }
    let back = StructuralMatrices::from_arrays(&mass, &damping, &stiffness).unwrap();
    assert_eq!(back, structure);
    let modes = undamped_modes(&structure).unwrap();
    let shape = modes.mode_shape_array();
    assert_eq!(shape[(1, 0)], modes.mode_shape[(1, 0)]);
    let wide = ndarray::Array2::zeros((2, 3));
    let refused = StructuralMatrices::from_arrays(&wide, &damping, &stiffness);
    assert!(matches!(refused, Err(ModelError::Shape { .. })));
}
