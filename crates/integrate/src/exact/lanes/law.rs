//! A force law in eight lanes.

use std::any::Any;

use pulp::{Arch, Simd, WithSimd};

use super::joint::{JointLanes, LaneLaw};
use super::settle::{Acting, settle};
use super::solve::{self, LawLanes};
use super::wide::Wide;
use super::{LANES, Mask, Pack};
use crate::exact::law::{Followed, ForceLaw, MemberMotion, Tangent};
use crate::exact::role::Role;

/// The parameters of eight laws of one type, and how they become a law again.
struct Gathered<F, const K: usize> {
    columns: [Pack; K],
    join: F,
}

/// Puts the laws of eight sets side by side, if all are of the type of the first: `split` takes a law into its numbers and
/// `join` makes a law of them, the same or one of the same values. A law calls it through [`crate::lanes!`].
pub fn gather<L: ForceLaw, J: ForceLaw, const K: usize>(
    peers: &[&dyn ForceLaw],
    split: impl Fn(&L) -> [f64; K],
    join: impl Fn([f64; K]) -> J + Send + Sync + 'static,
) -> Option<Box<dyn LaneLaw>> {
    let mut columns = [Pack::ZERO; K];
    for lane in 0..LANES {
        let law: &dyn Any = *peers.get(lane)?;
        for (column, value) in columns.iter_mut().zip(split(law.downcast_ref::<L>()?)) {
            column.0[lane] = value;
        }
    }
    Some(Box::new(Gathered { columns, join }))
}

impl<L: ForceLaw, F: Fn([f64; K]) -> L, const K: usize> Gathered<F, K> {
    #[inline(always)]
    fn law(&self, lane: usize) -> L {
        (self.join)(std::array::from_fn(|k| self.columns[k].0[lane]))
    }
}

impl<L: ForceLaw, F: Fn([f64; K]) -> L, const K: usize> LawLanes for Gathered<F, K> {
    #[inline(always)]
    fn force(&self, lane: usize, motion: MemberMotion) -> f64 {
        self.law(lane).force(motion)
    }

    #[inline(always)]
    fn tangent(&self, lane: usize, motion: MemberMotion) -> Tangent {
        self.law(lane).tangent(motion)
    }

    #[inline(always)]
    fn follow(
        &self,
        lane: usize,
        memory: f64,
        left: f64,
        from: MemberMotion,
        to: MemberMotion,
    ) -> Followed {
        self.law(lane).follow_step(memory, left, from, to)
    }

    #[inline(always)]
    fn dry_level(&self, lane: usize, speed: f64) -> f64 {
        self.law(lane).dry_level(speed).unwrap_or(0.0)
    }
}

impl<L: LawLanes + Send + Sync> LaneLaw for L {
    fn act(&self, arch: Arch, role: Role, joint: &mut JointLanes) {
        arch.dispatch(Act(self, role, joint));
    }

    fn settle(&self, arch: Arch, role: Role, joint: &mut JointLanes, open: &Mask) -> Mask {
        arch.dispatch(Settle(self, role, joint, open))
    }

    fn tangent(&self, arch: Arch, joint: &mut JointLanes) {
        arch.dispatch(Tangents(self, joint));
    }

    fn remember(&self, arch: Arch, joint: &mut JointLanes) {
        arch.dispatch(Remember(self, joint));
    }
}

/// [`solve::act`] in the best instructions there are; a closure would not be inlined into them.
struct Act<'a, L>(&'a L, Role, &'a mut JointLanes);

impl<L: LawLanes> WithSimd for Act<'_, L> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        solve::act(simd, self.0, self.1, self.2);
    }
}

/// [`settle`] likewise.
struct Settle<'a, L>(&'a L, Role, &'a mut JointLanes, &'a Mask);

impl<L: LawLanes> WithSimd for Settle<'_, L> {
    type Output = Mask;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Mask {
        let Settle(laws, role, joint, open) = self;
        let (moved, rest) = settle(simd, joint, open, &mut Alone(laws, role));
        joint.force = (Wide::of(simd, &joint.force) + rest).pack();
        moved
    }
}

/// The only law of a joint.
struct Alone<'a, L>(&'a L, Role);

impl<S: Simd, L: LawLanes> Acting<S> for Alone<'_, L> {
    #[inline(always)]
    fn act(&mut self, simd: S, joint: &mut JointLanes) -> Wide<S> {
        solve::act(simd, self.0, self.1, joint);
        Wide::zero(simd) + Wide::of(simd, &joint.force)
    }
}

