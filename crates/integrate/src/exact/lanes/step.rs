//! One step of eight sets.

use pulp::Simd;

use super::Pack;
use super::block::Block;
use super::row::{Row, State};

/// What a step starts from.
pub(super) struct Step<'a, R> {
    /// The state, in whose place that after the step is put, and room.
    pub(super) states: [&'a mut State<R>; 2],
    /// Forces at its start, which are used up, and at its end.
    pub(super) before: &'a mut R,
    pub(super) after: &'a [Pack],
    /// Displacements and velocities of the bases at its end.
    pub(super) base: [&'a [Pack]; 2],
    /// Steps from the first sample to its end.
    pub(super) steps: usize,
}

/// The joints of a block, whose forces a step solves for.
pub(super) trait Joints<R> {
    /// Takes the step.
    fn step<S: Simd>(&self, simd: S, block: &mut Block<'_>, step: Step<'_, R>);
}

/// The joints that a block has, of any number and between any nodes.
pub(super) struct AnyJoints;

impl<R: Row> Joints<R> for AnyJoints {
    #[inline(always)]
    fn step<S: Simd>(&self, simd: S, block: &mut Block<'_>, step: Step<'_, R>) {
        let [state, next] = step.states;
        block.spread_smooth(simd, step.before);
        let forces = [step.before.packs(), step.after];
        block.kernel.step(simd, state, forces, next);
        if !block.joints.is_empty() {
            block.solve(simd, next, step.base, step.steps);
            block.push(simd, step.before, next);
        }
        state.take_over(next);
    }
}
