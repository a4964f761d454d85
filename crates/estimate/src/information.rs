//! What the data know of the parameters of a set of effects.
//!
//! The eigenvalues of the information on the parameters, past all else that the fit adjusts, each
//! parameter in units of its distance from where it does nothing (of its value where there is no such
//! point). Without a direction of information λ, the objective of a fit would be about λ/2 higher: what
//! could as well be anything has none, however many parameters share it.

use faer::linalg::solvers::Solve;
use faer::{Mat, Side};
use simgap_effects::{Family, Parameter};

use crate::layout::Layout;
use crate::normal::factorise;

/// The eigenvalues, of the effects that are no nominal parameters. Only hidden dynamics can be out of sight
/// and act all the same: the parameters of other effects count as known, as do all where the equations are
/// singular.
pub(crate) fn information(layout: &Layout, hessian: &Mat<f64>, theta: &[f64]) -> Vec<f64> {
    let mut known = Vec::new();
    let mut entries = Vec::new();
    let mut size = Vec::new();
    for (entry, placed, place) in layout.effect_entries() {
        if placed.effect.family() == Family::NominalParameter {
            continue;
        }
        if placed.effect.family() != Family::Dynamics {
            known.push(f64::INFINITY);
            continue;
        }
        entries.push(entry);
        size.push(own_size(&placed.effect.parameters()[place], theta[entry]) / layout.scale[entry]);
    }
    let of_dynamics = eigenvalues(hessian, &entries, &size);
    known.extend(of_dynamics.unwrap_or_else(|| vec![f64::INFINITY; entries.len()]));
    known
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
