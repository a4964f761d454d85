//! Eight sets with what drives them.

use pulp::{Arch, Simd};

use super::block::{Block, motion_across};
use super::row::{Row, State};
use super::set::LaneSet;
use super::source::{Source, sources};
use super::{LANES, Pack};
use crate::exact::law::MemberMotion;

/// A block with its excitations.
pub(super) struct Eight<'a> {
    pub(super) block: Block<'a>,
    pub(super) first_set: usize,
    pub(super) set_count: usize,
    pub(super) sample_count: usize,
    pub(super) sets: [LaneSet<'a>; LANES],
    pub(super) sources: Vec<Source<'a>>,
}

impl<'a> Eight<'a> {
    pub(super) fn new(
        arch: Arch,
        sets: &[LaneSet<'a>],
        [first_set, sample_count]: [usize; 2],
        is_read: &dyn Fn(usize) -> bool,
    ) -> Eight<'a> {
        let lanes: [&LaneSet<'a>; LANES] = std::array::from_fn(|l| sets.get(l).unwrap_or(&sets[0]));
        Eight {
            block: Block::new(arch, &lanes, is_read),
            first_set,
            set_count: sets.len(),
            sample_count,
            sources: sources(&lanes),
            sets: lanes.map(|set| *set),
        }
    }

    /// The state at the first sample.
    pub(super) fn start<R: Row>(&self, zero: &R) -> State<R> {
        let put = |row: &mut R, values: &dyn Fn(usize) -> &'a [f64]| {
            for (i, pack) in row.packs_mut().iter_mut().enumerate() {
                *pack = Pack::of(|l| values(l).get(i).copied().unwrap_or(0.0));
            }
        };
        let mut state = State {
            displacement: zero.clone(),
            velocity: zero.clone(),
        };
        put(&mut state.displacement, &|l| self.sets[l].displacement);
        put(&mut state.velocity, &|l| self.sets[l].velocity);
        state
    }

    /// Adds to what elements whose force is spread over steps carry what that is at a point beyond it.
    pub(super) fn add_beyond_step<S: Simd>(
        &self,
        simd: S,
        sample: usize,
        (state, base): ([&[Pack]; 2], [&[Pack]; 2]),
        carried: &mut [Pack],
    ) {
        for (i, carried) in carried.iter_mut().enumerate() {
            if !self.block.spread[i] {
                continue;
            }
            let [displacement, velocity] = motion_across(simd, self.block.ports[i], state, base);
            let spread = self.sets.iter().enumerate();
            for (l, set) in spread.filter(|(_, set)| set.elements[i].law.is_spread_over_steps()) {
                let step_s = set.propagator.time_step_s;
                let steps = sample * set.excitation.substeps.max(1);
                carried.0[l] += set.elements[i].law.beyond_step(MemberMotion {
                    displacement: displacement.0[l],
                    velocity: velocity.0[l],
                    time_s: set.excitation.time_s(steps, step_s),
                    step_s,
                });
            }
        }
    }
}
