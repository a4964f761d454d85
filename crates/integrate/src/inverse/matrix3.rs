//! Algebra of 3 × 3 matrices, which is all the smoother needs.

pub(super) type Vector = [f64; 3];
pub(super) type Matrix = [[f64; 3]; 3];

/// B P⁻¹ for symmetric positive definite P, by Cholesky.
pub(super) fn solve_right(b: &Matrix, p: &Matrix) -> Matrix {
    let mut l = [[0.0; 3]; 3];
    for i in 0..3 {
        for j in 0..=i {
            let sum: f64 = p[i][j] - (0..j).map(|k| l[i][k] * l[j][k]).sum::<f64>();
            // P holds Q, which is positive definite; the floor only guards the last bits.
            l[i][j] = if i == j {
                sum.max(p[i][i] * f64::EPSILON).sqrt()
            } else {
                sum / l[j][j]
            };
        }
    }
    b.map(|row| {
        let mut x = row;
        for i in 0..3 {
            let sum: f64 = (0..i).map(|k| l[i][k] * x[k]).sum();
            x[i] = (x[i] - sum) / l[i][i];
        }
        for i in (0..3).rev() {
            let sum: f64 = (i + 1..3).map(|k| l[k][i] * x[k]).sum();
            x[i] = (x[i] - sum) / l[i][i];
        }
        x
    })
}

/// A v.
pub(super) fn apply(matrix: &Matrix, vector: &Vector) -> Vector {
    matrix.map(|row| row.iter().zip(vector).map(|(a, b)| a * b).sum())
}

/// A B.
pub(super) fn multiply(a: &Matrix, b: &Matrix) -> Matrix {
    let mut out = [[0.0; 3]; 3];
    for i in 0..3 {
        for j in 0..3 {
            out[i][j] = (0..3).map(|k| a[i][k] * b[k][j]).sum();
        }
    }
    out
}

/// Aᵀ.
pub(super) fn transpose(a: &Matrix) -> Matrix {
    let mut out = [[0.0; 3]; 3];
    for i in 0..3 {
        for j in 0..3 {
            out[j][i] = a[i][j];
        }
    }
    out
}
