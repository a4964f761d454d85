//! One implicit step: equilibrium for one unknown vector.
//!
//! Every implicit method here ends in the same equation for its unknown u:
//!
//! ```text
//! x_e = x_p + c_x u     v_e = v_p + c_v u     a_e = a_p + c_a u                     (1)
//! r(u) = M a_e + C v_e + K x_e + g(x_e, v_e, t_e) − f(t_e) = 0                      (2)
//! J = ∂r/∂u = c_a M + c_v C + c_x K + c_v ∂g/∂ẋ + c_x ∂g/∂x                         (3)
//! ```
//!
//! Without g, J is constant: it is factored once and u = −J⁻¹ r(0). With g, Newton's method with
//! a line search.

use faer::Mat;

use super::balance::{Balance, Instant};
use super::lu::Lu;
use crate::error::{IntegrateError, Result};
use crate::problem::Tangent;

/// Residual relative to the largest sum of forces at which equilibrium is reached: some 1e5
/// roundings, and far below the error of any step that is worth taking.
const NEWTON_TOLERANCE: f64 = 1e-11;

/// Residual, N, below which nothing is left to balance: the range where numbers lose their digits.
const RESIDUAL_FLOOR_N: f64 = 1e-290;

/// Corrections before giving up. A smooth force needs three to five.
const NEWTON_LIMIT: usize = 50;

/// Halvings of a correction that does not lessen the residual.
const HALVING_LIMIT: usize = 12;

/// c_x, c_v, c_a of Equation (1).
#[derive(Debug, Clone, Copy)]
pub(super) struct Coefficients {
    pub(super) displacement: f64,
    pub(super) velocity: f64,
    pub(super) acceleration: f64,
}

/// x_p, v_p, a_p of Equation (1).
pub(super) struct Predictor {
    pub(super) x: Vec<f64>,
    pub(super) v: Vec<f64>,
    pub(super) a: Vec<f64>,
}

impl Predictor {
    pub(super) fn zeros(n: usize) -> Self {
        Self {
            x: vec![0.0; n],
            v: vec![0.0; n],
            a: vec![0.0; n],
        }
    }
}

/// Solver of Equation (2), with all its room.
pub(super) struct Implicit {
    coefficients: Coefficients,
    /// c_a M + c_v C + c_x K.
    linear_part: Vec<f64>,
    jacobian: Vec<f64>,
    factor: Lu,
    tangent: Tangent,
    trial: Predictor,
    residual: Vec<f64>,
    correction: Vec<f64>,
    scratch: Vec<f64>,
}

impl Implicit {
    pub(super) fn new(
        balance: &mut Balance<'_, '_>,
        coefficients: Coefficients,
        start_s: f64,
    ) -> Result<Self> {
        let problem = balance.problem;
        let n = problem.dof_count();
        let linear_part: Vec<f64> = (0..n * n)
            .map(|at| {
                coefficients.acceleration * problem.mass()[at]
                    + coefficients.velocity * problem.damping()[at]
                    + coefficients.displacement * problem.stiffness()[at]
            })
            .collect();
        let mut factor = Lu::with_size(n);
        if problem.nonlinear_force().is_none() {
            factor.factor(&linear_part, "the step matrix", start_s)?;
            balance.work.factorisations += 1;
        }
        Ok(Self {
            coefficients,
            jacobian: linear_part.clone(),
            linear_part,
            factor,
            tangent: Tangent {
                stiffness: Mat::zeros(n, n),
                damping: Mat::zeros(n, n),
            },
            trial: Predictor::zeros(n),
            residual: vec![0.0; n],
            correction: vec![0.0; n],
            scratch: vec![0.0; n],
        })
    }

    /// Solves for u. On arrival `u` holds a first guess (used only with a nonlinear force).
    pub(super) fn solve(
        &mut self,
        balance: &mut Balance<'_, '_>,
        at: Instant,
        predictor: &Predictor,
        u: &mut [f64],
    ) -> Result<()> {
        if balance.problem.nonlinear_force().is_none() {
            u.fill(0.0);
            self.residual_at(balance, at, predictor, u);
            self.factor.solve(&mut self.residual);
            for (unknown, shift) in u.iter_mut().zip(&self.residual) {
                *unknown = -shift;
            }
            return Ok(());
        }
        self.newton(balance, at, predictor, u)
    }

    fn newton(
        &mut self,
        balance: &mut Balance<'_, '_>,
        at: Instant,
        predictor: &Predictor,
        u: &mut [f64],
    ) -> Result<()> {
        let mut norm = self.residual_at(balance, at, predictor, u);
        if !norm.is_finite() {
            return Err(IntegrateError::ForceNotFinite {
                time_s: at.time_s,
                found: norm,
            });
        }
        let mut tolerance = self.tolerance(balance, at);
        for _ in 0..NEWTON_LIMIT {
            if norm <= tolerance {
                return Ok(());
            }
            balance.work.newton_iterations += 1;
            self.renew_jacobian(balance, at, u)?;
            self.correction.copy_from_slice(&self.residual);
            self.factor.solve(&mut self.correction);
            // Full correction first; half of it, and so on, while the residual does not fall.
            let mut length = 1.0;
            step_by(u, &self.correction, -length);
            let mut tried = self.residual_at(balance, at, predictor, u);
            for _ in 0..HALVING_LIMIT {
                if tried < norm {
                    break;
                }
                step_by(u, &self.correction, 0.5 * length);
                length *= 0.5;
                tried = self.residual_at(balance, at, predictor, u);
            }
            norm = tried;
            tolerance = self.tolerance(balance, at);
        }
        if norm <= tolerance {
            return Ok(());
        }
        Err(IntegrateError::NotConverged {
            time_s: at.time_s,
            iterations: NEWTON_LIMIT,
            residual_n: norm,
            tolerance_n: tolerance,
        })
    }

