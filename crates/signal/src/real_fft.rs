//! Forward transform of real data: one complex transform of half the length where that is possible.

use std::f64::consts::TAU;

use rustfft::FftPlanner;
use rustfft::num_complex::Complex64;

/// X_k = Σ x_n e^{-2πi k n / N}, k = 0 … ⌊N/2⌋.
///
/// Even N: z_n = x_{2n} + i x_{2n+1} is transformed at length M = N/2 and untangled,
///
/// ```text
/// E_k = ½ (Z_k + conj Z_{M-k}),   O_k = -½ i (Z_k - conj Z_{M-k}),   X_k = E_k + e^{-2πi k/N} O_k
/// ```
///
/// Odd N is transformed as complex numbers with zero imaginary part.
pub(crate) fn real_fft(values: &[f64]) -> Vec<Complex64> {
    let n = values.len();
    let mut planner = FftPlanner::new();
    if !n.is_multiple_of(2) || n == 0 {
        let mut z: Vec<Complex64> = values.iter().map(|&v| Complex64::new(v, 0.0)).collect();
        if n > 0 {
            planner.plan_fft_forward(n).process(&mut z);
            z.truncate(n / 2 + 1);
        }
        return z;
    }
    let half = n / 2;
    let mut z: Vec<Complex64> = values
        .chunks_exact(2)
        .map(|p| Complex64::new(p[0], p[1]))
        .collect();
    planner.plan_fft_forward(half).process(&mut z);
    (0..=half)
        .map(|k| {
            let a = z[k % half];
            let b = z[(half - k) % half].conj();
            let even = (a + b) * 0.5;
            let odd = (a - b) * Complex64::new(0.0, -0.5);
            even + Complex64::from_polar(1.0, -TAU * k as f64 / n as f64) * odd
        })
        .collect()
}
