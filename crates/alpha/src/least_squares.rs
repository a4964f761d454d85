//! Linear and nonlinear least squares with standard errors.

use faer::Mat;
use faer::linalg::solvers::SolveLstsq;

use crate::AlphaError;

/// A column whose part orthogonal to the others is below this fraction of it adds nothing that
/// double precision could tell apart.
const RANK_FRACTION: f64 = 1e-11;

/// Iterations allowed; a fit that starts within a bin of the line needs about five.
const MAX_ITERATIONS: usize = 60;

/// Relative step below which the iteration has settled: what is left is rounding.
const SETTLED: f64 = 1e-12;

/// Coefficients b of y ≈ X b, with what is known about them.
pub(crate) struct LinearFit {
    /// b.
    pub(crate) coefficients: Vec<f64>,
    /// Standard errors, √diag(s² (XᵀX)⁻¹).
    pub(crate) standard_errors: Vec<f64>,
    /// Σ (y − X b)².
    pub(crate) residual_square_sum: f64,
}

/// Least squares by QR of the columns, each scaled to unit length.
///
/// ```text
/// X = Q R,   R b = Qᵀ y,   cov b = s² R⁻¹ R⁻ᵀ,   s² = Σ r² / (N − p)
/// ```
pub(crate) fn linear(
    what: &'static str,
    columns: &[Vec<f64>],
    values: &[f64],
) -> Result<LinearFit, AlphaError> {
    let (rows, count) = (values.len(), columns.len());
    if rows <= count {
        return Err(AlphaError::Length {
            what,
            found: rows,
            needed: count + 1,
        });
    }
    let undetermined = || AlphaError::Undetermined {
        what,
        coefficients: count,
    };
    let lengths: Vec<f64> = columns
        .iter()
        .map(|column| column.iter().map(|x| x * x).sum::<f64>().sqrt())
        .collect();
    if lengths
        .iter()
        .any(|length| *length == 0.0 || !length.is_finite())
    {
        return Err(undetermined());
    }
    let matrix = Mat::from_fn(rows, count, |i, j| columns[j][i] / lengths[j]);
    let qr = matrix.qr();
    let upper = qr.thin_R();
    if (0..count).any(|j| upper[(j, j)].abs() < RANK_FRACTION) {
        return Err(undetermined());
    }
    let rhs = Mat::from_fn(rows, 1, |i, _| values[i]);
    let scaled = qr.solve_lstsq(rhs);
    let coefficients: Vec<f64> = (0..count).map(|j| scaled[(j, 0)] / lengths[j]).collect();
    let residual_square_sum = (0..rows)
        .map(|i| {
            let fitted: f64 = (0..count).map(|j| coefficients[j] * columns[j][i]).sum();
            (values[i] - fitted).powi(2)
        })
        .sum::<f64>();
    let variance = residual_square_sum / (rows - count) as f64;
    let inverse = inverse_upper(count, |i, j| upper[(i, j)]);
    let standard_errors = (0..count)
        .map(|i| {
            let row: f64 = (i..count).map(|j| inverse[i][j] * inverse[i][j]).sum();
            (variance * row).sqrt() / lengths[i]
        })
        .collect();
    Ok(LinearFit {
        coefficients,
        standard_errors,
        residual_square_sum,
    })
}

/// R⁻¹ of an upper triangle, by back substitution.
fn inverse_upper(n: usize, upper: impl Fn(usize, usize) -> f64) -> Vec<Vec<f64>> {
    let mut inverse = vec![vec![0.0; n]; n];
    for j in 0..n {
        inverse[j][j] = 1.0 / upper(j, j);
        for i in (0..j).rev() {
            let sum: f64 = (i + 1..=j).map(|k| upper(i, k) * inverse[k][j]).sum();
            inverse[i][j] = -sum / upper(i, i);
        }
    }
    inverse
}

/// Gauss-Newton with step halving. `model` gives the fitted values and their derivatives (one
/// column per parameter); `scales` are typical sizes that judge whether a step still matters.
pub(crate) fn nonlinear(
    what: &'static str,
    values: &[f64],
    start: &[f64],
    scales: &[f64],
    model: impl Fn(&[f64]) -> (Vec<f64>, Vec<Vec<f64>>),
) -> Result<LinearFit, AlphaError> {
    let residual_of = |fitted: &[f64]| -> Vec<f64> {
        values
            .iter()
            .zip(fitted)
            .map(|(value, fitted)| value - fitted)
            .collect()
    };
    let square_sum = |residual: &[f64]| residual.iter().map(|r| r * r).sum::<f64>();
    let mut parameters = start.to_vec();
    let (fitted, mut columns) = model(&parameters);
    let mut residual = residual_of(&fitted);
    for _ in 0..MAX_ITERATIONS {
        let step = linear(what, &columns, &residual)?;
        let before = square_sum(&residual);
        let mut factor = 1.0;
        loop {
            let trial: Vec<f64> = parameters
                .iter()
                .zip(&step.coefficients)
                .map(|(p, s)| p + factor * s)
                .collect();
            let (fitted, derivatives) = model(&trial);
            let trial_residual = residual_of(&fitted);
            let size = step
                .coefficients
                .iter()
                .zip(scales)
                .map(|(s, scale)| (factor * s / scale).abs())
                .fold(0.0, f64::max);
            let better = square_sum(&trial_residual) <= before;
            if better || size < SETTLED {
                if better {
                    (parameters, columns, residual) = (trial, derivatives, trial_residual);
                }
                if size < SETTLED.sqrt() {
                    return Ok(LinearFit {
                        coefficients: parameters,
                        standard_errors: step.standard_errors,
                        residual_square_sum: square_sum(&residual),
                    });
                }
                break;
            }
            factor *= 0.5;
        }
    }
    Err(AlphaError::NoConvergence {
        what,
        iterations: MAX_ITERATIONS,
    })
}
