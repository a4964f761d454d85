//! Equations (3) and (4) of [`crate::exact::march`] for one joint of eight sets, by trials of its S.

use pulp::Simd;

use super::block::Block;
use super::joint::Acting;
use super::secant::Secant;
use super::wide::{Which, Wide};
use super::{Mask, Pack};
use crate::exact::secant::FORCE_TOLERANCE;

impl Block<'_> {
    /// Updates S and D of one joint of the open sets with the others held; the sets that did not stay where they were.
    #[inline(always)]
    pub(super) fn solve_joint<S: Simd>(&mut self, simd: S, k: usize, open: &Mask) -> Mask {
        let without = self.motion_under(simd, k, |j| j != k);
        let open = Which::of(simd, open);
        let joint = &self.joints[k];
        let [old_smooth, old_dry] =
            [&joint.smooth, &joint.dry_force].map(|pack| Wide::of(simd, pack));
        let gain = Wide::of(simd, &joint.gain);
        let mut force = self.act(simd, k, &without, old_smooth);
        let mut secant = Secant::begin(open, old_smooth, force, gain);
        while secant.is_open() {
            force = self.act(simd, k, &without, secant.tried);
            secant.step(force);
        }
        let smooth = secant.smooth;
        let first = self.places[k].elements[0];
        let part = Wide::of(simd, &self.trial[first]) + (smooth - force);
        self.trial[first] = part.pack();
        for &i in &self.places[k].elements {
            open.put(Wide::of(simd, &self.trial[i]), &mut self.part[i]);
        }
        let joint = &mut self.joints[k];
        let give_velocity = Wide::of(simd, &joint.compliance[1]);
        let moved = give_velocity * (smooth - secant.tried);
        let [mean, end, stiffness] = joint.dry.each_ref().map(|pack| Wide::of(simd, pack));
        let dry_force = mean - stiffness * moved;
        let dry_give = Wide::of(simd, &joint.dry_compliance[1]);
        let velocity = Wide::of(simd, &without[1]) - dry_give * dry_force - give_velocity * smooth;
        open.put(end - stiffness * moved, &mut joint.dry_end);
        open.put(velocity, &mut joint.end_velocity);
        open.put(smooth, &mut joint.smooth);
        open.put(dry_force, &mut joint.dry_force);
        open.put(secant.kept_gain(), &mut joint.gain);
        let change = (smooth - old_smooth).abs() + (dry_force - old_dry).abs();
        let tolerance = Wide::splat(simd, FORCE_TOLERANCE);
        let settled = change.is_at_most(tolerance * (smooth.abs() + dry_force.abs()));
        (open & !settled).mask()
    }

    /// What the laws of a joint say where S is `smooth`: S, and D, which the joint keeps.
    #[inline(always)]
    fn act<S: Simd>(&mut self, simd: S, k: usize, without: &[Pack; 2], smooth: Wide<S>) -> Wide<S> {
        let joint = &mut self.joints[k];
        let [give, give_velocity] = [0, 1].map(|i| Wide::of(simd, &joint.compliance[i]));
        let [displacement, velocity] = [0, 1].map(|i| Wide::of(simd, &without[i]));
        joint.displacement = (displacement - give * smooth).pack();
        joint.velocity = (velocity - give_velocity * smooth).pack();
        let mut sum = Wide::zero(simd);
        for (place, &i) in self.places[k].elements.iter().enumerate() {
            let is = Acting {
                dry: place == 0 && self.places[k].dry,
                remembering: self.places[k].remembers == Some(i),
            };
            self.laws[i].act(self.arch, is, joint);
            self.trial[i] = joint.force;
            sum += Wide::of(simd, &joint.force);
        }
        sum
    }
}
