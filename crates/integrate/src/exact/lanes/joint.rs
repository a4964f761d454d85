//! One joint of the plant in eight lanes, and what its laws do with it.

use pulp::{Arch, Simd};

use super::wide::Wide;
use super::{Mask, Pack};
use crate::exact::role::Role;

/// One law with the parameters of eight sets. Made by [`gather`](super::gather), or lane by lane for laws that
/// do not offer [`ForceLaw::lanes`](crate::exact::ForceLaw::lanes).
pub trait LaneLaw: Send + Sync {
    /// The forces where a joint would be without its dry force: the dry one, which moves it, then the single-valued part.
    fn act(&self, arch: Arch, role: Role, joint: &mut JointLanes);

    /// Updates S and D of a joint where nothing else is, in the open sets; those that did not stay where they were. The joint
    /// then has what the law says as its force.
    fn settle(&self, arch: Arch, role: Role, joint: &mut JointLanes, open: &Mask) -> Mask;

    /// Force and slope at the motion of the joint, for laws that are solved together.
    fn tangent(&self, arch: Arch, joint: &mut JointLanes);

    /// Commits the memory at the end of a step.
    fn remember(&self, arch: Arch, joint: &mut JointLanes);
}

/// One joint of eight sets within one step.
#[derive(Debug, Clone)]
pub struct JointLanes {
    /// Motion at the end of the step under the forces of the trial.
    pub(super) displacement: Pack,
    pub(super) velocity: Pack,
    pub(super) time_s: Pack,
    /// Length of the step.
    pub(super) step_s: Pack,
    /// Motion there without its own forces.
    pub(super) without: [Pack; 2],
    /// What a unit of its forces takes from displacement and velocity.
    pub(super) compliance: [Pack; 2],
    pub(super) dry_compliance: [Pack; 2],
    pub(super) start_velocity: Pack,
    /// Velocity at the end of the step without the forces of any element.
    pub(super) free_velocity: Pack,
    pub(super) end_velocity: Pack,
    pub(super) smooth: Pack,
    pub(super) dry_force: Pack,
    pub(super) dry_end: Pack,
    pub(super) memory: Pack,
    /// Displacement, velocity and time at the start of the step, where something remembers.
    pub(super) from: [Pack; 3],
    /// What the last law that acted says: its part of S.
    pub(super) force: Pack,
    /// And D: mean, end and stiffness.
    pub(super) dry: [Pack; 3],
    /// Force and its slope over the velocity, for a law that is solved with others.
    pub(super) tangent: [Pack; 2],
    /// As in the march of one set.
    pub(super) gain: Pack,
    pub(super) before: [Pack; 4],
}

impl JointLanes {
    /// Takes the motion to where S takes it.
    #[inline(always)]
    pub(super) fn give_way<S: Simd>(&mut self, simd: S, smooth: Wide<S>) {
        let [give, give_velocity] = &self.compliance;
        let [displacement, velocity] = &self.without;
        let taken = Wide::of(simd, give) * smooth;
        self.displacement = (Wide::of(simd, displacement) - taken).pack();
        let taken = Wide::of(simd, give_velocity) * smooth;
        self.velocity = (Wide::of(simd, velocity) - taken).pack();
    }

    /// Begins a step from the end of the one before, S from where the last five lead.
    #[inline(always)]
    pub(super) fn begin<S: Simd>(&mut self, simd: S, free_velocity: Pack, time_s: Pack) {
        self.time_s = time_s;
        self.free_velocity = free_velocity;
        self.start_velocity = self.end_velocity;
        let now = Wide::of(simd, &self.smooth);
        let [s1, s2, s3, s4] = &self.before;
        let (s1, s2) = (Wide::of(simd, s1), Wide::of(simd, s2));
        let (s3, s4) = (Wide::of(simd, s3), Wide::of(simd, s4));
        let (five, ten) = (Wide::splat(simd, 5.0), Wide::splat(simd, 10.0));
        self.smooth = (five * (now - s3) - ten * (s1 - s2) + s4).pack();
        self.before = [now.pack(), s1.pack(), s2.pack(), s3.pack()];
    }
}
