//! One element of the plant in eight lanes, and what its law does with it.

use pulp::Arch;

use super::{Mask, Pack};

/// One law with the parameters of eight sets. Made by [`gather`](super::gather), or lane by lane for laws that
/// do not offer [`ForceLaw::lanes`](crate::exact::ForceLaw::lanes).
pub trait LaneLaw: Send + Sync {
    /// Solves one element for the end of a step, the others held.
    fn solve(&self, arch: Arch, element: &mut ElementLanes);

    /// Force and slope at the motion of the element, for laws that are solved together.
    fn tangent(&self, arch: Arch, element: &mut ElementLanes);

    /// Commits the memory at the end of a step.
    fn remember(&self, arch: Arch, element: &mut ElementLanes);
}

/// One element of eight sets within one step.
#[derive(Debug, Clone)]
pub struct ElementLanes {
    /// Whether there is no other element.
    pub(super) alone: bool,
    pub(super) dry: bool,
    pub(super) remembers: bool,
    /// Motion at the end of the step without the forces of the element itself.
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
    /// Displacement, velocity and time at the start of the step, for a law that remembers.
    pub(super) from: [Pack; 3],
    /// Force and its slope over the velocity, for a law that is solved with others.
    pub(super) tangent: [Pack; 2],
    /// Sets that still iterate; afterwards those whose forces changed.
    pub(super) open: Mask,
}
