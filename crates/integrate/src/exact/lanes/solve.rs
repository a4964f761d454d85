//! What one law of eight sets says within a step: of equations (3) and (4) of [`crate::exact::march`].
//!
//! Laws, and [`DryStep`], which is that of the march of one set, are asked lane by lane, in loops that
//! write down what they say and do nothing else: such loops become vector instructions. All other
//! arithmetic is [`Wide`].

use pulp::Simd;

use super::joint::JointLanes;
use super::wide::Wide;
use super::{LANES, Pack};
use crate::exact::dry::{DryStep, Level};
use crate::exact::law::{Followed, MemberMotion, Tangent};
use crate::exact::plant::AT_REST;
use crate::exact::role::Role;

/// What the laws of the eight sets say.
pub(super) trait LawLanes {
    fn force(&self, lane: usize, motion: MemberMotion) -> f64;

    /// The forces of all lanes at displacements, velocities and times.
    #[inline(always)]
    fn forces(&self, at: &[Pack; 3], step_s: &Pack) -> Pack {
        let mut force = Pack::ZERO;
        for l in 0..LANES {
            force.0[l] = self.force(l, motion_at(at, step_s, l));
        }
        force
    }

    fn tangent(&self, lane: usize, motion: MemberMotion) -> Tangent;

    /// One step along a move.
    fn follow(
        &self,
        lane: usize,
        memory: f64,
        left: f64,
        from: MemberMotion,
        to: MemberMotion,
    ) -> Followed;

    fn dry_level(&self, lane: usize, speed: f64) -> f64;
}

/// The friction of one of eight laws.
struct LevelOf<'a, L> {
    laws: &'a L,
    lane: usize,
}

impl<L> Clone for LevelOf<'_, L> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<L> Copy for LevelOf<'_, L> {}

impl<L: LawLanes> Level for LevelOf<'_, L> {
    #[inline(always)]
    fn at(self, speed: f64) -> f64 {
        self.laws.dry_level(self.lane, speed)
    }
}

/// What the laws say at a trial of S of their joint: D of the one that rubs, which moves the joint, then its part of S.
#[inline(always)]
pub(super) fn act<S: Simd>(simd: S, laws: &impl LawLanes, role: Role, joint: &mut JointLanes) {
    if role.dry {
        let velocity = Wide::of(simd, &joint.velocity);
        let [mean, end, stiffness] = dry_forces(simd, laws, joint, velocity);
        let [give, give_velocity] = joint.dry_compliance.each_ref();
        let mean = Wide::of(simd, &mean);
        let displacement = Wide::of(simd, &joint.displacement) - Wide::of(simd, give) * mean;
        joint.displacement = displacement.pack();
        joint.velocity = (velocity - Wide::of(simd, give_velocity) * mean).pack();
        joint.dry = [mean.pack(), end, stiffness];
    }
    let at = [joint.displacement, joint.velocity, joint.time_s];
    joint.force = if role.remembering {
        let (memory, from) = (joint.memory, joint.from);
        let [force, _] = follow(laws, &memory, [&from, &at], &joint.step_s);
        force
    } else {
        laws.forces(&at, &joint.step_s)
    };
}

/// The parts of [`Dry`] of each lane, where the velocity would end at `free` without it.
#[inline(always)]
fn dry_forces<S: Simd>(
    simd: S,
    laws: &impl LawLanes,
    joint: &JointLanes,
    free: Wide<S>,
) -> [Pack; 3] {
    let start = Wide::of(simd, &joint.start_velocity);
    let without = Wide::of(simd, &joint.free_velocity);
    // What sticks ends a step at rest but for rounding.
    let rests = start
        .abs()
        .is_at_most(Wide::splat(simd, AT_REST) * without.abs());
    let start = rests.choose(Wide::zero(simd), start).pack();
    let (free, compliance) = (free.pack(), joint.dry_compliance[1]);
    let [mut mean, mut end, mut stiffness] = [Pack::ZERO; 3];
    let step = |l: usize| DryStep {
        before: joint.dry_end.0[l],
        start: start.0[l],
        free: free.0[l],
        compliance: compliance.0[l],
    };
    // Where all slide, no other case is computed.
    let mut is_done = !rests.any();
    if is_done {
        for l in 0..LANES {
            let slid = step(l).slid(LevelOf { laws, lane: l });
            (mean.0[l], end.0[l]) = (slid.dry.mean, slid.dry.end);
            is_done &= slid.is_all_the_way;
        }
    }
    if !is_done {
        for l in 0..LANES {
            let now = step(l).force_of_any(LevelOf { laws, lane: l });
            (mean.0[l], end.0[l], stiffness.0[l]) = (now.mean, now.end, now.stiffness);
        }
    }
    [mean, end, stiffness]
}

#[inline(always)]
fn motion_at(from: &[Pack; 3], step_s: &Pack, lane: usize) -> MemberMotion {
    MemberMotion {
        displacement: from[0].0[lane],
        velocity: from[1].0[lane],
        time_s: from[2].0[lane],
        step_s: step_s.0[lane],
    }
}

/// Force and memory of eight laws at the end of a move, step by step until the last is there.
#[inline(always)]
fn follow(
    laws: &impl LawLanes,
    memory: &Pack,
    [from, to]: [&[Pack; 3]; 2],
    step_s: &Pack,
) -> [Pack; 2] {
    let (mut force, mut memory, mut left) = (Pack::ZERO, *memory, Pack([1.0; LANES]));
    loop {
        let mut is_ahead = false;
        for l in 0..LANES {
            let (from, to) = (motion_at(from, step_s, l), motion_at(to, step_s, l));
            let now = laws.follow(l, memory.0[l], left.0[l], from, to);
            (force.0[l], memory.0[l], left.0[l]) = (now.force, now.memory, now.left);
            is_ahead |= now.left > 0.0;
        }
        if !is_ahead {
            return [force, memory];
        }
    }
}

/// Force and slope of eight laws.
#[inline(always)]
pub(super) fn tangent(laws: &impl LawLanes, joint: &mut JointLanes) {
    let at = [joint.displacement, joint.velocity, joint.time_s];
    let [mut force, mut damping] = [Pack::ZERO; 2];
    for l in 0..LANES {
        let tangent = laws.tangent(l, motion_at(&at, &joint.step_s, l));
        (force.0[l], damping.0[l]) = (tangent.force, tangent.damping);
    }
    joint.tangent = [force, damping];
}

/// Commits the memory; the displacement is the one that the forces of all joints leave.
#[inline(always)]
pub(super) fn remember(laws: &impl LawLanes, joint: &mut JointLanes) {
    let to = [joint.displacement, joint.end_velocity, joint.time_s];
    let (memory, from) = (joint.memory, joint.from);
    [_, joint.memory] = follow(laws, &memory, [&from, &to], &joint.step_s);
    joint.from = to;
}
