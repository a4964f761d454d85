//! Equations (3) and (4) of [`crate::exact::march`] for one joint of eight sets, by trials of its S.

use pulp::Simd;

use super::Mask;
use super::joint::JointLanes;
use super::secant::Secant;
use super::wide::{Which, Wide};
use crate::exact::secant::FORCE_TOLERANCE;

/// What acts at a joint.
pub(super) trait Acting<S: Simd> {
    /// What it says at the motion of the joint: S, and D, which the joint keeps.
    fn act(&mut self, simd: S, joint: &mut JointLanes) -> Wide<S>;
}

/// Updates S and D of a joint of the open sets; the sets that did not stay where they were, and what S is more than at the last
/// trial.
#[inline(always)]
pub(super) fn settle<S: Simd>(
    simd: S,
    joint: &mut JointLanes,
    open: &Mask,
    acting: &mut impl Acting<S>,
) -> (Mask, Wide<S>) {
    let open = Which::of(simd, open);
    let old_smooth = Wide::of(simd, &joint.smooth);
    let old_dry = Wide::of(simd, &joint.dry_force);
    let gain = Wide::of(simd, &joint.gain);
    joint.give_way(simd, old_smooth);
    let mut force = acting.act(simd, joint);
    let mut secant = Secant::begin(open, old_smooth, force, gain);
    while secant.is_open() {
        joint.give_way(simd, secant.tried);
        force = acting.act(simd, joint);
        secant.step(force);
    }
    let smooth = secant.smooth;
    let give_velocity = Wide::of(simd, &joint.compliance[1]);
    let moved = give_velocity * (smooth - secant.tried);
    // Not a closure: maps of arrays are not inlined.
    let [mean, end, stiffness] = &joint.dry;
    let (mean, end) = (Wide::of(simd, mean), Wide::of(simd, end));
    let stiffness = Wide::of(simd, stiffness);
    let dry_force = mean - stiffness * moved;
    let dry_give = Wide::of(simd, &joint.dry_compliance[1]);
    let without = Wide::of(simd, &joint.without[1]);
    let velocity = without - dry_give * dry_force - give_velocity * smooth;
    open.put(end - stiffness * moved, &mut joint.dry_end);
    open.put(velocity, &mut joint.end_velocity);
    open.put(smooth, &mut joint.smooth);
    open.put(dry_force, &mut joint.dry_force);
    open.put(secant.kept_gain(), &mut joint.gain);
    let change = (smooth - old_smooth).abs() + (dry_force - old_dry).abs();
    let tolerance = Wide::splat(simd, FORCE_TOLERANCE);
    let settled = change.is_at_most(tolerance * (smooth.abs() + dry_force.abs()));
    ((open & !settled).mask(), smooth - force)
}
