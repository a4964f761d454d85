//! (5) of [`crate::exact::together`] for eight sets, in the order of the march of one.

use pulp::{Simd, WithSimd};

use super::block::Block;
use super::wide::{Which, Wide};
use super::{Mask, Pack};
use crate::exact::secant::{FORCE_TOLERANCE, LAST_STEP, SECANT_STEPS};

/// A whole solution at a time: not to be compiled again with every march and every observer.
struct Solve<'a, 'b>(&'a mut Block<'b>, &'a Mask);

impl WithSimd for Solve<'_, '_> {
    type Output = Mask;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Mask {
        self.0.solve_members(simd, self.1)
    }
}

impl Block<'_> {
    /// Solves for the forces of the members in the open sets; the sets whose forces changed.
    pub(super) fn solve_together(&mut self, open: &Mask) -> Mask {
        let arch = self.arch;
        arch.dispatch(Solve(self, open))
    }

    #[inline(always)]
    fn solve_members<S: Simd>(&mut self, simd: S, open: &Mask) -> Mask {
        self.without_members(simd);
        let m = self.joints.len();
        let g = self.together.members.len();
        let open = Which::of(simd, open);
        let mut going = open;
        let last = Wide::splat(simd, LAST_STEP);
        for _ in 0..SECANT_STEPS {
            for a in 0..g {
                self.tangent(simd, a);
                let i = self.together.members[a];
                let [force, damping] = &self.joints[i].tangent;
                let smooth = Wide::of(simd, &self.joints[i].smooth);
                let damping = Wide::of(simd, damping);
                self.together.residual[a] = (Wide::of(simd, force) - smooth).pack();
                for (b, &j) in self.together.members.iter().enumerate() {
                    let unit = Wide::splat(simd, if a == b { 1.0 } else { 0.0 });
                    let give = Wide::of(simd, &self.compliance[1][i * m + j]);
                    self.together.matrix[a * g + b] = (unit + damping * give).pack();
                }
            }
            eliminate(simd, &mut self.together.matrix, &mut self.together.residual);
            let mut is_last = Which::of(simd, &Mask::ALL);
            let members = self.together.members.iter();
            for (&i, change) in members.zip(&self.together.residual) {
                let change = Wide::of(simd, change);
                let smooth = Wide::of(simd, &self.joints[i].smooth) + change;
                is_last = is_last & change.abs().is_at_most(last * smooth.abs());
                going.put(smooth, &mut self.joints[i].smooth);
            }
            going = going & !is_last;
            if !going.any() {
                break;
            }
        }
        for &i in &self.together.members {
            self.part[self.places[i].elements[0]] = self.joints[i].smooth;
        }
        let tolerance = Wide::splat(simd, FORCE_TOLERANCE);
        let mut settled = Which::of(simd, &Mask::ALL);
        for (&i, old) in self.together.members.iter().zip(&self.together.old) {
            let smooth = Wide::of(simd, &self.joints[i].smooth);
            let change = (smooth - Wide::of(simd, old)).abs();
            settled = settled & change.is_at_most(tolerance * smooth.abs());
        }
        (open & !settled).mask()
    }

    /// Motion of the members without their own forces.
    #[inline(always)]
    fn without_members<S: Simd>(&mut self, simd: S) {
        for a in 0..self.together.members.len() {
            let i = self.together.members[a];
            self.together.without[a] = self.motion_under(simd, i, |j| !self.places[j].has_tangent);
            self.together.old[a] = self.joints[i].smooth;
        }
    }

    /// Force and slope of a member where the forces of all take it.
    #[inline(always)]
    fn tangent<S: Simd>(&mut self, simd: S, a: usize) {
        let m = self.joints.len();
        let i = self.together.members[a];
        let without = &self.together.without[a];
        let mut displacement = Wide::of(simd, &without[0]);
        let mut velocity = Wide::of(simd, &without[1]);
        for &j in &self.together.members {
            let smooth = Wide::of(simd, &self.joints[j].smooth);
            displacement -= Wide::of(simd, &self.compliance[0][i * m + j]) * smooth;
            velocity -= Wide::of(simd, &self.compliance[1][i * m + j]) * smooth;
        }
        let joint = &mut self.joints[i];
        (joint.displacement, joint.velocity) = (displacement.pack(), velocity.pack());
        self.laws[self.places[i].elements[0]].tangent(self.arch, joint);
    }
}

/// Solves A x = r in place, without pivots; A is used up.
#[inline(always)]
fn eliminate<S: Simd>(simd: S, matrix: &mut [Pack], right: &mut [Pack]) {
    let g = right.len();
    let one = Wide::splat(simd, 1.0);
    for k in 0..g {
        let pivot = one / Wide::of(simd, &matrix[k * g + k]);
        for i in k + 1..g {
            let factor = Wide::of(simd, &matrix[i * g + k]) * pivot;
            for j in k + 1..g {
                let taken = factor * Wide::of(simd, &matrix[k * g + j]);
                matrix[i * g + j] = (Wide::of(simd, &matrix[i * g + j]) - taken).pack();
            }
            let taken = factor * Wide::of(simd, &right[k]);
            right[i] = (Wide::of(simd, &right[i]) - taken).pack();
        }
        matrix[k * g + k] = pivot.pack();
    }
    for k in (0..g).rev() {
        for j in k + 1..g {
            let taken = Wide::of(simd, &matrix[k * g + j]) * Wide::of(simd, &right[j]);
            right[k] = (Wide::of(simd, &right[k]) - taken).pack();
        }
        right[k] = (Wide::of(simd, &right[k]) * Wide::of(simd, &matrix[k * g + k])).pack();
    }
}
