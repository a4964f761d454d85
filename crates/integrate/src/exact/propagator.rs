//! Exact discrete propagation of the linear part with a first-order hold.

use faer::Mat;
use simgap_model::{ModelError, StructuralMatrices, state_matrix};

use super::expm::matrix_exponential;

/// One step of length h of `M ẍ + C ẋ + K x = f(t)` with f linear over the step,
///
/// ```text
/// z = [x; ẋ],   ż = A z + B f,   B = [0; M⁻¹]                       (1)
/// z₁ = Φ z₀ + Γ₀ f₀ + Γ₁ f₁                                         (2)
///     ⎡hA hB 0⎤      ⎡Φ  G  Γ₁⎤
/// exp ⎢0  0  I⎥  =   ⎢0  I  I ⎥   Γ₀ = G − Γ₁                       (3)
///     ⎣0  0  0⎦      ⎣0  0  I ⎦
/// ```
///
/// exact for any stiffness and any h. Matrices are row-major: Φ is 2n × 2n, Γ₀ and Γ₁ are 2n × n.
///
/// Reference: \[Franklin1998\], section 4.3; the augmented exponential is \[VanLoan1978\].
#[derive(Debug, Clone, PartialEq)]
pub struct ExactPropagator {
    pub(super) dof_count: usize,
    pub(super) time_step_s: f64,
    pub(super) phi: Vec<f64>,
    pub(super) gamma0: Vec<f64>,
    pub(super) gamma1: Vec<f64>,
    pub(super) inverse_mass: Vec<f64>,
    pub(super) stiffness: Vec<f64>,
    pub(super) damping: Vec<f64>,
}

impl ExactPropagator {
    /// Prepares the step.
    ///
    /// # Errors
    /// [`ModelError::Singular`] when M is singular, [`ModelError::Value`] when the step is not
    /// positive or the structure grows beyond the range of numbers within one step.
    pub fn new(
        structure: &StructuralMatrices,
        time_step_s: f64,
    ) -> Result<ExactPropagator, ModelError> {
        if !(time_step_s.is_finite() && time_step_s > 0.0) {
            return Err(step_error(time_step_s));
        }
        let n = structure.dof_count();
        let state = state_matrix(structure)?;
        let inverse_mass = inverse(&structure.mass_matrix, n)?;
        let (phi, gamma0, gamma1) = if n == 0 {
            (vec![], vec![], vec![])
        } else {
            blocks(&state, &inverse_mass, time_step_s)
        };
        if phi.iter().chain(&gamma0).any(|value| !value.is_finite()) {
            return Err(step_error(time_step_s));
        }
        let rows = |m: &Mat<f64>| (0..n * n).map(|k| m[(k / n, k % n)]).collect();
        Ok(ExactPropagator {
            dof_count: n,
            time_step_s,
            phi,
            gamma0,
            gamma1,
            inverse_mass,
            stiffness: rows(&structure.stiffness_matrix),
            damping: rows(&structure.damping_matrix),
        })
    }

    /// Number of degrees of freedom n.
    #[must_use]
    pub fn dof_count(&self) -> usize {
        self.dof_count
    }

    /// h, s.
    #[must_use]
    pub fn time_step_s(&self) -> f64 {
        self.time_step_s
    }
}

/// Φ, Γ₀ and Γ₁ of (3), row-major.
///
/// The exponential is taken in units that balance the blocks, displacement in m, velocity in ω m
/// and force in ω² m / ‖M⁻¹‖ with ω² = ‖M⁻¹K‖: the norm is then ω h, not ω² h, and with it go the
/// number of squarings and the rounding of a stiff structure.
fn blocks(state: &Mat<f64>, inverse_mass: &[f64], h: f64) -> (Vec<f64>, Vec<f64>, Vec<f64>) {
    let n = state.nrows() / 2;
    let largest = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, f64::max);
    let stiffness = largest(&mut (0..n * n).map(|k| state[(n + k / n, k % n)].abs()));
    let omega = if stiffness > 0.0 {
        stiffness.sqrt()
    } else {
        1.0 / h
    };
    let mobility = largest(&mut inverse_mass.iter().map(|value| value.abs()));
    let force_unit = omega * omega / mobility;
    let unit = |i: usize| if i < n { 1.0 } else { omega };

    let mut augmented = Mat::zeros(4 * n, 4 * n);
    for i in 0..2 * n {
        for j in 0..2 * n {
            augmented[(i, j)] = h * state[(i, j)] * unit(j) / unit(i);
        }
    }
    for i in 0..n {
        for j in 0..n {
            augmented[(n + i, 2 * n + j)] = h * inverse_mass[i * n + j] * force_unit / omega;
        }
        augmented[(2 * n + i, 3 * n + i)] = 1.0;
    }
    let exponential = matrix_exponential(&augmented);
    let phi = (0..4 * n * n)
        .map(|k| (k / (2 * n), k % (2 * n)))
        .map(|(i, j)| exponential[(i, j)] * unit(i) / unit(j))
        .collect();
    let forced = |column: usize| -> Vec<f64> {
        (0..2 * n * n)
            .map(|k| (k / n, k % n))
            .map(|(i, j)| exponential[(i, column + j)] * unit(i) / force_unit)
            .collect()
    };
    let gamma1 = forced(3 * n);
    let gamma0 = forced(2 * n)
        .iter()
        .zip(&gamma1)
        .map(|(sum, end)| sum - end)
        .collect();
    (phi, gamma0, gamma1)
}

fn step_error(found: f64) -> ModelError {
    ModelError::Value {
        place: "exact propagation".into(),
        quantity: "time step".into(),
        found,
        needed: "a positive step over which the structure stays finite",
    }
}

fn inverse(matrix: &Mat<f64>, n: usize) -> Result<Vec<f64>, ModelError> {
    use faer::linalg::solvers::Solve;
    if n == 0 {
        return Ok(vec![]);
    }
    let inverse = matrix.partial_piv_lu().solve(Mat::<f64>::identity(n, n));
    let rows: Vec<f64> = (0..n * n).map(|k| inverse[(k / n, k % n)]).collect();
    if rows.iter().all(|value| value.is_finite()) {
        return Ok(rows);
    }
    Err(ModelError::Singular {
        matrix: "mass matrix",
        context: "exact propagation".into(),
    })
}
