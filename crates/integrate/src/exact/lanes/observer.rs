//! What sees eight sets while they are marched.

use pulp::{Arch, Simd, WithSimd};

use super::Pack;

/// Samples that are marched before the observer is shown them: a call at each would take the states out of the registers.
pub(super) const SHOWN: usize = 32;

/// Rows of packs, one for each sample.
#[derive(Clone, Copy)]
pub(super) struct Rows<'a> {
    values: &'a [Pack],
    width: usize,
}

impl<'a> Rows<'a> {
    #[inline(always)]
    pub(super) fn new(values: &'a [Pack], width: usize) -> Rows<'a> {
        Rows { values, width }
    }

    #[inline(always)]
    pub(super) fn at(&self, k: usize) -> &'a [Pack] {
        &self.values[k * self.width..(k + 1) * self.width]
    }
}

/// Eight sets at some samples in a row; a value in a lane belongs to the set of that lane.
pub struct LaneSamples<'a> {
    /// Place of the set in the first lane among the sets of the batch; the others follow it.
    pub first_set: usize,
    /// Lanes that hold a set; the rest repeat one.
    pub set_count: usize,
    /// Index of the first sample; a set whose excitation is over stays at its last.
    pub first: usize,
    /// Number of samples.
    pub count: usize,
    pub(super) displacement: Rows<'a>,
    pub(super) velocity: Rows<'a>,
    pub(super) acceleration: Rows<'a>,
    pub(super) element_force: Rows<'a>,
    pub(super) base: [Rows<'a>; 2],
}

impl<'a> LaneSamples<'a> {
    /// x at the k-th of the samples, m; length n.
    #[inline(always)]
    #[must_use]
    pub fn displacement(&self, k: usize) -> &'a [Pack] {
        self.displacement.at(k)
    }

    /// ẋ, m/s; length n.
    #[inline(always)]
    #[must_use]
    pub fn velocity(&self, k: usize) -> &'a [Pack] {
        self.velocity.at(k)
    }

    /// ẍ, m/s²; length n, zero where [`LaneObserver::reads_acceleration`] says no; empty where it says so of all.
    #[inline(always)]
    #[must_use]
    pub fn acceleration(&self, k: usize) -> &'a [Pack] {
        self.acceleration.at(k)
    }

    /// Force each element carries, N, where [`LaneObserver::reads_forces`] or an acceleration is read, else empty.
    #[inline(always)]
    #[must_use]
    pub fn element_force(&self, k: usize) -> &'a [Pack] {
        self.element_force.at(k)
    }

    /// Displacement of each base node, m.
    #[inline(always)]
    #[must_use]
    pub fn base_displacement(&self, k: usize) -> &'a [Pack] {
        self.base[0].at(k)
    }

    /// Velocity of each base node, m/s.
    #[inline(always)]
    #[must_use]
    pub fn base_velocity(&self, k: usize) -> &'a [Pack] {
        self.base[1].at(k)
    }
}

/// Sees every sample of a batch.
pub trait LaneObserver {
    /// Whether it looks at the acceleration of a coordinate. Others are not computed.
    fn reads_acceleration(&self, coordinate: usize) -> bool;

    /// Whether it looks at the displacement of a coordinate. The integral of a pressure, which moves nothing, is not computed
    /// where nobody reads it and stays where it was.
    fn reads_displacement(&self, coordinate: usize) -> bool {
        let _ = coordinate;
        true
    }

    /// Whether it looks at what the elements carry. Where nobody does, it is not added up at every sample and is missing.
    fn reads_forces(&self) -> bool {
        true
    }

    /// Eight sets at the next samples. Mark it `#[inline(always)]` to have it in vector instructions.
    fn observe(&mut self, samples: &LaneSamples<'_>);
}

/// An observer of any type: the march is the longest code there is to compile, and is compiled once for all of them.
pub(super) trait Watch: LaneObserver {
    fn watch(&mut self, arch: Arch, samples: &LaneSamples<'_>);
}

impl<O: LaneObserver> Watch for O {
    fn watch(&mut self, arch: Arch, samples: &LaneSamples<'_>) {
        arch.dispatch(Observe(self, samples));
    }
}

/// [`LaneObserver::observe`] in the best instructions there are; a closure would not be inlined into them.
struct Observe<'a, 'b, O>(&'a mut O, &'a LaneSamples<'b>);

impl<O: LaneObserver> WithSimd for Observe<'_, '_, O> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        self.0.observe(self.1);
    }
}
