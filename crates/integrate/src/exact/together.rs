//! Elements whose laws offer a tangent, solved together by Newton's method.
//!
//! The orifices of a valve push the pressures that they read within the same step, and each other's through the rod:
//! (3) of [`super::march`] for all of them, with the forces of other elements held,
//!
//! ```text
//! r = φ(d, v) − S,    A = 1 + φ_v Cᵥ,    A Δ = r,    S ← S + Δ                                        (5)
//! ```
//!
//! from where a polynomial through the forces of the last five steps leads, so that one step of Newton's method is mostly enough where
//! they go smoothly. It ends where Δ is within [`LAST_STEP`]: what Newton's method leaves then is
//! of the order of its square. A has a diagonal of at least one where a force resists the velocity and needs no
//! pivots.

use super::law::{MemberMotion, Tangent};
use super::members::Together;
use super::plant::Plant;
use super::secant::{FORCE_TOLERANCE, LAST_STEP, SECANT_STEPS};

impl Plant<'_> {
    /// (5); true if no force changed.
    pub(super) fn solve_together(&mut self, time_s: f64) -> bool {
        for a in 0..self.together.members.len() {
            let i = self.together.members[a];
            self.together.without[a] = self.motion_under(i, |j| !self.joints[j].has_tangent);
            self.together.old[a] = self.smooth[i];
        }
        let (m, c) = (self.joints.len(), &self.compliance);
        let Together {
            members,
            without,
            old,
            matrix,
            residual,
        } = &mut self.together;
        let g = members.len();
        for _ in 0..SECANT_STEPS {
            for (a, &i) in members.iter().enumerate() {
                let [mut displacement, mut velocity] = without[a];
                for &j in &*members {
                    displacement -= c.displacement[i * m + j] * self.smooth[j];
                    velocity -= c.velocity[i * m + j] * self.smooth[j];
                }
                let element = self.joints[i].elements[0];
                let Tangent { force, damping } = self.elements[element].law.tangent(MemberMotion {
                    displacement,
                    velocity,
                    time_s,
                    step_s: self.propagator.time_step_s,
                });
                residual[a] = force - self.smooth[i];
                for (b, &j) in members.iter().enumerate() {
                    let unit = if a == b { 1.0 } else { 0.0 };
                    matrix[a * g + b] = unit + damping * c.velocity[i * m + j];
                }
            }
            eliminate(matrix, residual);
            let mut is_last = true;
            for (&i, change) in members.iter().zip(&*residual) {
                self.smooth[i] += change;
                is_last &= change.abs() <= LAST_STEP * self.smooth[i].abs();
            }
            if is_last {
                break;
            }
        }
        for &i in &*members {
            self.part[self.joints[i].elements[0]] = self.smooth[i];
        }
        let mut each = members.iter().zip(&*old);
        each.all(|(&i, old)| (self.smooth[i] - old).abs() <= FORCE_TOLERANCE * self.smooth[i].abs())
    }
}

/// Solves A x = r in place, without pivots; A is used up.
fn eliminate(matrix: &mut [f64], right: &mut [f64]) {
    let g = right.len();
    for k in 0..g {
        let pivot = 1.0 / matrix[k * g + k];
        for i in k + 1..g {
            let factor = matrix[i * g + k] * pivot;
            for j in k + 1..g {
                matrix[i * g + j] -= factor * matrix[k * g + j];
            }
            right[i] -= factor * right[k];
        }
        matrix[k * g + k] = pivot;
    }
    for k in (0..g).rev() {
        for j in k + 1..g {
            right[k] -= matrix[k * g + j] * right[j];
        }
        right[k] *= matrix[k * g + k];
    }
}

#[cfg(test)]
mod tests {
    use super::eliminate;

    #[test]
    fn verify_elimination_solves() {
        let matrix = [2.0, 0.5, -0.1, 0.3, 1.5, 0.2, -0.4, 0.1, 1.0];
        let wanted = [1.0, -2.0, 0.5];
        let mut right: Vec<f64> = (0..3)
            .map(|i| (0..3).map(|j| matrix[3 * i + j] * wanted[j]).sum())
            .collect();
        eliminate(&mut matrix.clone(), &mut right);
        for (found, wanted) in right.iter().zip(wanted) {
            assert!((found - wanted).abs() < 1e-15, "{found} {wanted}");
        }
    }
}
