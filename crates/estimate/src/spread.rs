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
use crate::products::dot;
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
    let plain = FitOptions::white(others.model.outputs.len());
    let there = LinearSystem::of(others, begun, &plain)?;
    let mut steps = directions(&trained.hessian, trained.layout.shared_len()).unwrap_or_default();
    // In units of the scales that the values have there.
    for step in &mut steps {
        for (i, step) in step.iter_mut().enumerate() {
            *step *= trained.layout.scale[i] / there.layout.scale[i];
        }
    }
    let mut square = vec![0.0; others.model.outputs.len()];
    for (run, columns) in there.at.columns.iter().enumerate() {
        for step in followed(&there, run, &steps) {
            for (c, square) in square.iter_mut().enumerate() {
                let mut moved = vec![0.0; others.runs[run].len];
                for (share, column) in step.iter().zip(columns) {
                    let values = moved.iter_mut().zip(&column[c]);
                    values.for_each(|(moved, value)| *moved += share * value);
                }
                *square += dot(&moved, &moved);
            }
        }
    }
    let count: usize = others.runs.iter().map(|run| run.len).sum();
    square
        .iter_mut()
        .for_each(|sum| *sum /= count.max(1) as f64);
    Ok(square)
}

/// Steps of what all records share, each with those of what a run has of its own, which follow it: −H_own⁻¹ H_own,shared.
fn followed(there: &LinearSystem, run: usize, steps: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let entries: Vec<usize> = there.layout.entries(run).collect();
    let (shared, own) = entries.split_at(there.layout.shared_len());
    let mut whole: Vec<Vec<f64>> = steps.to_vec();
    whole
        .iter_mut()
        .for_each(|step| step.resize(entries.len(), 0.0));
    let Some((factor, kept, scale)) = factorise(&there.hessian, own, DAMPING) else {
        return whole;
    };
    let pull = |entry: usize, step: &[f64]| -> f64 {
        let each = shared.iter().zip(step);
        each.map(|(&other, step)| there.hessian[(entry, other)] * step)
            .sum()
    };
    let right = Mat::from_fn(kept.len(), steps.len(), |i, k| {
        -pull(kept[i], &steps[k]) / scale[i]
    });
    let follows = factor.solve(right);
    for (k, step) in whole.iter_mut().enumerate() {
        for (i, &entry) in kept.iter().enumerate() {
            step[shared.len() + entry - own[0]] = follows[(i, k)] / scale[i];
        }
    }
    whole
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
