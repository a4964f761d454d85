//! Equations (3) and (4) of [`crate::exact::march`] for one element of eight sets.
//!
//! The loops over the lanes have no exits, so that they become vector instructions. What they read
//! is copied first: the compiler then knows that nothing else changes it.

use super::law::ElementLanes;
use super::{LANES, Mask, Pack, bits};
use crate::exact::law::MemberMotion;
use crate::exact::plant::{AT_REST, FORCE_TOLERANCE, SECANT_STEPS, dry_force};

/// What the laws of the eight sets say.
pub(super) trait LawLanes {
    fn force(&self, lane: usize, motion: MemberMotion) -> f64;

    fn follow(&self, lane: usize, memory: f64, from: MemberMotion, to: MemberMotion) -> (f64, f64);

    fn dry_level(&self, lane: usize, speed: f64) -> f64;
}

/// Updates S and D of the open sets; those that stayed where they were are closed.
#[inline(always)]
pub(super) fn solve(laws: &impl LawLanes, element: &mut ElementLanes) {
    let (mut displacement, mut velocity) = (element.displacement, element.velocity);
    let [give, give_velocity] = element.compliance;
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
    let time_s = element.time_s;
    let motion = |l: usize, s: f64| MemberMotion {
        displacement: displacement.0[l] - give.0[l] * s,
        velocity: velocity.0[l] - give_velocity.0[l] * s,
        time_s: time_s.0[l],
    };
    let smooth = if element.remembers {
        let (memory, from) = (element.memory, element.from);
        smooth_force(&old_smooth, &open, |l, s| {
            laws.follow(l, memory.0[l], start_of(&from, l), motion(l, s))
                .0
        })
    } else {
        smooth_force(&old_smooth, &open, |l, s| laws.force(l, motion(l, s)))
    };
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
fn start_of(from: &[Pack; 3], lane: usize) -> MemberMotion {
    MemberMotion {
        displacement: from[0].0[lane],
        velocity: from[1].0[lane],
        time_s: from[2].0[lane],
    }
}

/// The secant method of the march of one set; a lane that is done keeps its answer.
#[inline(always)]
fn smooth_force(guess: &Pack, wanted: &Mask, law: impl Fn(usize, f64) -> f64) -> Pack {
    let mut s0 = *guess;
    let mut s1 = Pack::ZERO;
    let mut residual0 = Pack::ZERO;
    let mut open = *wanted;
    for l in 0..LANES {
        s1.0[l] = law(l, s0.0[l]);
        residual0.0[l] = s1.0[l] - s0.0[l];
        let close = residual0.0[l].abs() <= FORCE_TOLERANCE * s1.0[l].abs();
        open.0[l] &= !bits(close);
    }
    for _ in 0..SECANT_STEPS {
        if !open.any() {
            break;
        }
        for l in 0..LANES {
            let (a, b, r0) = (s0.0[l], s1.0[l], residual0.0[l]);
            let r1 = law(l, b) - b;
            let slope = r1 - r0;
            let flat = bits(slope == 0.0) | !bits(slope.is_finite());
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
    let (before, from) = (element.memory, element.from);
    let mut memory = before;
    for l in 0..LANES {
        let follow = laws.follow(l, before.0[l], start_of(&from, l), start_of(&to, l));
        memory.0[l] = follow.1;
    }
    element.memory = memory;
    element.from = to;
}
