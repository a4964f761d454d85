//! What a method makes of free vibration in one step, in closed form.

use faer::{Mat, c64};

use super::Method;
use super::generalized_alpha::GeneralizedAlpha;
use crate::error::{IntegrateError, Result};
use crate::inverse::PARK_WEIGHTS;

/// Amplification matrix A of a method for ẍ + 2ζω ẋ + ω² x = 0: z_(n+1) = A z_n.
///
/// | method | state z | size |
/// |---|---|---|
/// | Newmark, generalized-alpha | x_n, v_n/ω, a_n/ω² | 3 |
/// | Park | x_n, x_(n−1), x_(n−2), v_n/ω, v_(n−1)/ω, v_(n−2)/ω | 6 |
/// | Runge-Kutta, Dormand-Prince (one step of given length) | x_n, v_n/ω | 2 |
///
/// | symbol | argument | unit | valid |
/// |---|---|---|---|
/// | ω h | `step_angle` | rad | finite, > 0 |
/// | ζ | `damping_ratio` | 1 | finite, ≥ 0 |
///
/// # Errors
///
/// [`IntegrateError::Parameter`].
///
/// ```
/// use simgap_integrate::{Method, Newmark, amplification_matrix, spectral_radius};
/// let matrix = amplification_matrix(Method::Newmark(Newmark::TRAPEZOIDAL), 0.7, 0.0)?;
/// assert!((spectral_radius(&matrix)? - 1.0).abs() < 1e-14);
/// # Ok::<(), simgap_integrate::IntegrateError>(())
/// ```
///
/// Reference: Hughes 1987 (`hughes1987`), chapter 9.
pub fn amplification_matrix(
    method: Method,
    step_angle: f64,
    damping_ratio: f64,
) -> Result<Mat<f64>> {
    check(
        "step_angle",
        step_angle,
        step_angle > 0.0,
        "finite and greater than 0",
    )?;
    check(
        "damping_ratio",
        damping_ratio,
        damping_ratio >= 0.0,
        "finite and 0 or more",
    )?;
    Ok(match method {
        Method::Park => park(step_angle, damping_ratio),
        Method::Newmark(newmark) => averaged(newmark.into(), step_angle, damping_ratio),
        Method::GeneralizedAlpha(parameters) => averaged(parameters, step_angle, damping_ratio),
        // Coefficients of z^k in the stability polynomial.
        Method::RungeKutta4 => explicit(
            &[1.0 / 24.0, 1.0 / 6.0, 0.5, 1.0, 1.0],
            step_angle,
            damping_ratio,
        ),
        Method::DormandPrince(_) => explicit(
            &[
                1.0 / 600.0,
                1.0 / 120.0,
                1.0 / 24.0,
                1.0 / 6.0,
                0.5,
                1.0,
                1.0,
            ],
            step_angle,
            damping_ratio,
        ),
    })
}

/// Largest modulus of the eigenvalues: the factor by which free vibration grows per step at worst.
///
/// # Errors
///
/// [`IntegrateError::Eigenvalues`].
///
/// ```
/// use faer::mat;
/// let radius = simgap_integrate::spectral_radius(&mat![[0.0, 1.0], [-0.25, 0.0]])?;
/// assert!((radius - 0.5).abs() < 1e-14);
/// # Ok::<(), simgap_integrate::IntegrateError>(())
/// ```
pub fn spectral_radius(matrix: &Mat<f64>) -> Result<f64> {
    Ok(eigenvalues(matrix)?
        .iter()
        .fold(0.0, |top, z| z.norm().max(top)))
}

/// Numerical damping and dispersion of undamped free vibration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dissipation {
    /// Largest modulus of all roots.
    pub spectral_radius: f64,
    /// −ln|z| / |arg z| of the root that stands for the vibration: the damping ratio it appears to
    /// have, for small values.
    pub damping_ratio: f64,
    /// ω h / |arg z| − 1: relative lengthening of the period.
    pub period_elongation: f64,
}

/// Damping and dispersion at one `step_angle` = ω h; below π, where the vibration is resolved.
///
/// The root that stands for the vibration is the one closest to exp(iωh).
///
/// # Errors
///
/// As [`amplification_matrix`], and [`IntegrateError::Eigenvalues`].
///
/// ```
/// use simgap_integrate::{Method, numerical_dissipation};
/// let found = numerical_dissipation(Method::Park, 0.1)?;
/// assert!((found.period_elongation - 0.01 / 6.0).abs() < 1e-4);
/// assert!(found.damping_ratio < 1e-5 / 12.0);
/// # Ok::<(), simgap_integrate::IntegrateError>(())
/// ```
pub fn numerical_dissipation(method: Method, step_angle: f64) -> Result<Dissipation> {
    let roots = eigenvalues(&amplification_matrix(method, step_angle, 0.0)?)?;
    let exact = c64::new(step_angle.cos(), step_angle.sin());
    let mut principal = roots[0];
    for root in &roots {
        if (root - exact).norm() < (principal - exact).norm() {
            principal = *root;
        }
    }
    let angle = principal.arg().abs();
    Ok(Dissipation {
        spectral_radius: roots.iter().fold(0.0, |top, z| z.norm().max(top)),
        damping_ratio: -principal.norm().ln() / angle,
        period_elongation: step_angle / angle - 1.0,
    })
}

