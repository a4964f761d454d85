//! Natural frequencies, damping ratios and mode shapes.

use std::f64::consts::TAU;

use faer::linalg::solvers::Solve;
use faer::{Mat, Side, c64};

use crate::{ModelError, StructuralMatrices};

/// Modes of the undamped structure, lowest first.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct UndampedModes {
    /// ω_r, rad/s; zero for a rigid-body mode.
    pub natural_freq_rad: Vec<f64>,
    /// ω_r / 2π, Hz.
    pub natural_freq_hz: Vec<f64>,
    /// Mode shapes as columns, mass-normalised (φᵀ M φ = 1), largest component positive. n × n.
    #[serde(with = "crate::serial::rows")]
    pub mode_shape: Mat<f64>,
}

/// One mode of the damped structure.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct DampedMode {
    /// Eigenvalue λ, rad/s, with Im λ ≥ 0.
    #[serde(with = "crate::serial::complex")]
    pub eigenvalue: c64,
    /// |λ| / 2π, Hz.
    pub natural_freq_hz: f64,
    /// Im λ / 2π, Hz; zero for an overdamped mode.
    pub damped_freq_hz: f64,
    /// −Re λ / |λ|; one for an overdamped mode, zero for λ = 0.
    pub damping_ratio: f64,
    /// Complex shape of the displacements, largest component 1. Length n.
    #[serde(with = "crate::serial::complex_list")]
    pub mode_shape: Vec<c64>,
}

/// An eigenvalue below this fraction of the largest is a rigid-body mode: the symmetric
/// eigenvalue problem is solved to a few units in the last place of its largest eigenvalue.
const RIGID_BODY_FRACTION: f64 = 1e-13;

/// Solves the undamped eigenvalue problem
///
/// ```text
/// K φ = ω² M φ                                  (1)
/// M = L Lᵀ,   S = L⁻¹ K L⁻ᵀ,   S q = ω² q       (2)
/// φ = L⁻ᵀ q,  so that φᵀ M φ = qᵀ q = 1         (3)
/// ```
///
/// # Errors
/// [`ModelError::Singular`] when M is not positive definite, [`ModelError::Eigen`] when the
/// iteration fails.
///
/// ```
/// use simgap_model::{StructuralMatrices, undamped_modes};
/// use faer::mat;
/// let structure = StructuralMatrices {
///     mass_matrix: mat![[33_000.0]],
///     damping_matrix: mat![[0.0]],
///     stiffness_matrix: mat![[8_287_639.0]],
/// };
/// let modes = undamped_modes(&structure)?;
/// assert!((modes.natural_freq_hz[0] - 2.5222).abs() < 1e-4);
/// # Ok::<(), simgap_model::ModelError>(())
/// ```
///
/// Reference: \[Ewins2000\], chapter 2.
pub fn undamped_modes(structure: &StructuralMatrices) -> Result<UndampedModes, ModelError> {
    let n = structure.dof_count();
    if n == 0 {
        return Ok(UndampedModes {
            natural_freq_rad: vec![],
            natural_freq_hz: vec![],
            mode_shape: Mat::zeros(0, 0),
        });
    }
    let llt = structure
        .mass_matrix
        .llt(Side::Lower)
        .map_err(|_| ModelError::Singular {
            matrix: "mass matrix",
            context: "undamped modes".into(),
        })?;
    // (2): S = L⁻¹ K L⁻ᵀ, symmetrised against rounding.
    let lower = llt.L().to_owned();
    let half = forward_substitute(&lower, &structure.stiffness_matrix);
    let full = forward_substitute(&lower, &half.transpose().to_owned());
    let symmetric = Mat::from_fn(n, n, |i, j| 0.5 * (full[(i, j)] + full[(j, i)]));
    let evd = symmetric
        .self_adjoint_eigen(Side::Lower)
        .map_err(|_| ModelError::Eigen {
            matrix: "undamped structure",
        })?;
    let squared: Vec<f64> = evd.S().column_vector().iter().copied().collect();
    let largest = squared.iter().fold(0.0_f64, |m, s| m.max(s.abs()));
    let natural_freq_rad: Vec<f64> = squared
        .iter()
        .map(|&s| {
            if s <= RIGID_BODY_FRACTION * largest {
                0.0
            } else {
                s.sqrt()
            }
        })
        .collect();
    // (3)
    let mut mode_shape = lower
        .transpose()
        .to_owned()
        .partial_piv_lu()
        .solve(evd.U().to_owned());
    for r in 0..n {
        let peak = (0..n).fold(0.0_f64, |p, i| {
            if mode_shape[(i, r)].abs() > p.abs() {
                mode_shape[(i, r)]
            } else {
                p
            }
        });
        if peak < 0.0 {
            for i in 0..n {
                mode_shape[(i, r)] = -mode_shape[(i, r)];
            }
        }
    }
    Ok(UndampedModes {
        natural_freq_hz: natural_freq_rad.iter().map(|w| w / TAU).collect(),
        natural_freq_rad,
        mode_shape,
    })
}

fn forward_substitute(lower: &Mat<f64>, rhs: &Mat<f64>) -> Mat<f64> {
    let n = lower.nrows();
    let mut x = rhs.clone();
    for j in 0..x.ncols() {
        for i in 0..n {
            let mut sum = x[(i, j)];
            for k in 0..i {
                sum -= lower[(i, k)] * x[(k, j)];
            }
            x[(i, j)] = sum / lower[(i, i)];
        }
    }
    x
}

