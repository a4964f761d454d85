//! The sampler against integrals that are known.

use std::f64::consts::TAU;

use crate::random::normal_quantile;
use crate::sampler::{Found, Settings, nested_sampling};

/// A result is within so many of its stated errors: one of the comparisons here in 400 would not be by chance, and the
/// seeds are fixed.
const ERRORS: f64 = 3.0;

fn sampled(dim: usize, walks: bool, log_likelihood: impl Fn(&[f64]) -> f64) -> Found {
    let settings = Settings {
        live: 400,
        seed: 7 + dim as u64,
        walks,
    };
    let mut all = |points: &[Vec<f64>]| points.iter().map(|point| log_likelihood(point)).collect();
    nested_sampling(dim, &mut all, &settings)
}

fn assert_agrees(name: &str, found: &Found, exact: f64) {
    let apart = found.log_z - exact;
    println!(
        "{name}: {:.3}, exact {exact:.3}, apart {apart:.3}, error {:.3}, H {:.1}, {} points, walked {}",
        found.log_z, found.error, found.information, found.evaluations, found.walked
    );
    assert!(
        apart.abs() < ERRORS * found.error,
        "{name}: {apart} apart, error {}",
        found.error
    );
}

/// The normal likelihood of standard deviation σ_k about m_k under normal priors of unit variance:
/// ln Z = −½ Σ (m_k²/(1 + σ_k²) + ln(1 + 1/σ_k²)), the likelihood one at its peak.
#[test]
fn verify_normal_integrals_in_one_to_six_dimensions() {
    for dim in 1..=6 {
        let of = |k: usize| (0.3 - 0.2 * k as f64, 0.01 * f64::from(1 << k));
        let log_likelihood = |point: &[f64]| {
            let each = point.iter().enumerate().map(|(k, below)| {
                let (mean, std) = of(k);
                ((normal_quantile(*below) - mean) / std).powi(2)
            });
            -0.5 * each.sum::<f64>()
        };
        let exact: f64 = (0..dim)
            .map(|k| {
                let (mean, std) = of(k);
                -0.5 * (mean.powi(2) / (1.0 + std * std) + (1.0 + std.powi(-2)).ln())
            })
            .sum();
        for walks in [false, true] {
            let found = sampled(dim, walks, log_likelihood);
            assert_agrees(
                &format!("normal, {dim} dimensions, walks {walks}"),
                &found,
                exact,
            );
        }
    }
}

/// ln of the mean of a likelihood over a square, by the midpoint rule.
fn by_quadrature(log_likelihood: impl Fn(&[f64]) -> f64) -> f64 {
    let steps = 2000;
    let middle = |k: usize| (k as f64 + 0.5) / f64::from(steps);
    let steps = steps as usize;
    let row = |i: usize| {
        (0..steps)
            .map(|j| log_likelihood(&[middle(i), middle(j)]).exp())
            .sum::<f64>()
    };
    let sum: f64 = (0..steps).map(row).sum();
    (sum / (steps * steps) as f64).ln()
}

/// A curved valley: x₂ = x₁² within 0.05, x₁ to both sides of zero.
#[test]
fn verify_a_banana_against_quadrature() {
    let banana = |point: &[f64]| {
        let (x, y) = (6.0 * point[0] - 3.0, 10.0 * point[1] - 1.0);
        -0.5 * (((y - x * x) / 0.05).powi(2) + (x / 1.2).powi(2))
    };
    let exact = by_quadrature(banana);
    for walks in [false, true] {
        assert_agrees(
            &format!("banana, walks {walks}"),
            &sampled(2, walks, banana),
            exact,
        );
    }
}

/// Two peaks of a width of 0.01 and 0.02 at opposite corners.
#[test]
fn verify_two_peaks_against_quadrature() {
    let peak = |point: &[f64], at: f64, std: f64| {
        let square: f64 = point.iter().map(|x| ((x - at) / std).powi(2)).sum();
        (-0.5 * square).exp() / (TAU * std * std)
    };
    let both = |point: &[f64]| {
        (0.7 * peak(point, 0.2, 0.01) + 0.3 * peak(point, 0.8, 0.02))
            .max(1e-290)
            .ln()
    };
    let exact = by_quadrature(both);
    for walks in [false, true] {
        assert_agrees(
            &format!("two peaks, walks {walks}"),
            &sampled(2, walks, both),
            exact,
        );
    }
}

/// Half of the square has no density: ln Z of a constant is ln ½.
#[test]
fn verify_a_prior_without_density_in_places() {
    let half = |point: &[f64]| {
        if point[0] + point[1] < 1.0 {
            -2.0 - point[0]
        } else {
            f64::NEG_INFINITY
        }
    };
    let exact = by_quadrature(half);
    assert_agrees("half a square", &sampled(2, false, half), exact);
}
