//! The march of eight sets.

use std::ops::Range;

use pulp::{Simd, WithSimd};

use super::Pack;
use super::block::Block;
use super::drive::Drive;
use super::eight::Eight;
use super::observer::{SHOWN, Watch};
use super::one_joint::PortRows;
use super::row::{Row, State};
use super::seen::Seen;
use super::wide::Wide;

/// The march of a block in the best instructions there are; a closure would not be inlined into
/// them. The row is one of zeros.
pub(super) struct March<'a, 'b, R>(
    pub(super) Eight<'b>,
    pub(super) R,
    pub(super) &'a mut dyn Watch,
);

impl<R: Row> WithSimd for March<'_, '_, R> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let March(mut lanes, zero, observer) = self;
        let rows = PortRows::new(&lanes.block, &zero);
        let is_linear = lanes.block.joints.is_empty() && lanes.sets[0].excitation.substeps <= 1;
        let mut state = lanes.start(&zero);
        let mut drive = Drive::new(&lanes, &zero);
        let mut seen = Seen::new(&lanes, &zero, observer);
        for first in (0..lanes.sample_count).step_by(SHOWN) {
            let samples = first..lanes.sample_count.min(first + SHOWN);
            drive.load(simd, &lanes, samples.clone());
            // A loop for each: what solves for more forces would take the state out of the registers.
            let along = (&drive, &mut state, &mut seen);
            if is_linear {
                propagate(simd, &mut lanes, along, samples.clone());
            } else if let Some(rows) = &rows {
                advance(simd, rows, &mut lanes, along, samples.clone());
            } else {
                advance(simd, &AnyJoints, &mut lanes, along, samples.clone());
            }
            seen.complete(simd, &lanes, &drive, samples.clone());
            seen.show(&lanes, &drive, samples, observer);
        }
    }
}

/// Through samples where nothing but the linear part is.
#[inline(always)]
fn propagate<S: Simd, R: Row>(
    simd: S,
    lanes: &mut Eight<'_>,
    (drive, at, seen): (&Drive<R>, &mut State<R>, &mut Seen<R>),
    samples: Range<usize>,
) {
    let mut state = at.clone();
    let mut next = at.clone();
    let mut begun = 0;
    if samples.start == 0 {
        seen.take(0, &state);
        begun = 1;
    }
    for k in begun..samples.len() {
        let forces = drive.forces(k);
        lanes.block.kernel.step(simd, &state, forces, &mut next);
        state.take_over(&mut next);
        seen.take(k, &state);
    }
    *at = state;
}

/// Joints that a step solves for.
trait Joints<R> {
    /// [`Block::step`].
    fn step<S: Simd>(
        &self,
        simd: S,
        block: &mut Block<'_>,
        states_and_forces: ([&mut State<R>; 2], [&mut R; 2]),
        base_and_steps: ([&[Pack]; 2], usize),
    );
}

/// Those that a block has.
struct AnyJoints;

impl<R: Row> Joints<R> for AnyJoints {
    #[inline(always)]
    fn step<S: Simd>(
        &self,
        simd: S,
        block: &mut Block<'_>,
        (states, forces): ([&mut State<R>; 2], [&mut R; 2]),
        (base, steps): ([&[Pack]; 2], usize),
    ) {
        block.step(simd, states, forces, base, steps);
    }
}

impl<R: Row> Joints<R> for PortRows<R> {
    #[inline(always)]
    fn step<S: Simd>(
        &self,
        simd: S,
        block: &mut Block<'_>,
        (states, forces): ([&mut State<R>; 2], [&mut R; 2]),
        base_and_steps: ([&[Pack]; 2], usize),
    ) {
        block.step_of_one(simd, self, states, forces, base_and_steps);
    }
}

/// `from + share (to − from)`, to the last bit what is at an end.
#[inline(always)]
fn between<S: Simd>(simd: S, [from, to]: [&[Pack]; 2], share: f64, out: &mut [Pack]) {
    for ((out, a), b) in out.iter_mut().zip(from).zip(to) {
        *out = if share == 1.0 {
            *b
        } else if share == 0.0 {
            *a
        } else {
            let (a, b) = (Wide::of(simd, a), Wide::of(simd, b));
            (a + Wide::splat(simd, share) * (b - a)).pack()
        };
    }
}

/// Through samples, in the steps of the excitation.
#[inline(always)]
fn advance<S: Simd, R: Row>(
    simd: S,
    joints: &impl Joints<R>,
    lanes: &mut Eight<'_>,
    (drive, at, seen): (&Drive<R>, &mut State<R>, &mut Seen<R>),
    samples: Range<usize>,
) {
    let substeps = lanes.sets[0].excitation.substeps.max(1);
    let share = 1.0 / substeps as f64;
    let mut state = at.clone();
    let mut next = at.clone();
    let [mut before, mut after] = [drive.zero.clone(), drive.zero.clone()];
    let [x, v] = drive.base(0);
    let (mut x, mut v) = (x.to_vec(), v.to_vec());
    for (k, sample) in samples.enumerate() {
        let forces = drive.forces(k);
        for sub in 0..if sample == 0 { 0 } else { substeps } {
            let (start, end) = (sub as f64 * share, (sub + 1) as f64 * share);
            let steps = (sample - 1) * substeps + sub + 1;
            between(simd, forces, start, before.packs_mut());
            between(simd, forces, end, after.packs_mut());
            let [from, to] = [drive.base(k), drive.base(k + 1)];
            between(simd, [from[0], to[0]], end, &mut x);
            between(simd, [from[1], to[1]], end, &mut v);
            let states = [&mut state, &mut next];
            let forces = [&mut before, &mut after];
            let base: [&[Pack]; 2] = [&x, &v];
            joints.step(simd, &mut lanes.block, (states, forces), (base, steps));
        }
        seen.take(k, &state);
        seen.take_forces(simd, k, &lanes.block);
    }
    *at = state;
}
