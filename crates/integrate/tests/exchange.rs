//! Motions leave the crate and come back: through `serde`, and as `ndarray` arrays.
#![cfg(all(feature = "ndarray", feature = "serde"))]
#![allow(clippy::unwrap_used)]

use faer::mat;
use simgap_integrate::inverse::{DerivedMotion, Differentiator, derive_motion};
use simgap_integrate::{Method, Problem, Solution, TimeGrid, simulate};
use simgap_model::StructuralMatrices;

fn solution() -> Solution {
    let matrices = StructuralMatrices {
        mass_matrix: mat![[2.0, 0.0], [0.0, 1.0]],
        damping_matrix: mat![[0.3, -0.1], [-0.1, 0.1]],
        stiffness_matrix: mat![[300.0, -100.0], [-100.0, 100.0]],
    };
    let problem = Problem::new(&matrices).unwrap();
    let problem = problem
        .with_initial_state(&[0.01, -0.02], &[0.1, 0.0])
        .unwrap();
    let grid = TimeGrid::new(0.0, 1e-2, 40).unwrap();
    simulate(&problem, &grid, Method::RungeKutta4).unwrap()
}

#[test]
fn verify_motions_come_back_from_json() {
    let solution = solution();
    let text = serde_json::to_string(&solution).unwrap();
    assert_eq!(serde_json::from_str::<Solution>(&text).unwrap(), solution);
    let ramp: Vec<f64> = (0..20).map(|n| f64::from(n).sqrt()).collect();
    let derived = derive_motion(Differentiator::Park, &ramp, 0.1).unwrap();
    let text = serde_json::to_string(&derived).unwrap();
    let read: DerivedMotion = serde_json::from_str(&text).unwrap();
    assert_eq!(read, derived);
}

#[test]
fn verify_arrays_hold_the_values_of_the_motion() {
    let motion = solution().motion;
    let arrays = motion.to_arrays();
    let matrices = [&motion.displacement, &motion.velocity, &motion.acceleration];
    for (array, matrix) in arrays.iter().zip(matrices) {
        assert_eq!(array.dim(), (40, 2));
        for k in 0..40 {
            for i in 0..2 {
                assert_eq!(array[(k, i)], matrix[(i, k)]);
            }
        }
    }
    assert_eq!(motion.time_s_view().to_vec(), motion.time_s);
}
