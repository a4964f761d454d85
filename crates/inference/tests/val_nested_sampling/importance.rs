//! The same integral by importance sampling about the fit.
//!
//! ```text
//! Z = ∫ L π du ≈ (1/m) Σ_k w_k,   w_k = L(u_k) π(u_k) / t(u_k)            (1)
//! σ(ln Z)² ≈ 1/ESS − 1/m,   ESS = (Σ w)² / Σ w²                           (2)
//! ```
//!
//! t is Student's distribution with [`FREEDOM`] degrees of freedom, about û with A⁻¹ of the core.

use std::f64::consts::PI;

use faer::{Mat, Side};

use crate::integrand::Integrand;
use crate::random::Random;

/// Degrees of freedom of t, whose tails are to be heavier than those of the integrand.
const FREEDOM: usize = 5;
/// Draws that are evaluated together.
const TOGETHER: usize = 64;

pub(crate) struct Weighted {
    pub(crate) log_z: f64,
    pub(crate) error: f64,
    /// ESS of (2) over the number of draws.
    pub(crate) efficiency: f64,
}

pub(crate) fn importance_sampling(integrand: &Integrand<'_>, draws: usize, seed: u64) -> Weighted {
    let (centre, hessian, precision) = integrand.quadratic();
    let dim = centre.len();
    let matrix = Mat::from_fn(dim, dim, |i, j| {
        hessian[(i, j)] + if i == j { precision[i] } else { 0.0 }
    });
    let factor = matrix.llt(Side::Lower).unwrap();
    let lower = factor.L();
    let log_determinant: f64 = (0..dim).map(|i| lower[(i, i)].ln()).sum();
    let nu = FREEDOM as f64;
    let half = |d: usize| log_gamma_of_half(d);
    let constant =
        half(FREEDOM + dim) - half(FREEDOM) - 0.5 * dim as f64 * (nu * PI).ln() + log_determinant;
    let mut random = Random::new(seed);
    let mut logs: Vec<f64> = vec![];
    while logs.len() < draws {
        let (points, log_drawn): (Vec<Vec<f64>>, Vec<f64>) = (0..TOGETHER)
            .map(|_| {
                let normal: Vec<f64> = (0..dim).map(|_| random.normal()).collect();
                let square: f64 = (0..FREEDOM).map(|_| random.normal().powi(2)).sum();
                let stretch = (nu / square).sqrt();
                // Lᵀ x = z: the covariance of x is A⁻¹.
                let mut x = vec![0.0; dim];
                for i in (0..dim).rev() {
                    let known: f64 = (i + 1..dim).map(|j| lower[(j, i)] * x[j]).sum();
                    x[i] = (normal[i] * stretch - known) / lower[(i, i)];
                }
                let apart: f64 = normal.iter().map(|z| (z * stretch).powi(2)).sum();
                let log = constant - 0.5 * (nu + dim as f64) * (apart / nu).ln_1p();
                (x.iter().zip(&centre).map(|(x, c)| x + c).collect(), log)
            })
            .unzip();
        let joint = integrand.log_joint(&points);
        logs.extend(
            joint
                .iter()
                .zip(log_drawn)
                .map(|(joint, drawn)| joint - drawn),
        );
    }
    let most = logs.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let sum: f64 = logs.iter().map(|log| (log - most).exp()).sum();
    let squares: f64 = logs.iter().map(|log| (2.0 * (log - most)).exp()).sum();
    let (count, effective) = (logs.len() as f64, sum * sum / squares);
    Weighted {
        log_z: most + (sum / count).ln(),
        error: (1.0 / effective - 1.0 / count).max(0.0).sqrt(),
        efficiency: effective / count,
    }
}

/// ln Γ(d/2).
fn log_gamma_of_half(d: usize) -> f64 {
    let (mut at, mut log) = if d.is_multiple_of(2) {
        (2, 0.0)
    } else {
        (1, 0.5 * PI.ln())
    };
    while at < d {
        log += (0.5 * at as f64).ln();
        at += 2;
    }
    log
}
