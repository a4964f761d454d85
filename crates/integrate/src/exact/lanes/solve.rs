//! Equations (3) and (4) of [`crate::exact::march`] for one element of eight sets.
//!
//! Laws, and [`DryStep`], which is that of the march of one set, are asked lane by lane, in loops that
//! write down what they say and do nothing else: such loops become vector instructions. All other
//! arithmetic is [`Wide`].

use pulp::Simd;

use super::element::ElementLanes;
use super::wide::{Which, Wide};
use super::{LANES, Pack};
use crate::exact::dry::DryStep;
use crate::exact::law::{Followed, MemberMotion, Tangent};
use crate::exact::plant::{AT_REST, FORCE_TOLERANCE, SECANT_STEPS};

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

/// Updates S and D of the open sets; those that stayed where they were are closed.
#[inline(always)]
pub(super) fn solve<S: Simd>(simd: S, laws: &impl LawLanes, element: &mut ElementLanes) {
    let (mut displacement, mut velocity) = (
        Wide::of(simd, &element.displacement),
        Wide::of(simd, &element.velocity),
    );
    let [give, give_velocity] = [0, 1].map(|i| Wide::of(simd, &element.compliance[i]));
    let open = Which::of(simd, &element.open);
    let (old_smooth, old_dry) = (
        Wide::of(simd, &element.smooth),
        Wide::of(simd, &element.dry_force),
    );
    let mut dry = old_dry;
    if element.dry {
        let free = velocity - give_velocity * old_smooth;
        let [mean, end] = dry_forces(simd, laws, element, free);
        let [dry_give, dry_give_velocity] = &element.dry_compliance;
        dry = mean;
        displacement -= Wide::of(simd, dry_give) * mean;
        velocity -= Wide::of(simd, dry_give_velocity) * mean;
        open.put(end, &mut element.dry_end);
    }
    let own = OwnForce {
        simd,
        laws,
        remembers: element.remembers,
        without: [displacement, velocity],
        compliance: [give, give_velocity],
        time_s: element.time_s,
        step_s: element.step_s,
        memory: element.memory,
        from: element.from,
    };
    let smooth = smooth_force(old_smooth, open, &own);
    let mut change = (smooth - old_smooth).abs();
    // As in the march of one set, D alone follows from S.
    if !element.alone {
        change += (dry - old_dry).abs();
    }
    let tolerance = Wide::splat(simd, FORCE_TOLERANCE);
    let settled = change.is_at_most(tolerance * (smooth.abs() + dry.abs()));
    let end_velocity = velocity - give_velocity * smooth;
    open.put(end_velocity, &mut element.end_velocity);
    open.put(smooth, &mut element.smooth);
    open.put(dry, &mut element.dry_force);
    element.open = (open & !settled).mask();
}

/// The mean over the step and the end of the dry force, where the velocity would end at `free`
/// without it.
#[inline(always)]
fn dry_forces<S: Simd>(
    simd: S,
    laws: &impl LawLanes,
    element: &ElementLanes,
    free: Wide<S>,
) -> [Wide<S>; 2] {
    let start = Wide::of(simd, &element.start_velocity);
    let without = Wide::of(simd, &element.free_velocity);
    // What sticks ends a step at rest but for rounding.
    let rests = start
        .abs()
        .is_at_most(Wide::splat(simd, AT_REST) * without.abs());
    let start = rests.choose(Wide::zero(simd), start).pack();
    let (free, compliance) = (free.pack(), element.dry_compliance[1]);
    let (mut mean, mut end) = (Pack::ZERO, Pack::ZERO);
    let step = |l: usize| DryStep {
        before: element.dry_end.0[l],
        start: start.0[l],
        free: free.0[l],
        compliance: compliance.0[l],
    };
    // Where all slide, no other case is computed.
    let mut is_done = !rests.any();
    if is_done {
        for l in 0..LANES {
            let slid = step(l).slid(|speed| laws.dry_level(l, speed));
            (mean.0[l], end.0[l]) = (slid.dry.mean, slid.dry.end);
            is_done &= slid.is_all_the_way;
        }
    }
    if !is_done {
        for l in 0..LANES {
            let now = step(l).force_of_any(|speed| laws.dry_level(l, speed));
            (mean.0[l], end.0[l]) = (now.mean, now.end);
        }
    }
    [Wide::of(simd, &mean), Wide::of(simd, &end)]
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

/// What an element's own smooth force does to its motion, and the laws make of that.
struct OwnForce<'a, S: Simd, L> {
    simd: S,
    laws: &'a L,
    remembers: bool,
    /// Displacement and velocity without the force.
    without: [Wide<S>; 2],
    compliance: [Wide<S>; 2],
    time_s: Pack,
    step_s: Pack,
    memory: Pack,
    from: [Pack; 3],
}

