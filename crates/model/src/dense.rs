//! Small dense linear algebra on top of faer that says no instead of returning infinities.

use faer::linalg::solvers::Solve;
use faer::{Mat, c64};

/// A pivot below this fraction of the largest counts as zero: 16 digits less the conditioning
/// that 12 decades between the stiffest and the softest member bring.
const SINGULAR_FRACTION: f64 = 1e-14;

/// Solves `A x = b`; `None` when A is singular to working precision.
pub(crate) fn solve(matrix: &Mat<f64>, rhs: &[f64]) -> Option<Vec<f64>> {
    let n = matrix.nrows();
    if n == 0 {
        return Some(Vec::new());
    }
    let lu = matrix.full_piv_lu();
    let upper = lu.U();
    let largest = upper[(0, 0)].abs();
    if largest == 0.0 || upper[(n - 1, n - 1)].abs() <= SINGULAR_FRACTION * largest {
        return None;
    }
    let b = Mat::from_fn(n, 1, |i, _| rhs[i]);
    let x = lu.solve(&b);
    Some((0..n).map(|i| x[(i, 0)]).collect())
}

/// Inverse of a complex matrix; `None` when it is singular to working precision.
pub(crate) fn inverse_complex(matrix: &Mat<c64>) -> Option<Mat<c64>> {
    let n = matrix.nrows();
    if n == 0 {
        return Some(Mat::zeros(0, 0));
    }
    let lu = matrix.full_piv_lu();
    let upper = lu.U();
    let largest = upper[(0, 0)].norm();
    if largest == 0.0 || upper[(n - 1, n - 1)].norm() <= SINGULAR_FRACTION * largest {
        return None;
    }
    Some(lu.solve(Mat::<c64>::identity(n, n)))
}
