//! The march of eight sets.

use std::ops::Range;

use pulp::{Simd, WithSimd};

use super::Pack;
use super::drive::Drive;
use super::eight::Eight;
use super::observer::{SHOWN, Watch};
use super::one_joint::PortRows;
use super::row::{Row, State};
use super::seen::Seen;
use super::step::{AnyJoints, Joints, Step};
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
        let mut at = At::new(&lanes, &zero);
        let mut drive = Drive::new(&lanes, &zero);
        let mut seen = Seen::new(&lanes, &zero, observer);
        for first in (0..lanes.sample_count).step_by(SHOWN) {
            let samples = first..lanes.sample_count.min(first + SHOWN);
            drive.load(simd, &lanes, samples.clone());
            // A loop for each: what solves for more forces would take the state out of the registers.
            let along = (&drive, &mut at, &mut seen);
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

/// Where eight sets are, with room for the next state and for what drives a step between two samples.
struct At<R> {
    state: State<R>,
    next: State<R>,
    before: R,
    after: R,
    base: [Vec<Pack>; 2],
}

impl<R: Row> At<R> {
    fn new(lanes: &Eight<'_>, zero: &R) -> At<R> {
        let bases = vec![Pack::ZERO; lanes.sets[0].excitation.base_count];
        let state = lanes.start(zero);
        At {
            next: state.clone(),
            state,
            before: zero.clone(),
            after: zero.clone(),
            base: [bases.clone(), bases],
        }
    }
}

/// Through samples where nothing but the linear part is.
#[inline(always)]
fn propagate<S: Simd, R: Row>(
    simd: S,
    lanes: &mut Eight<'_>,
    (drive, at, seen): (&Drive<R>, &mut At<R>, &mut Seen<R>),
    samples: Range<usize>,
) {
    let (mut state, mut next) = (at.state.lend(), at.next.lend());
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
    (at.state, at.next) = (state, next);
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
    (drive, at, seen): (&Drive<R>, &mut At<R>, &mut Seen<R>),
    samples: Range<usize>,
) {
    let substeps = lanes.sets[0].excitation.substeps.max(1);
    let share = 1.0 / substeps as f64;
    let (mut state, mut next) = (at.state.lend(), at.next.lend());
    let (mut before, mut after) = (at.before.lend(), at.after.lend());
    let [x, v] = &mut at.base;
    for (k, sample) in samples.enumerate() {
        let [from, to] = drive.forces(k);
        let bases = [drive.base(k), drive.base(k + 1)];
        for sub in 0..if sample == 0 { 0 } else { substeps } {
            let (start, end) = (sub as f64 * share, (sub + 1) as f64 * share);
            let steps = (sample - 1) * substeps + sub + 1;
            between(simd, [from, to], start, before.packs_mut());
            let (mut after_step, mut base) = (to, bases[1]);
            if substeps > 1 {
                between(simd, [from, to], end, after.packs_mut());
                between(simd, bases.map(|[x, _]| x), end, x);
                between(simd, bases.map(|[_, v]| v), end, v);
                (after_step, base) = (after.packs(), [&x[..], &v[..]]);
            }
            let step = Step {
                states: [&mut state, &mut next],
                before: &mut before,
                after: after_step,
                base,
                steps,
            };
            joints.step(simd, &mut lanes.block, step);
        }
        seen.take(k, &state);
        seen.take_forces(simd, k, &lanes.block);
    }
    (at.state, at.next) = (state, next);
    (at.before, at.after) = (before, after);
}
