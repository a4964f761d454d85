//! Equations (3) and (4) of [`crate::exact::march`] for one element of eight sets.
//!
//! The loops over the lanes have no exits, so that they become vector instructions. What they read
//! is copied first: the compiler then knows that nothing else changes it.

use super::law::ElementLanes;
use super::{LANES, Mask, Pack, bits};
use crate::exact::law::{Followed, MemberMotion};
use crate::exact::plant::{AT_REST, FORCE_TOLERANCE, SECANT_STEPS, dry_force};

/// What the laws of the eight sets say.
pub(super) trait LawLanes {
    fn force(&self, lane: usize, motion: MemberMotion) -> f64;

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
pub(super) fn solve(laws: &impl LawLanes, element: &mut ElementLanes) {
    let (mut displacement, mut velocity) = (element.displacement, element.velocity);
    let [_, give_velocity] = element.compliance;
    let (open, old_smooth, old_dry) = (element.open, element.smooth, element.dry_force);
    let mut dry = old_dry;
    if element.dry {
        let [dry_give, dry_give_velocity] = element.dry_compliance;
        let (start, without) = (element.start_velocity, element.free_velocity);
        let mut end = element.dry_end;
        for l in 0..LANES {
            let free = velocity.0[l] - give_velocity.0[l] * old_smooth.0[l];
            let level = |speed: f64| laws.dry_level(l, speed);
            // What sticks ends a step at rest but for rounding.
            let rests = bits(start.0[l].abs() <= AT_REST * without.0[l].abs());
            let start = choose(rests, 0.0, start.0[l]);
            let now = dry_force(
                level,
                element.dry_end.0[l],
                start,
                free,
                dry_give_velocity.0[l],
            );
            dry.0[l] = now.mean;
            end.0[l] = choose(open.0[l], now.end, end.0[l]);
            displacement.0[l] -= dry_give.0[l] * now.mean;
            velocity.0[l] -= dry_give_velocity.0[l] * now.mean;
        }
        element.dry_end = end;
    }
    let own = OwnForce {
        laws,
        remembers: element.remembers,
        without: [displacement, velocity],
        compliance: element.compliance,
        time_s: element.time_s,
        memory: element.memory,
        from: element.from,
    };
    let smooth = smooth_force(&old_smooth, &open, &own);
    // As in the march of one set, D alone follows from S.
    let counts = if element.alone { 0.0 } else { 1.0 };
    let mut end_velocity = element.end_velocity;
    for l in 0..LANES {
        let (s, d) = (smooth.0[l], dry.0[l]);
        let change = (s - old_smooth.0[l]).abs() + counts * (d - old_dry.0[l]).abs();
        let settled = change <= FORCE_TOLERANCE * (s.abs() + d.abs());
        let end = velocity.0[l] - give_velocity.0[l] * s;
        element.open.0[l] = open.0[l] & !bits(settled);
        element.smooth.0[l] = choose(open.0[l], s, old_smooth.0[l]);
        element.dry_force.0[l] = choose(open.0[l], d, old_dry.0[l]);
        end_velocity.0[l] = choose(open.0[l], end, end_velocity.0[l]);
    }
    element.end_velocity = end_velocity;
}

#[inline(always)]
fn choose(mask: u64, yes: f64, no: f64) -> f64 {
    if mask != 0 { yes } else { no }
}

#[inline(always)]
fn motion_at(from: &[Pack; 3], lane: usize) -> MemberMotion {
    MemberMotion {
        displacement: from[0].0[lane],
        velocity: from[1].0[lane],
        time_s: from[2].0[lane],
    }
}

/// Force and memory of eight laws at the end of a move, step by step until the last is there.
#[inline(always)]
fn follow(laws: &impl LawLanes, memory: &Pack, from: &[Pack; 3], to: &[Pack; 3]) -> [Pack; 2] {
    let (mut force, mut memory, mut left) = (Pack::ZERO, *memory, Pack([1.0; LANES]));
    loop {
        let mut ahead = 0;
        for l in 0..LANES {
            let (from, to) = (motion_at(from, l), motion_at(to, l));
            let now = laws.follow(l, memory.0[l], left.0[l], from, to);
            (force.0[l], memory.0[l], left.0[l]) = (now.force, now.memory, now.left);
            ahead |= bits(now.left > 0.0);
        }
        if ahead == 0 {
            return [force, memory];
        }
    }
}

/// What an element's own smooth force does to its motion, and the laws make of that.
struct OwnForce<'a, L> {
    laws: &'a L,
    remembers: bool,
    /// Displacement and velocity without the force.
    without: [Pack; 2],
    compliance: [Pack; 2],
    time_s: Pack,
    memory: Pack,
    from: [Pack; 3],
}

impl<L: LawLanes> OwnForce<'_, L> {
    /// The force that follows from the force. A closure would not be inlined into vector instructions.
    #[inline(always)]
    fn of(&self, s: &Pack) -> Pack {
        let [mut displacement, mut velocity] = self.without;
        let [give, give_velocity] = self.compliance;
        for l in 0..LANES {
            displacement.0[l] -= give.0[l] * s.0[l];
            velocity.0[l] -= give_velocity.0[l] * s.0[l];
        }
        let to = [displacement, velocity, self.time_s];
        if self.remembers {
            return follow(self.laws, &self.memory, &self.from, &to)[0];
        }
        let mut force = Pack::ZERO;
        for l in 0..LANES {
            force.0[l] = self.laws.force(l, motion_at(&to, l));
        }
        force
    }
}

/// The secant method of the march of one set; a lane that is done keeps its answer.
#[inline(always)]
fn smooth_force(guess: &Pack, wanted: &Mask, law: &OwnForce<'_, impl LawLanes>) -> Pack {
    let mut s0 = *guess;
    let mut s1 = law.of(&s0);
    let mut residual0 = Pack::ZERO;
    let mut open = *wanted;
    for l in 0..LANES {
        residual0.0[l] = s1.0[l] - s0.0[l];
        let close = residual0.0[l].abs() <= FORCE_TOLERANCE * s1.0[l].abs();
        open.0[l] &= !bits(close);
    }
    for _ in 0..SECANT_STEPS {
        if !open.any() {
            break;
        }
        let forces = law.of(&s1);
        for l in 0..LANES {
            let (a, b, r0) = (s0.0[l], s1.0[l], residual0.0[l]);
            let r1 = forces.0[l] - b;
            let slope = r1 - r0;
            // `is_finite` looks at the bits, lane after lane.
            let flat = bits(slope == 0.0) | !bits(slope.abs() < f64::INFINITY);
            let secant = b - r1 * (b - a) / slope;
            let next = choose(flat, b + r1, secant);
            let near = bits(r1 * r1 <= FORCE_TOLERANCE * (secant * r0).abs());
            let close = bits(r1.abs() <= FORCE_TOLERANCE * next.abs());
            s1.0[l] = choose(open.0[l], next, b);
            (s0.0[l], residual0.0[l]) = (b, r1);
            open.0[l] &= !(flat | near | close);
        }
    }
    s1
}

/// Commits the memory; the displacement is the one that the forces of all elements leave.
#[inline(always)]
pub(super) fn remember(laws: &impl LawLanes, element: &mut ElementLanes) {
    let to = [element.displacement, element.end_velocity, element.time_s];
    let (memory, from) = (element.memory, element.from);
    [_, element.memory] = follow(laws, &memory, &from, &to);
    element.from = to;
}
