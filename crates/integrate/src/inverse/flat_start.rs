//! The state at the first three samples when nothing is known beforehand.

use super::estimate::Estimate;
use super::matrix3::{Matrix, Vector, apply, multiply};

/// F⁻¹ for h = 1.
const BACK_STEP: Matrix = [[1.0, -1.0, 0.5], [0.0, 1.0, -1.0], [0.0, 0.0, 1.0]];

/// The state at samples 0, 1, 2 from the first three samples alone, flat prior.
pub(super) struct Start {
    /// Mean and covariance at samples 0, 1, 2.
    pub(super) estimates: [Estimate; 3],
    /// Covariance of the state at samples 0 and 1 with the state at sample 2.
    pub(super) cross: [Matrix; 2],
}

/// Number of independent disturbances in the first three samples: three measurement errors and
/// two steps of process noise.
const DISTURBANCES: usize = 9;

/// Solves the first three samples for the state.
///
/// ```text
/// s_1 = F⁻¹ (s_2 − w_2)     s_0 = F⁻¹ (s_1 − w_1)     y_k = e₁ᵀ s_k + e_k
/// ```
///
/// so y = A s_2 − N d with d = (e_0, e_1, e_2, w_1, w_2) up to sign, and s_2 = A⁻¹ (y + N d).
/// Each state is its mean plus a matrix times d.
pub(super) fn start(first: Vector, process: &Matrix) -> Start {
    // A has rows e₁ᵀF⁻², e₁ᵀF⁻¹, e₁ᵀ; its inverse is the parabola through three points.
    let inverse: Matrix = [[0.0, 0.0, 1.0], [0.5, -2.0, 1.5], [1.0, -2.0, 1.0]];
    let back_two = multiply(&BACK_STEP, &BACK_STEP);
    // N: what d adds to A s_2 in y; e_k directly, w_2 through F⁻¹ and F⁻², w_1 through F⁻¹.
    let mut noise = [[0.0; DISTURBANCES]; 3];
    for k in 0..3 {
        noise[k][k] = -1.0;
        noise[0][3 + k] = BACK_STEP[0][k];
        noise[0][6 + k] = back_two[0][k];
        noise[1][6 + k] = BACK_STEP[0][k];
    }
    let map_2 = map_disturbances(&inverse, &noise);
    let map_1 = map_disturbances(&BACK_STEP, &subtract_step(map_2, 6));
    let map_0 = map_disturbances(&BACK_STEP, &subtract_step(map_1, 3));
    let mean_2 = apply(&inverse, &first);
    let mean_1 = apply(&BACK_STEP, &mean_2);
    let mean_0 = apply(&BACK_STEP, &mean_1);
    let covariance = |a: &Map, b: &Map| disturbance_covariance(a, b, process);
    Start {
        estimates: [
            (mean_0, covariance(&map_0, &map_0)),
            (mean_1, covariance(&map_1, &map_1)),
            (mean_2, covariance(&map_2, &map_2)),
        ],
        cross: [covariance(&map_0, &map_2), covariance(&map_1, &map_2)],
    }
}

type Map = [[f64; DISTURBANCES]; 3];

/// The 3 × 9 product of a matrix and a map.
fn map_disturbances(matrix: &Matrix, map: &Map) -> Map {
    let mut out = [[0.0; DISTURBANCES]; 3];
    for i in 0..3 {
        for j in 0..DISTURBANCES {
            out[i][j] = (0..3).map(|k| matrix[i][k] * map[k][j]).sum();
        }
    }
    out
}

/// The map of s − w, where w takes columns `first` to `first + 2`.
fn subtract_step(mut map: Map, first: usize) -> Map {
    for k in 0..3 {
        map[k][first + k] -= 1.0;
    }
    map
}

/// a D bᵀ with D = diag(1, 1, 1, Q, Q).
fn disturbance_covariance(a: &Map, b: &Map, process: &Matrix) -> Matrix {
    let mut out = [[0.0; 3]; 3];
    for i in 0..3 {
        for j in 0..3 {
            let measured: f64 = (0..3).map(|k| a[i][k] * b[j][k]).sum();
            let mut driven = 0.0;
            for block in [3, 6] {
                for k in 0..3 {
                    for l in 0..3 {
                        driven += a[i][block + k] * process[k][l] * b[j][block + l];
                    }
                }
            }
            out[i][j] = measured + driven;
        }
    }
    out
}
