//! One joint of the plant in eight lanes, and what its laws do with it.

use pulp::{Arch, Simd};

use super::Pack;
use super::wide::Wide;

/// One law with the parameters of eight sets. Made by [`gather`](super::gather), or lane by lane for laws that
/// do not offer [`ForceLaw::lanes`](crate::exact::ForceLaw::lanes).
pub trait LaneLaw: Send + Sync {
    /// The forces where a joint would be without its dry force: the dry one, which moves it, then the single-valued part.
    fn act(&self, arch: Arch, is: Acting, joint: &mut JointLanes);

    /// Force and slope at the motion of the joint, for laws that are solved together.
    fn tangent(&self, arch: Arch, joint: &mut JointLanes);

    /// Commits the memory at the end of a step.
    fn remember(&self, arch: Arch, joint: &mut JointLanes);
}

/// What a law is at its joint.
#[derive(Debug, Clone, Copy, Default)]
pub struct Acting {
    /// The one that rubs.
    pub(super) dry: bool,
    /// The one that remembers.
    pub(super) remembering: bool,
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
    /// Takes S to where the last five steps lead.
    #[inline(always)]
    pub(super) fn extrapolate<S: Simd>(&mut self, simd: S) {
        let now = Wide::of(simd, &self.smooth);
        let [s1, s2, s3, s4] = self.before.each_ref().map(|pack| Wide::of(simd, pack));
        let (five, ten) = (Wide::splat(simd, 5.0), Wide::splat(simd, 10.0));
        self.smooth = (five * (now - s3) - ten * (s1 - s2) + s4).pack();
        self.before = [now.pack(), s1.pack(), s2.pack(), s3.pack()];
    }
}
