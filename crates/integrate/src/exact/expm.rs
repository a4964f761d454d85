//! Matrix exponential by scaling and squaring with the [13/13] Padé approximant.

use faer::Mat;
use faer::linalg::solvers::Solve;

/// Numerator coefficients b₀..b₁₃ of the [13/13] Padé approximant to eˣ,
/// b_j = (26 − j)! 13! / (26! j! (13 − j)!), scaled to b₁₃ = 1. \[Higham2005\], eq. (2.8).
const PADE_13: [f64; 14] = [
    64_764_752_532_480_000.0,
    32_382_376_266_240_000.0,
    7_771_770_303_897_600.0,
    1_187_353_796_428_800.0,
    129_060_195_264_000.0,
    10_559_470_521_600.0,
    670_442_572_800.0,
    33_522_128_640.0,
    1_323_241_920.0,
    40_840_800.0,
    960_960.0,
    16_380.0,
    182.0,
    1.0,
];

/// Largest 1-norm for which the [13/13] approximant is accurate to double precision,
/// \[Higham2005\], table 2.3.
const THETA_13: f64 = 5.371_920_351_148_152;

/// eᴬ of a square matrix.
///
/// ```text
/// eᴬ = (e^(A / 2ˢ))^(2ˢ),  ‖A / 2ˢ‖₁ ≤ θ₁₃                        (1)
/// r₁₃(X) = (−U + V)⁻¹ (U + V)                                      (2)
/// U = X (X⁶ (b₁₃X⁶ + b₁₁X⁴ + b₉X²) + b₇X⁶ + b₅X⁴ + b₃X² + b₁I)     (3)
/// V =    X⁶ (b₁₂X⁶ + b₁₀X⁴ + b₈X²) + b₆X⁶ + b₄X⁴ + b₂X² + b₀I      (4)
/// ```
///
/// Entries that are not finite give a result that is not finite; the callers check theirs.
///
/// Reference: \[Higham2005\].
#[must_use]
pub fn matrix_exponential(matrix: &Mat<f64>) -> Mat<f64> {
    let n = matrix.nrows();
    let norm = (0..n)
        .map(|j| (0..n).map(|i| matrix[(i, j)].abs()).sum::<f64>())
        .fold(0.0, f64::max);
    if n == 0 || !norm.is_finite() {
        return Mat::from_fn(n, n, |_, _| f64::NAN);
    }
    // (1)
    let squarings = if norm > THETA_13 {
        (norm / THETA_13).log2().ceil() as i32
    } else {
        0
    };
    let scale = 0.5_f64.powi(squarings);
    let x = Mat::from_fn(n, n, |i, j| matrix[(i, j)] * scale);
    let b = &PADE_13;
    let x2 = &x * &x;
    let x4 = &x2 * &x2;
    let x6 = &x4 * &x2;
    let sum = |c6: f64, c4: f64, c2: f64, c0: f64| {
        Mat::from_fn(n, n, |i, j| {
            let unit = if i == j { c0 } else { 0.0 };
            c6 * x6[(i, j)] + c4 * x4[(i, j)] + c2 * x2[(i, j)] + unit
        })
    };
    // (3), (4)
    let u = &x * (&x6 * sum(b[13], b[11], b[9], 0.0) + sum(b[7], b[5], b[3], b[1]));
    let v = &x6 * sum(b[12], b[10], b[8], 0.0) + sum(b[6], b[4], b[2], b[0]);
    // (2)
    let mut result = (&v - &u).partial_piv_lu().solve(&v + &u);
    for _ in 0..squarings {
        result = &result * &result;
    }
    result
}

#[cfg(test)]
mod tests {
    use super::*;
    use faer::mat;

    /// Twenty units in the last place: the approximant and a handful of squarings.
    const ROUNDING: f64 = 20.0 * f64::EPSILON;

    #[test]
    fn verify_rotation_and_shear() {
        for angle in [1e-3, 0.4, 3.0] {
            let e = matrix_exponential(&mat![[0.0, -angle], [angle, 0.0_f64]]);
            assert!((e[(0, 0)] - f64::cos(angle)).abs() < ROUNDING);
            assert!((e[(1, 0)] - f64::sin(angle)).abs() < ROUNDING);
        }
        let e = matrix_exponential(&mat![[0.0, 7.0], [0.0, 0.0_f64]]);
        assert!((e[(0, 1)] - 7.0).abs() < 7.0 * ROUNDING);
        assert_eq!(e[(1, 0)], 0.0);
    }

    #[test]
    fn verify_stiff_decay() {
        let e = matrix_exponential(&mat![[-4000.0, 0.0], [0.0, -0.5_f64]]);
        assert!(e[(0, 0)].abs() < 1e-300);
        assert!((e[(1, 1)] - f64::exp(-0.5)).abs() < 1e-12);
    }

    #[test]
    fn verify_against_the_power_series() {
        let a = mat![[0.3, -1.1, 0.2], [0.9, 0.1, -0.4], [-0.2, 0.5, 0.7_f64]];
        let mut term = Mat::<f64>::identity(3, 3);
        let mut series = term.clone();
        for k in 1..40 {
            term = &term * &a * faer::Scale(1.0 / f64::from(k));
            series += &term;
        }
        let e = matrix_exponential(&a);
        for i in 0..3 {
            for j in 0..3 {
                assert!((e[(i, j)] - series[(i, j)]).abs() < ROUNDING * 3.0);
            }
        }
    }

    #[test]
    fn verify_pade_coefficients() {
        // b_{j+1} / b_j = (13 − j) / ((26 − j)(j + 1)), exact in integers.
        for j in 0..13_usize {
            let left = PADE_13[j] * (13 - j) as f64;
            let right = PADE_13[j + 1] * ((26 - j) * (j + 1)) as f64;
            assert_eq!(left, right, "coefficient {j}");
        }
    }
}