fn eigenvalues(matrix: &Mat<f64>) -> Result<Vec<c64>> {
    if !matrix.is_all_finite() {
        return Err(IntegrateError::Eigenvalues {
            rows: matrix.nrows(),
        });
    }
    matrix
        .eigenvalues()
        .map_err(|_| IntegrateError::Eigenvalues {
            rows: matrix.nrows(),
        })
}

/// Newmark and generalized-alpha with Ω = ω h and scaled states.
///
/// ```text
/// x' = x + Ω v + Ω² ((1/2 − β) a + β a')           v' = v + Ω ((1 − γ) a + γ a')
/// (1 − α_m) a' + α_m a + (1 − α_f)(2ζ v' + x') + α_f (2ζ v + x) = 0
/// ```
fn averaged(parameters: GeneralizedAlpha, step_angle: f64, damping_ratio: f64) -> Mat<f64> {
    let GeneralizedAlpha {
        alpha_m,
        alpha_f,
        beta,
        gamma,
    } = parameters;
    let square = step_angle * step_angle;
    let late = 1.0 - alpha_f;
    let pivot = 1.0 - alpha_m + late * (2.0 * damping_ratio * step_angle * gamma + square * beta);
    let next = [
        -1.0 / pivot,
        -(2.0 * damping_ratio + late * step_angle) / pivot,
        -(alpha_m
            + late * (2.0 * damping_ratio * step_angle * (1.0 - gamma) + square * (0.5 - beta)))
            / pivot,
    ];
    let x = [1.0, step_angle, square * (0.5 - beta)];
    let v = [0.0, 1.0, step_angle * (1.0 - gamma)];
    Mat::from_fn(3, 3, |i, j| match i {
        0 => x[j] + square * beta * next[j],
        1 => v[j] + step_angle * gamma * next[j],
        _ => next[j],
    })
}

/// Park's method with Ω = ω h, r = Ω/p₀ and scaled states.
///
/// ```text
/// v' = v_p + r a'      x' = x_p + r² a'      a' + 2ζ v' + x' = 0
/// v_p = −Σ p_k v_(n+1−k) / p₀                x_p = r v_p − Σ p_k x_(n+1−k) / p₀
/// ```
fn park(step_angle: f64, damping_ratio: f64) -> Mat<f64> {
    let reach = step_angle / PARK_WEIGHTS[0];
    let past = |k: usize| -PARK_WEIGHTS[k + 1] / PARK_WEIGHTS[0];
    let v = |j: usize| if j < 3 { 0.0 } else { past(j - 3) };
    let x = |j: usize| if j < 3 { past(j) } else { reach * past(j - 3) };
    let pivot = 1.0 + 2.0 * damping_ratio * reach + reach * reach;
    let a = |j: usize| -(2.0 * damping_ratio * v(j) + x(j)) / pivot;
    Mat::from_fn(6, 6, |i, j| match i {
        0 => x(j) + reach * reach * a(j),
        3 => v(j) + reach * a(j),
        _ => f64::from(u8::from(j + 1 == i)),
    })
}

/// Horner's scheme for a polynomial of Ω [[0, 1], [−1, −2ζ]].
fn explicit(coefficients: &[f64], step_angle: f64, damping_ratio: f64) -> Mat<f64> {
    let generator = [
        [0.0, step_angle],
        [-step_angle, -2.0 * damping_ratio * step_angle],
    ];
    let mut sum = [[0.0; 2]; 2];
    for coefficient in coefficients {
        let mut next = [[0.0; 2]; 2];
        for i in 0..2 {
            for j in 0..2 {
                next[i][j] = sum[i][0] * generator[0][j] + sum[i][1] * generator[1][j];
            }
            next[i][i] += coefficient;
        }
        sum = next;
    }
    Mat::from_fn(2, 2, |i, j| sum[i][j])
}

fn check(name: &'static str, found: f64, valid: bool, needed: &'static str) -> Result<()> {
    if found.is_finite() && valid {
        Ok(())
    } else {
        Err(IntegrateError::Parameter {
            name,
            found,
            needed,
        })
    }
}