    /// Equations (1) and (2); returns the largest entry, NaN if any is NaN.
    fn residual_at(
        &mut self,
        balance: &mut Balance<'_, '_>,
        at: Instant,
        predictor: &Predictor,
        u: &[f64],
    ) -> f64 {
        let n = u.len();
        let Coefficients {
            displacement,
            velocity,
            acceleration,
        } = self.coefficients;
        let trial = &mut self.trial;
        for i in 0..n {
            trial.x[i] = predictor.x[i] + displacement * u[i];
            trial.v[i] = predictor.v[i] + velocity * u[i];
            trial.a[i] = predictor.a[i] + acceleration * u[i];
        }
        balance.unbalanced(at, &trial.x, &trial.v, &mut self.residual);
        let mut largest = 0.0_f64;
        for (i, row) in balance.problem.mass().chunks_exact(n).enumerate() {
            let inertia: f64 = row.iter().zip(&trial.a).map(|(m, a)| m * a).sum();
            self.residual[i] = inertia - self.residual[i];
            let size = self.residual[i].abs();
            if size > largest || size.is_nan() {
                largest = size;
            }
        }
        largest
    }

    fn tolerance(&mut self, balance: &Balance<'_, '_>, at: Instant) -> f64 {
        let trial = &self.trial;
        let size = balance.size(at, &trial.x, &trial.v, &trial.a, &mut self.scratch);
        (NEWTON_TOLERANCE * size).max(RESIDUAL_FLOOR_N)
    }

    /// Equation (3) at the trial point, factored.
    fn renew_jacobian(
        &mut self,
        balance: &mut Balance<'_, '_>,
        at: Instant,
        u: &[f64],
    ) -> Result<()> {
        let Some(nonlinear) = balance.problem.nonlinear_force() else {
            return Ok(());
        };
        let n = u.len();
        let Coefficients {
            displacement,
            velocity,
            ..
        } = self.coefficients;
        self.jacobian.copy_from_slice(&self.linear_part);
        self.tangent.stiffness.fill(0.0);
        self.tangent.damping.fill(0.0);
        let supplied =
            nonlinear.tangent(at.time_s, &self.trial.x, &self.trial.v, &mut self.tangent);
        if supplied {
            for entry in 0..n * n {
                let place = (entry / n, entry % n);
                self.jacobian[entry] += displacement * self.tangent.stiffness[place]
                    + velocity * self.tangent.damping[place];
            }
        } else {
            self.difference_jacobian(balance, at, u);
        }
        self.factor
            .factor(&self.jacobian, "the step matrix", at.time_s)?;
        balance.work.factorisations += 1;
        Ok(())
    }

    /// Adds ∂g/∂u by one forward difference per unknown. C and K drop out of the difference of two
    /// unbalanced forces by hand, so that only g is differenced.
    fn difference_jacobian(&mut self, balance: &mut Balance<'_, '_>, at: Instant, u: &[f64]) {
        let n = u.len();
        let Coefficients {
            displacement,
            velocity,
            ..
        } = self.coefficients;
        let Some(nonlinear) = balance.problem.nonlinear_force() else {
            return;
        };
        let trial = &mut self.trial;
        self.correction.fill(0.0);
        nonlinear.force(at.time_s, &trial.x, &trial.v, &mut self.correction);
        for j in 0..n {
            let (x, v) = (trial.x[j], trial.v[j]);
            let step = difference_step(u[j], (x, displacement), (v, velocity));
            trial.x[j] = x + displacement * step;
            trial.v[j] = v + velocity * step;
            self.scratch.fill(0.0);
            nonlinear.force(at.time_s, &trial.x, &trial.v, &mut self.scratch);
            for i in 0..n {
                self.jacobian[i * n + j] += (self.scratch[i] - self.correction[i]) / step;
            }
            (trial.x[j], trial.v[j]) = (x, v);
        }
        balance.work.right_hand_sides += n + 1;
    }
}

/// A change of the unknown that moves u, x or v by the root of the rounding, whichever is largest.
fn difference_step(u: f64, x: (f64, f64), v: (f64, f64)) -> f64 {
    let mut size = u.abs();
    for (value, coefficient) in [x, v] {
        if coefficient > 0.0 {
            size = size.max(value.abs() / coefficient);
        }
    }
    f64::EPSILON.sqrt() * if size > 0.0 { size } else { 1.0 }
}

fn step_by(u: &mut [f64], correction: &[f64], length: f64) {
    for (unknown, shift) in u.iter_mut().zip(correction) {
        *unknown += length * shift;
    }
}