impl<S: Simd, L: LawLanes> OwnForce<'_, S, L> {
    /// The force that follows from the force. A closure would not be inlined into vector instructions.
    #[inline(always)]
    fn of(&self, s: Wide<S>) -> Wide<S> {
        let [displacement, velocity] = self.without;
        let [give, give_velocity] = self.compliance;
        let to = [
            (displacement - give * s).pack(),
            (velocity - give_velocity * s).pack(),
            self.time_s,
        ];
        if self.remembers {
            let [force, _] = follow(self.laws, &self.memory, [&self.from, &to], &self.step_s);
            return Wide::of(self.simd, &force);
        }
        Wide::of(self.simd, &self.laws.forces(&to, &self.step_s))
    }
}

/// The secant method of the march of one set; a lane that is done keeps its answer.
#[inline(always)]
fn smooth_force<S: Simd>(
    guess: Wide<S>,
    wanted: Which<S>,
    law: &OwnForce<'_, S, impl LawLanes>,
) -> Wide<S> {
    let tolerance = Wide::splat(law.simd, FORCE_TOLERANCE);
    let (zero, most) = (Wide::zero(law.simd), Wide::splat(law.simd, f64::MAX));
    let mut s0 = guess;
    let mut s1 = law.of(s0);
    let mut residual0 = s1 - s0;
    let mut open = wanted & !residual0.abs().is_at_most(tolerance * s1.abs());
    for _ in 0..SECANT_STEPS {
        if !open.any() {
            break;
        }
        let residual1 = law.of(s1) - s1;
        let slope = residual1 - residual0;
        let flat = slope.equals(zero) | !slope.abs().is_at_most(most);
        let secant = s1 - residual1 * (s1 - s0) / slope;
        let next = flat.choose(s1 + residual1, secant);
        let near = (residual1 * residual1).is_at_most(tolerance * (secant * residual0).abs());
        let close = residual1.abs().is_at_most(tolerance * next.abs());
        (s0, residual0, s1) = (s1, residual1, open.choose(next, s1));
        open = open & !(flat | near | close);
    }
    s1
}

/// Force and slope of eight laws.
#[inline(always)]
pub(super) fn tangent(laws: &impl LawLanes, element: &mut ElementLanes) {
    let at = [element.displacement, element.velocity, element.time_s];
    let [mut force, mut damping] = [Pack::ZERO; 2];
    for l in 0..LANES {
        let tangent = laws.tangent(l, motion_at(&at, &element.step_s, l));
        (force.0[l], damping.0[l]) = (tangent.force, tangent.damping);
    }
    element.tangent = [force, damping];
}

/// Commits the memory; the displacement is the one that the forces of all elements leave.
#[inline(always)]
pub(super) fn remember(laws: &impl LawLanes, element: &mut ElementLanes) {
    let to = [element.displacement, element.end_velocity, element.time_s];
    let (memory, from) = (element.memory, element.from);
    [_, element.memory] = follow(laws, &memory, [&from, &to], &element.step_s);
    element.from = to;
}
