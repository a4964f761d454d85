//! How far parameters may lie from where they were found.
//!
//! ```text
//! C = S (H⁻¹)_shared S = L Lᵀ,   θ_k = θ̂ + L e_k                          (1)
//! ```
//!
//! H is the information on all that a fit adjusts, S the scales of its entries. The rows and columns of H⁻¹ that
//! all records share know of what the initial states take up. Predictions y_k with θ_k are spread about that
//! with θ̂ by √Σ (y_k − ŷ)², as far as they are linear in θ.

use faer::linalg::solvers::Solve;
use faer::{Mat, Side};
use simgap_effects::Placed;

use crate::base::LinearSystem;
use crate::normal::factorise;
use crate::{EstimateError, Fit, FitOptions, Problem};

/// Variance of a value, in units of its own scale, from which the data do not see it at all.
const UNSEEN: f64 = 1.0;

/// Effects and nominal parameters one standard deviation away from a fit, along each of as many independent
/// directions as they have values, (1); those that the data hardly see are left out. Values of a record's own
/// stay as they are, and all others in their ranges.
///
/// # Errors
/// [`EstimateError`] when the model cannot be propagated.
pub fn deviations(
    problem: &Problem,
    fit: &Fit,
    weights: &FitOptions,
) -> Result<Vec<Vec<Placed>>, EstimateError> {
    let LinearSystem {
        layout,
        theta,
        hessian,
        ..
    } = LinearSystem::at(problem, fit, weights)?;
    let steps = directions(&hessian, layout.shared_len()).unwrap_or_default();
    let deviation = |step: Vec<f64>| {
        let mut moved = theta.clone();
        for (entry, step) in step.into_iter().enumerate() {
            moved[entry] += step * layout.scale[entry];
        }
        layout.make_physical(&mut moved);
        layout.unpack(&moved).placed().cloned().collect()
    };
    Ok(steps.into_iter().map(deviation).collect())
}

/// The columns of L of (1) over the first `shared` entries, in units of their scales.
fn directions(hessian: &Mat<f64>, shared: usize) -> Option<Vec<Vec<f64>>> {
    let all: Vec<usize> = (0..hessian.nrows()).collect();
    let (factor, kept, scale) = factorise(hessian, &all, 1e-12)?;
    let inverse = factor.solve(Mat::<f64>::identity(kept.len(), kept.len()));
    let covariance = |i: usize, j: usize| inverse[(i, j)] / (scale[i] * scale[j]);
    let is_seen = |i: &usize| kept[*i] < shared && covariance(*i, *i) < UNSEEN;
    let seen: Vec<usize> = (0..kept.len()).filter(is_seen).collect();
    let block = Mat::from_fn(seen.len(), seen.len(), |i, j| covariance(seen[i], seen[j]));
    let factor = block.llt(Side::Lower).ok()?;
    let column = |k: usize| {
        let mut step = vec![0.0; shared];
        for (i, &row) in seen.iter().enumerate() {
            step[kept[row]] = factor.L()[(i, k)];
        }
        step
    };
    Some((0..seen.len()).map(column).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Σ L_k L_kᵀ over the shared entries is their block of H⁻¹, what is left of H after the others have taken
    /// their share: H_ss − H_so H_oo⁻¹ H_os inverted.
    #[test]
    fn verify_directions_hold_the_covariance_of_what_is_shared() {
        let hessian = faer::mat![[40.0, 6.0, 10.0], [6.0, 9.0, 3.0], [10.0, 3.0, 50.0]];
        let steps = directions(&hessian, 2).unwrap();
        let own: [[f64; 2]; 2] = [
            [40.0 - 100.0 / 50.0, 6.0 - 30.0 / 50.0],
            [6.0 - 30.0 / 50.0, 9.0 - 9.0 / 50.0],
        ];
        let determinant = own[0][0] * own[1][1] - own[0][1] * own[1][0];
        let inverse = [
            [own[1][1] / determinant, -own[0][1] / determinant],
            [-own[1][0] / determinant, own[0][0] / determinant],
        ];
        for i in 0..2 {
            for j in 0..2 {
                let found: f64 = steps.iter().map(|step| step[i] * step[j]).sum();
                assert!((found - inverse[i][j]).abs() < 1e-9, "{i} {j}: {found}");
            }
        }
    }
}
