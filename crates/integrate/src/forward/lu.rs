//! A small dense factorisation that is renewed and applied in place.
//!
//! The step matrices here have a handful of rows; a solve must not allocate, and the call into a
//! blocked library costs more than the arithmetic.

use crate::error::{IntegrateError, Result};

/// P A = L U with partial pivoting, row by row.
#[derive(Debug, Clone)]
pub(super) struct Lu {
    n: usize,
    entries: Vec<f64>,
    order: Vec<usize>,
    /// One over each pivot.
    reciprocals: Vec<f64>,
    scratch: Vec<f64>,
}

impl Lu {
    /// Room for an n × n matrix.
    pub(super) fn with_size(n: usize) -> Self {
        Self {
            n,
            entries: vec![0.0; n * n],
            order: (0..n).collect(),
            reciprocals: vec![0.0; n],
            scratch: vec![0.0; n],
        }
    }

    /// Factors `matrix` (row by row). `what` and `time_s` go into the error.
    pub(super) fn factor(&mut self, matrix: &[f64], what: &'static str, time_s: f64) -> Result<()> {
        let n = self.n;
        // A pivot below the rounding of its column carries no digit.
        let needed = 4.0 * n as f64 * f64::EPSILON;
        self.entries.copy_from_slice(matrix);
        for (i, row) in self.order.iter_mut().enumerate() {
            *row = i;
        }
        for k in 0..n {
            let size = (0..n).fold(0.0_f64, |top, i| top.max(matrix[i * n + k].abs()));
            let mut best = k;
            for i in k + 1..n {
                if self.entries[i * n + k].abs() > self.entries[best * n + k].abs() {
                    best = i;
                }
            }
            let pivot = self.entries[best * n + k];
            let relative = if size > 0.0 { pivot.abs() / size } else { 0.0 };
            if relative.is_nan() || relative <= needed {
                return Err(IntegrateError::Singular {
                    what,
                    time_s,
                    pivot: k,
                    found: relative,
                    needed,
                });
            }
            self.reciprocals[k] = 1.0 / pivot;
            if best != k {
                self.order.swap(best, k);
                for j in 0..n {
                    self.entries.swap(best * n + j, k * n + j);
                }
            }
            for i in k + 1..n {
                let factor = self.entries[i * n + k] / pivot;
                self.entries[i * n + k] = factor;
                for j in k + 1..n {
                    self.entries[i * n + j] -= factor * self.entries[k * n + j];
                }
            }
        }
        Ok(())
    }

    /// Replaces b by A⁻¹ b.
    pub(super) fn solve(&mut self, b: &mut [f64]) {
        let n = self.n;
        let x = &mut self.scratch;
        for (i, row) in self.entries.chunks_exact(n).enumerate() {
            let known: f64 = row[..i].iter().zip(x.iter()).map(|(l, y)| l * y).sum();
            x[i] = b[self.order[i]] - known;
        }
        for (i, row) in self.entries.chunks_exact(n).enumerate().rev() {
            let known: f64 = row[i + 1..]
                .iter()
                .zip(&b[i + 1..])
                .map(|(u, y)| u * y)
                .sum();
            b[i] = (x[i] - known) * self.reciprocals[i];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Lu;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn prop_solve_inverts_the_product(
            entries in proptest::collection::vec(-1.0..1.0_f64, 16),
            x in proptest::collection::vec(-1.0..1.0_f64, 4),
        ) {
            // A shift makes the matrix regular; the row swap makes pivoting necessary.
            let matrix: Vec<f64> = (0..16)
                .map(|at| entries[at] + if (at / 4 + 1) % 4 == at % 4 { 5.0 } else { 0.0 })
                .collect();
            let mut b: Vec<f64> =
                (0..4).map(|i| (0..4).map(|j| matrix[i * 4 + j] * x[j]).sum()).collect();
            let mut lu = Lu::with_size(4);
            lu.factor(&matrix, "the test matrix", 0.0).unwrap();
            lu.solve(&mut b);
            for i in 0..4 {
                prop_assert!((b[i] - x[i]).abs() < 1e-13);
            }
        }
    }

    #[test]
    fn verify_singular_matrix_is_refused() {
        let error = Lu::with_size(2).factor(&[1.0, 2.0, 2.0, 4.0], "the mass matrix", 0.5);
        let message = error.unwrap_err().to_string();
        assert!(
            message.starts_with("the mass matrix is singular at t = 0.5 s: pivot 1 is 0e0"),
            "{message}"
        );
    }
}
