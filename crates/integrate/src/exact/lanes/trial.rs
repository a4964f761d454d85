//! The joints of eight sets, one after the other.

use pulp::{Arch, Simd};

use super::block::Block;
use super::joint::{JointLanes, LaneLaw};
use super::settle::{Acting, settle};
use super::wide::{Which, Wide};
use super::{Mask, Pack};
use crate::exact::joint::Joint;

impl Block<'_> {
    /// Updates S and D of one joint of the open sets with the others held; the sets that did not stay where they were.
    #[inline(always)]
    pub(super) fn solve_joint<S: Simd>(&mut self, simd: S, k: usize, open: &Mask) -> Mask {
        self.joints[k].without = self.motion_under(simd, k, |j| j != k);
        self.settle_joint(simd, k, open)
    }

    /// The same where the joint is known to be without its own forces.
    #[inline(always)]
    pub(super) fn settle_joint<S: Simd>(&mut self, simd: S, k: usize, open: &Mask) -> Mask {
        let (place, joint) = (&self.places[k], &mut self.joints[k]);
        let first = place.elements[0];
        let which = Which::of(simd, open);
        if place.elements.len() == 1 {
            let moved = self.laws[first].settle(self.arch, place.role(first), joint, open);
            which.put(Wide::of(simd, &joint.force), &mut self.part[first]);
            return moved;
        }
        let mut several = Several {
            arch: self.arch,
            place,
            laws: &self.laws,
            parts: &mut self.trial,
        };
        let (moved, rest) = settle(simd, joint, open, &mut several);
        self.trial[first] = (Wide::of(simd, &self.trial[first]) + rest).pack();
        for &i in &place.elements {
            which.put(Wide::of(simd, &self.trial[i]), &mut self.part[i]);
        }
        moved
    }
}

/// The laws of a joint.
struct Several<'a, 'b> {
    arch: Arch,
    place: &'a Joint,
    laws: &'a [Box<dyn LaneLaw + 'b>],
    /// What each says.
    parts: &'a mut [Pack],
}

impl<S: Simd> Acting<S> for Several<'_, '_> {
    #[inline(always)]
    fn act(&mut self, simd: S, joint: &mut JointLanes) -> Wide<S> {
        let mut sum = Wide::zero(simd);
        for &i in &self.place.elements {
            self.laws[i].act(self.arch, self.place.role(i), joint);
            self.parts[i] = joint.force;
            sum += Wide::of(simd, &joint.force);
        }
        sum
    }
}