/// [`solve::tangent`] likewise.
struct Tangents<'a, L>(&'a L, &'a mut JointLanes);

impl<L: LawLanes> WithSimd for Tangents<'_, L> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        solve::tangent(self.0, self.1);
    }
}

/// [`solve::remember`] likewise.
struct Remember<'a, L>(&'a L, &'a mut JointLanes);

impl<L: LawLanes> WithSimd for Remember<'_, L> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        solve::remember(self.0, self.1);
    }
}

/// Laws of eight sets without a dry part and without memory that compute their forces together, operation by operation: for
/// laws that are not one compiled function, and so do not become vector instructions lane by lane.
pub trait PackLaw: Send + Sync + 'static {
    /// The single-valued part, N, at displacements (m), velocities (m/s) and times (s). To the last bit it is what
    /// [`ForceLaw::force`] of each set is, in every lane. Mark it `#[inline(always)]` to have it in vector instructions.
    fn forces(&self, displacement: &Pack, velocity: &Pack, time_s: &Pack) -> Pack;
}

/// Laws that compute their forces together, as [`ForceLaw::lanes`] hands them over.
#[must_use]
pub fn together(law: impl PackLaw) -> Box<dyn LaneLaw> {
    Box::new(Packed(law))
}

struct Packed<L>(L);

impl<L: PackLaw> LawLanes for Packed<L> {
    #[inline(always)]
    fn forces(&self, [displacement, velocity, time_s]: &[Pack; 3], _: &Pack) -> Pack {
        self.0.forces(displacement, velocity, time_s)
    }

    fn force(&self, lane: usize, motion: MemberMotion) -> f64 {
        let [displacement, velocity, time_s] =
            [motion.displacement, motion.velocity, motion.time_s].map(|x| Pack::of(|_| x));
        self.0.forces(&displacement, &velocity, &time_s).0[lane]
    }

    fn tangent(&self, lane: usize, motion: MemberMotion) -> Tangent {
        Tangent {
            force: self.force(lane, motion),
            damping: 0.0,
        }
    }

    fn follow(
        &self,
        lane: usize,
        memory: f64,
        _: f64,
        _: MemberMotion,
        to: MemberMotion,
    ) -> Followed {
        Followed::arrived(self.force(lane, to), memory)
    }

    fn dry_level(&self, _: usize, _: f64) -> f64 {
        0.0
    }
}

/// Laws that are asked one after the other.
pub(super) struct OneByOne<'a>(pub(super) [&'a dyn ForceLaw; LANES]);

impl LawLanes for OneByOne<'_> {
    #[inline(always)]
    fn force(&self, lane: usize, motion: MemberMotion) -> f64 {
        self.0[lane].force(motion)
    }

    #[inline(always)]
    fn tangent(&self, lane: usize, motion: MemberMotion) -> Tangent {
        self.0[lane].tangent(motion)
    }

    #[inline(always)]
    fn follow(
        &self,
        lane: usize,
        memory: f64,
        _: f64,
        from: MemberMotion,
        to: MemberMotion,
    ) -> Followed {
        // Laws of several types: some would not stay where they have arrived.
        self.0[lane].follow(memory, from, to)
    }

    #[inline(always)]
    fn dry_level(&self, lane: usize, speed: f64) -> f64 {
        self.0[lane].dry_level(speed).unwrap_or(0.0)
    }
}

/// Lets a force law run in lanes: inside its `impl ForceLaw`, with the names of all its fields,
/// each an `f64`.
///
/// ```
/// use simgap_integrate::exact::{ForceLaw, MemberMotion};
///
/// struct Cubic {
///     factor: f64,
/// }
///
/// impl ForceLaw for Cubic {
///     simgap_integrate::lanes!(factor);
///
///     fn force(&self, motion: MemberMotion) -> f64 {
///         self.factor * motion.displacement * motion.displacement * motion.displacement
///     }
/// }
///
/// let law = Cubic { factor: 2.0 };
/// let eight: [&dyn ForceLaw; 8] = [&law; 8];
/// assert!(law.lanes(&eight).is_some());
/// ```
#[macro_export]
macro_rules! lanes {
    ($($field:ident),* $(,)?) => {
        fn lanes(
            &self,
            peers: &[&dyn $crate::exact::ForceLaw],
        ) -> Option<Box<dyn $crate::exact::LaneLaw>> {
            $crate::exact::gather(
                peers,
                |law: &Self| [$(law.$field),*],
                |[$($field),*]| Self { $($field),* },
            )
        }
    };
}
