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
    let qr = matrix.col_piv_qr();
    let triangle = qr.R();
    if is_singular((0..n).map(|i| triangle[(i, i)].abs())) {
        return None;
    }
    let b = Mat::from_fn(n, 1, |i, _| rhs[i]);
    let x = qr.solve(&b);
    Some((0..n).map(|i| x[(i, 0)]).collect())
}

/// Inverse of a complex matrix; `None` when it is singular to working precision.
pub(crate) fn inverse_complex(matrix: &Mat<c64>) -> Option<Mat<c64>> {
    let n = matrix.nrows();
    if n == 0 {
        return Some(Mat::zeros(0, 0));
    }
    let qr = matrix.col_piv_qr();
    let triangle = qr.R();
    if is_singular((0..n).map(|i| triangle[(i, i)].norm())) {
        return None;
    }
    Some(qr.solve(Mat::<c64>::identity(n, n)))
}

/// Whether one of the sizes on the diagonal of a triangle is as good as zero beside another.
fn is_singular(mut diagonal: impl Iterator<Item = f64> + Clone) -> bool {
    let largest = diagonal.clone().fold(0.0, f64::max);
    largest == 0.0 || diagonal.any(|size| size <= SINGULAR_FRACTION * largest)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use proptest::prelude::*;

    use super::*;

    /// Two plants that nothing joins: blocks of zeros, in which the full pivoting of faer 0.24 loses its way.
    fn blocks(size: usize, values: &[f64]) -> Mat<f64> {
        Mat::from_fn(2 * size, 2 * size, |i, j| {
            let is_joined = (i < size) == (j < size);
            match i.abs_diff(j) {
                0 => 10.0 * (1.0 + values[i]),
                _ if is_joined => values[i * 2 * size + j] - 0.5,
                _ => 0.0,
            }
        })
    }

    proptest! {
        #[test]
        fn verify_solutions_solve(
            size in 1_usize..8,
            values in proptest::collection::vec(0.0_f64..1.0, 256),
        ) {
            let a = blocks(size, &values);
            let rhs: Vec<f64> = (0..2 * size).map(|i| values[255 - i]).collect();
            let x = solve(&a, &rhs).unwrap();
            for (i, needed) in rhs.iter().enumerate() {
                let found: f64 = x.iter().enumerate().map(|(j, x)| a[(i, j)] * x).sum();
                prop_assert!((found - needed).abs() < 1e-12, "{found} instead of {needed}");
            }
            let complex = Mat::from_fn(2 * size, 2 * size, |i, j| c64::new(a[(i, j)], 0.5 * a[(j, i)]));
            let inverse = inverse_complex(&complex).unwrap();
            let one = &complex * &inverse;
            for i in 0..2 * size {
                for j in 0..2 * size {
                    let needed = f64::from(u8::from(i == j));
                    prop_assert!((one[(i, j)] - c64::new(needed, 0.0)).norm() < 1e-12);
                }
            }
        }
    }

    #[test]
    fn what_is_singular_has_no_solution() {
        let dependent = Mat::from_fn(3, 3, |i, j| (3 * i + j) as f64);
        assert_eq!(solve(&dependent, &[1.0, 2.0, 4.0]), None);
        assert_eq!(solve(&Mat::zeros(2, 2), &[1.0, 2.0]), None);
        assert!(
            inverse_complex(&Mat::from_fn(3, 3, |i, j| c64::new(
                (3 * i + j) as f64,
                0.0
            )))
            .is_none()
        );
    }
}
