//! How far predictions may be off because parameters are known no better.
//!
//! ```text
//! C = S (H⁻¹)_shared S = L Lᵀ                                             (1)
//! σ_c² = tr(C K_cᵀ K_c) / N_c,   K = J_shared − J_own (J_ownᵀ W J_own)⁻¹ J_ownᵀ W J_shared     (2)
//! ```
//!
//! H is the information on all that a fit adjusts, S the scales of its entries. The rows and columns of H⁻¹ that
//! all records share know of what the initial states take up. J are the sensitivities of other records, K what is left of them once
//! the initial states of these, and what else they have of their own, have followed. A fit along each column of L gives the
//! same as far as predictions are linear in the parameters.

use faer::linalg::solvers::Solve;
use faer::{Mat, Side};

use crate::base::LinearSystem;
use crate::normal::factorise;
use crate::products::{dot, inner_products};
use crate::signals::Signals;
use crate::{EstimateError, Fit, FitOptions, Problem, Start};

/// Variance of a value, in units of its own scale, from which the data do not see it at all.
const UNSEEN: f64 = 1.0;
/// Damping of what records have of their own: what they do not see of it does not move.
const DAMPING: f64 = 1e-9;

/// σ_c² of (2) of each channel of `others`. `begun` holds the values of the fit, and what the other runs have of their own. Directions
/// that the data of the fit hardly see are left out.
///
/// # Errors
/// [`EstimateError`] when the model cannot be propagated.
pub fn spread(
    (problem, fit, weights): (&Problem, &Fit, &FitOptions),
    others: &Problem,
    begun: &Start,
) -> Result<Vec<f64>, EstimateError> {
    let trained = LinearSystem::at(problem, fit, weights)?;
    let shared = trained.layout.shared_len();
    let plain = FitOptions::white(others.model.outputs.len());
    let there = LinearSystem::of(others, begun, &plain)?;
    let scale = |i: usize| trained.layout.scale[i] / there.layout.scale[i];
    let steps = directions(&trained.hessian, shared).unwrap_or_default();
    let mut square = vec![0.0; others.model.outputs.len()];
    for columns in &there.at.columns {
        let columns: Vec<&Signals> = columns.iter().map(AsRef::as_ref).collect();
        let (of_shared, of_own) = columns.split_at(shared.min(columns.len()));
        let followed = past(of_shared, of_own, &there.channel_weights);
        for step in &steps {
            for (c, square) in square.iter_mut().enumerate() {
                let mut moved = vec![0.0; followed.first().map_or(0, |column| column[c].len())];
                for (i, column) in followed.iter().enumerate() {
                    add(&mut moved, step[i] * scale(i), &column[c]);
                }
                *square += dot(&moved, &moved);
            }
        }
    }
    let count: usize = others.runs.iter().map(|run| run.len).sum();
    Ok(square
        .into_iter()
        .map(|square| square / count.max(1) as f64)
        .collect())
}

/// K of (2): columns past others.
fn past(columns: &[&Signals], others: &[&Signals], weights: &[f64]) -> Vec<Signals> {
    let mut left: Vec<Signals> = columns.iter().map(|column| (*column).clone()).collect();
    let own = inner_products(others, others, weights, |_, _| true);
    let cross = inner_products(others, columns, weights, |_, _| true);
    let all: Vec<usize> = (0..others.len()).collect();
    let Some((factor, kept, scale)) = factorise(&own, &all, DAMPING) else {
        return left;
    };
    let right = Mat::from_fn(kept.len(), columns.len(), |i, j| {
        cross[(kept[i], j)] / scale[i]
    });
    let taken = factor.solve(right);
    for (j, left) in left.iter_mut().enumerate() {
        for (i, &other) in kept.iter().enumerate() {
            let share = taken[(i, j)] / scale[i];
            for (left, other) in left.iter_mut().zip(others[other]) {
                add(left, -share, other);
            }
        }
    }
    left
}

fn add(sum: &mut [f64], factor: f64, signal: &[f64]) {
    for (sum, value) in sum.iter_mut().zip(signal) {
        *sum += factor * value;
    }
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
