//! What the integral of the core leaves out, in closed form.
//!
//! ```text
//! ln Z₀ = ln(L π)(û) + ½ d ln 2π − ½ ln det A,   A = H + S⁻¹              (1)
//! ends:  A = H N/N_c + S⁻¹                                                (2)
//! tails: + ln Γ((n − k)/2) − ln Γ(n/2) + ½ k ln(n/2),   k = tr(H A⁻¹)     (3)
//! edge:  + ln Φ(−|δ|) + ½ δ²,   δ = (û − m)/s                             (4)
//! noise: + (1 − ζ) k (k + 2)/(4 n)                                        (5)
//! ```
//!
//! (1) is that of the core. (2): ln L counts the N samples of the records, V_c the N_c samples that are not near an end, so
//! that H of the fit is too small by N_c/N. (3): the likelihood with an unknown variance is (1 + xᵀHx/n)^(−n/2), which has
//! heavier tails than a normal one where the effective number of samples n is small; k of the directions are seen. (4): a
//! value that the data do not see on one side (a level beyond the signal) is held at the edge by its prior N(m, s²): the
//! mass of the prior beyond the edge counts, not its density there. (5): beyond the noise s the likelihood falls by n (1 − s/V)/2, where (3) has
//! n ln(V/s)/2; to second order its tails are twice as heavy.

use std::f64::consts::TAU;

use faer::linalg::solvers::Solve;
use faer::{Mat, Side};

use crate::integrand::Integrand;
use crate::random::normal_cdf;

/// (1).
pub(crate) fn of_the_core(integrand: &Integrand<'_>) -> f64 {
    normal(integrand, 1.0).0
}

/// (1) with (2) to (5), of a plant with one output.
pub(crate) fn corrected(integrand: &Integrand<'_>) -> f64 {
    let (all, counted) = integrand.sample_counts();
    let (log_z, seen) = normal(integrand, all / counted);
    let n = integrand.effective_samples();
    let tails = log_gamma(0.5 * (n - seen)) - log_gamma(0.5 * n) + 0.5 * seen * (0.5 * n).ln();
    let edges = integrand.unseen().into_iter().map(|apart: f64| {
        let below = normal_cdf(-apart.abs());
        below.ln() + 0.5 * apart * apart
    });
    let of_noise = integrand.coarsened() * seen * (seen + 2.0) / (4.0 * n);
    log_z + tails + of_noise + edges.sum::<f64>()
}

/// (1) with a factor on H, and k of (3).
fn normal(integrand: &Integrand<'_>, factor: f64) -> (f64, f64) {
    let (centre, hessian, precision) = integrand.quadratic();
    let dim = centre.len();
    let matrix = Mat::from_fn(dim, dim, |i, j| {
        factor * hessian[(i, j)] + if i == j { precision[i] } else { 0.0 }
    });
    let solver = matrix.llt(Side::Lower).unwrap();
    let log_determinant: f64 = (0..dim).map(|i| 2.0 * solver.L()[(i, i)].ln()).sum();
    let inverse = solver.solve(Mat::<f64>::identity(dim, dim));
    let unseen: f64 = (0..dim).map(|i| inverse[(i, i)] * precision[i]).sum();
    let joint = integrand.log_joint(&[centre])[0];
    (
        joint + 0.5 * dim as f64 * TAU.ln() - 0.5 * log_determinant,
        dim as f64 - unseen,
    )
}

/// ln Γ(x), x > 0, by Stirling's series from x + 8 on.
fn log_gamma(x: f64) -> f64 {
    let up: f64 = (0..8).map(|k| (x + f64::from(k)).ln()).sum();
    let y = x + 8.0;
    let series = 1.0 / (12.0 * y) - 1.0 / (360.0 * y.powi(3)) + 1.0 / (1260.0 * y.powi(5));
    (y - 0.5) * y.ln() - y + 0.5 * TAU.ln() + series - up
}

#[test]
fn verify_log_gamma_of_known_values() {
    assert!((log_gamma(5.0) - 24.0_f64.ln()).abs() < 1e-9);
    assert!((log_gamma(0.5) - 0.5 * std::f64::consts::PI.ln()).abs() < 1e-9);
}
