//! What the data know of the parameters of hidden masses.
//!
//! ```text
//! C_ij = (H⁻¹)_ij / (s_i s_j),   λ = 1 / eigenvalues of C                 (1)
//! ```
//!
//! H is the information on all that a fit adjusts, s_i the distance of a value from where it does nothing (its
//! size where there is no such point). Set to nothing along a direction of information λ, the objective
//! would be about λ/2 higher: what could as well be anything has none, however many values share it.

use faer::linalg::solvers::Solve;
use faer::{Mat, Side};
use simgap_effects::Parameter;

use crate::layout::Layout;
use crate::normal::factorise;

/// λ of (1), over the values of all hidden masses; infinite where H is singular.
pub(crate) fn information(layout: &Layout, hessian: &Mat<f64>, theta: &[f64]) -> Vec<f64> {
    let hidden = layout.effect_entries();
    let hidden = hidden.filter(|(_, placed, _)| placed.action().adds_mass());
    let (entries, size): (Vec<usize>, Vec<f64>) = hidden
        .map(|(entry, placed, place)| {
            let parameter = &placed.effect.parameters()[place];
            (
                entry,
                own_size(parameter, theta[entry]) / layout.scale[entry],
            )
        })
        .unzip();
    eigenvalues(hessian, &entries, &size).unwrap_or_else(|| vec![f64::INFINITY; entries.len()])
}

/// The distance of a value from where the effect vanishes.
fn own_size(parameter: &Parameter, value: f64) -> f64 {
    match parameter.neutral {
        Some(neutral) if neutral.is_finite() => (value - neutral).abs(),
        // A phase has no size of its own.
        None if parameter.per_record => 1.0,
        _ => value.abs(),
    }
}

fn eigenvalues(hessian: &Mat<f64>, entries: &[usize], size: &[f64]) -> Option<Vec<f64>> {
    let all: Vec<usize> = (0..hessian.nrows()).collect();
    let (factor, kept, scale) = factorise(hessian, &all, 1e-12)?;
    // Entries that are not kept are not seen at all.
    let of_effects: Vec<(usize, f64)> = entries
        .iter()
        .zip(size)
        .filter(|(_, size)| **size > 0.0)
        .filter_map(|(entry, size)| Some((kept.iter().position(|k| k == entry)?, *size)))
        .collect();
    let count = of_effects.len();
    if count == 0 {
        return Some(vec![]);
    }
    let unit = Mat::from_fn(kept.len(), count, |i, j| {
        f64::from(u8::from(i == of_effects[j].0))
    });
    let inverse = factor.solve(unit);
    // Covariance of the parameters, each in units of its own size.
    let covariance = Mat::from_fn(count, count, |i, j| {
        let ((row, a), (column, b)) = (of_effects[i], of_effects[j]);
        inverse[(row, j)] / (scale[row] * scale[column] * a * b)
    });
    let spread = covariance.self_adjoint_eigenvalues(Side::Lower).ok()?;
    let each = spread.into_iter().map(|s| s.max(f64::MIN_POSITIVE).recip());
    Some(each.collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of two entries only the sum is seen: one direction has all the information, whatever the units.
    #[test]
    fn verify_directions_are_told_apart() {
        let mut hessian = Mat::<f64>::zeros(4, 4);
        for i in 0..2 {
            for j in 0..2 {
                hessian[(i, j)] = 1e8;
            }
        }
        hessian[(2, 2)] = 4.0;
        hessian[(3, 3)] = 1e-30;
        let mut found = eigenvalues(&hessian, &[0, 1, 2, 3], &[1.0, 1.0, 3.0, 1.0]).unwrap();
        found.sort_by(f64::total_cmp);
        // Three are kept: the difference of the first two, the third, and the sum.
        assert_eq!(found.len(), 3);
        assert!(found[0] < 1e-2, "{found:?}");
        assert!((found[1] - 36.0).abs() < 1e-6, "{found:?}");
        assert!((found[2] / 2e8 - 1.0).abs() < 1e-3, "{found:?}");
    }
}