/// Solves the damped eigenvalue problem of the state `[x; ẋ]`
///
/// ```text
/// A = [ 0        I      ]      A ψ = λ ψ
///     [ −M⁻¹K   −M⁻¹C   ]
/// ```
///
/// and returns one mode for each conjugate pair and for each real eigenvalue, lowest |λ| first.
///
/// # Errors
/// [`ModelError::Singular`] when M is singular, [`ModelError::Eigen`] when the iteration fails.
///
/// Reference: \[Ewins2000\], chapter 2.
pub fn damped_modes(structure: &StructuralMatrices) -> Result<Vec<DampedMode>, ModelError> {
    damped_modes_of(structure, &vec![false; structure.dof_count()])
}

/// As [`damped_modes`] where some coordinates are of first order ([`crate::Model::first_order`]): only their rates are
/// states, and the zero poles of their integrals are none of the plant.
///
/// # Errors
/// As [`damped_modes`]; [`ModelError::Shape`] for another number of coordinates.
pub fn damped_modes_of(
    structure: &StructuralMatrices,
    first_order: &[bool],
) -> Result<Vec<DampedMode>, ModelError> {
    let n = structure.dof_count();
    if first_order.len() != n {
        return Err(ModelError::Shape {
            place: "modes".into(),
            found: format!(
                "{} coordinates told of first order or not",
                first_order.len()
            ),
            needed: format!("{n}, one for each coordinate"),
        });
    }
    if n == 0 {
        return Ok(vec![]);
    }
    let state = state_matrix(structure)?;
    let (unit, whole) = (velocity_unit(&state), balanced(&state));
    let kept: Vec<usize> = (0..2 * n).filter(|&k| k >= n || !first_order[k]).collect();
    let evd = Mat::from_fn(kept.len(), kept.len(), |i, j| whole[(kept[i], kept[j])])
        .eigen()
        .map_err(|_| ModelError::Eigen {
            matrix: "damped structure",
        })?;
    let values = evd.S();
    let vectors = evd.U();
    // Of a coordinate of first order, its rate over λ.
    let displacement = |i: usize, r: usize| -> c64 {
        let of = |entry: usize| kept.iter().position(|&k| k == entry);
        let zero = c64::new(0.0, 0.0);
        match (of(i), of(n + i)) {
            (Some(row), _) => vectors[(row, r)],
            (None, Some(row)) if values[r] != zero => vectors[(row, r)] * unit / values[r],
            _ => zero,
        }
    };
    let mut modes: Vec<DampedMode> = (0..kept.len())
        .map(|r| (values[r], r))
        .filter(|(lambda, _)| lambda.im >= 0.0)
        .map(|(lambda, r)| {
            let shape: Vec<c64> = (0..n).map(|i| displacement(i, r)).collect();
            DampedMode::new(lambda, shape)
        })
        .collect();
    modes.sort_by(|a, b| {
        a.natural_freq_hz
            .total_cmp(&b.natural_freq_hz)
            .then(a.eigenvalue.re.total_cmp(&b.eigenvalue.re))
    });
    Ok(modes)
}

impl DampedMode {
    fn new(eigenvalue: c64, mut mode_shape: Vec<c64>) -> DampedMode {
        let size = eigenvalue.norm();
        let peak =
            mode_shape.iter().fold(
                c64::new(0.0, 0.0),
                |p, &z| {
                    if z.norm() > p.norm() { z } else { p }
                },
            );
        if peak.norm() > 0.0 {
            for z in &mut mode_shape {
                *z /= peak;
            }
        }
        DampedMode {
            eigenvalue,
            natural_freq_hz: size / TAU,
            damped_freq_hz: eigenvalue.im / TAU,
            damping_ratio: if size > 0.0 {
                -eigenvalue.re / size
            } else {
                0.0
            },
            mode_shape,
        }
    }
}

/// A in units of displacement and of velocity over ω = ‖M⁻¹K‖^½: the same eigenvalues and shapes of
/// the displacements, with blocks of one size, which keeps the digits of a stiff structure.
pub(crate) fn balanced(state: &Mat<f64>) -> Mat<f64> {
    let n = state.nrows() / 2;
    let omega = velocity_unit(state);
    let unit = |i: usize| if i < n { 1.0 } else { omega };
    Mat::from_fn(2 * n, 2 * n, |i, j| state[(i, j)] * unit(j) / unit(i))
}

/// ω of [`balanced`].
fn velocity_unit(state: &Mat<f64>) -> f64 {
    let n = state.nrows() / 2;
    let largest = (0..n * n)
        .map(|k| state[(n + k / n, k % n)].abs())
        .fold(0.0, f64::max);
    if largest > 0.0 { largest.sqrt() } else { 1.0 }
}

/// The state matrix A of [`damped_modes`], 2n × 2n.
///
/// # Errors
/// [`ModelError::Singular`] when M is singular.
pub fn state_matrix(structure: &StructuralMatrices) -> Result<Mat<f64>, ModelError> {
    let n = structure.dof_count();
    let mut state = Mat::zeros(2 * n, 2 * n);
    for i in 0..n {
        state[(i, n + i)] = 1.0;
    }
    for j in 0..n {
        let column = |m: &Mat<f64>| -> Result<Vec<f64>, ModelError> {
            let rhs: Vec<f64> = (0..n).map(|i| m[(i, j)]).collect();
            crate::dense::solve(&structure.mass_matrix, &rhs).ok_or_else(|| ModelError::Singular {
                matrix: "mass matrix",
                context: "state matrix".into(),
            })
        };
        let stiffness = column(&structure.stiffness_matrix)?;
        let damping = column(&structure.damping_matrix)?;
        for i in 0..n {
            state[(n + i, j)] = -stiffness[i];
            state[(n + i, n + j)] = -damping[i];
        }
    }
    Ok(state)
}
