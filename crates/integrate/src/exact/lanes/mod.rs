//! Several parameter sets of one structure, marched in lock step.
//!
//! A fit simulates one record again and again with other values of the same effects. Each such
//! simulation is a chain of operations that wait for each other; eight of them side by side keep
//! the processor busy, in the lanes of its vector registers. Every number of `super::march`
//! becomes a [`Pack`] of eight, one for each set, and every branch a choice lane by lane.
//!
//! The operations of a lane and their order are those of the march of one set, and none is fused:
//! a set's result is the same to the last bit in a batch, whatever its neighbours, and alone,
//! whatever instructions the processor has.

mod acceleration;
mod batch;
mod block;
mod compact;
mod drive;
mod eight;
mod joint;
mod kernel;
mod law;
mod march;
mod members;
mod observer;
mod one_joint;
mod row;
mod secant;
mod seen;
mod set;
mod settle;
mod solve;
mod source;
mod step;
mod together;
mod trial;
mod wide;

pub use super::role::Role;
pub use batch::Batch;
pub use joint::{JointLanes, LaneLaw};
pub use law::{PackLaw, gather, together};
pub use observer::{LaneObserver, LaneSamples};
pub use set::LaneSet;

/// Sets in a pack: one register of AVX-512, two of AVX2.
pub const LANES: usize = 8;

/// One number for each of eight sets.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(align(64))]
pub struct Pack(pub [f64; LANES]);

impl Pack {
    /// Zero in every lane.
    pub const ZERO: Pack = Pack([0.0; LANES]);

    /// The values of a function of the lane.
    #[inline(always)]
    pub fn of(value: impl FnMut(usize) -> f64) -> Pack {
        Pack(std::array::from_fn(value))
    }
}

/// Which lanes are meant: all bits, or none.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(align(64))]
pub struct Mask(pub(super) [u64; LANES]);

impl Mask {
    pub(super) const ALL: Mask = Mask([u64::MAX; LANES]);
    pub(super) const NONE: Mask = Mask([0; LANES]);

    #[inline(always)]
    pub(super) fn any(&self) -> bool {
        self.0.iter().fold(0, |any, lane| any | lane) != 0
    }

    #[inline(always)]
    pub(super) fn all(&self) -> bool {
        self.0.iter().fold(u64::MAX, |all, lane| all & lane) == u64::MAX
    }
}
