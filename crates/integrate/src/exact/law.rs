//! What the propagation needs to know of a nonlinear force.

use std::any::Any;

use simgap_model::Node;

use super::lanes::LaneLaw;

/// Motion across a member, and when.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct MemberMotion {
    /// d = x_a − x_b, m.
    pub displacement: f64,
    /// v = ẋ_a − ẋ_b, m/s.
    pub velocity: f64,
    /// t, s, on the clock of the record.
    pub time_s: f64,
    /// Length of the steps of the march, s; zero where there are none. Between two of its points a force goes in a straight
    /// line: one that jumps has to do so over a step ([`MemberMotion::set_in`]).
    pub step_s: f64,
}

impl MemberMotion {
    /// Which part of what sets in at a point acts so far beyond it, m: all or nothing, or, where a step of the march goes so
    /// far, a straight line from half a step before the point to half a step after it, which pushes as much.
    #[must_use]
    pub fn set_in(&self, beyond_m: f64) -> f64 {
        let way = self.velocity.abs() * self.step_s;
        if way > 0.0 {
            (beyond_m / way + 0.5).clamp(0.0, 1.0)
        } else if beyond_m > 0.0 {
            1.0
        } else {
            0.0
        }
    }
}

/// Where a law that remembers is on its way along a move.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Followed {
    /// The single-valued part, N.
    pub force: f64,
    /// What it remembers.
    pub memory: f64,
    /// Share of the move that is still ahead; zero at the end of the move.
    pub left: f64,
}

impl Followed {
    /// At the end of the move.
    #[inline(always)]
    #[must_use]
    pub fn arrived(force: f64, memory: f64) -> Self {
        Self {
            force,
            memory,
            left: 0.0,
        }
    }
}

/// A smooth force at a motion, and how it changes about it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tangent {
    /// The single-valued part, N.
    pub force: f64,
    /// Its slope over the velocity, N s/m.
    pub damping: f64,
}

/// A force carried between two nodes, positive when it resists a positive displacement of a from
/// b, as a spring's `k d` does: it pushes a with −F and b with +F.
///
/// A law may remember its past in one number, which is handed to it and taken back step by step.
///
/// A law has a single-valued part, and may have a dry part: a force of either sign up to a level,
/// which holds the member still if it can (a set-valued force at zero velocity).
pub trait ForceLaw: Any + Send + Sync {
    /// The single-valued part, N.
    fn force(&self, motion: MemberMotion) -> f64;

    /// Whether [`ForceLaw::force`] is made to act over a step as the force does between its ends, and so is another than the
    /// force at a point: a jump that it spreads, a tone that straight lines between points would cut short.
    fn is_spread_over_steps(&self) -> bool {
        false
    }

    /// For a law that [`ForceLaw::is_spread_over_steps`]: the force at a point less what acts over a step, N. A member is
    /// moved by the one and an output is sampled of the other.
    fn beyond_step(&self, motion: MemberMotion) -> f64 {
        let at_a_point = MemberMotion {
            step_s: 0.0,
            ..motion
        };
        self.force(at_a_point) - self.force(motion)
    }

    /// Whether the law offers its [`ForceLaw::tangent`]: for a law of the velocity without a dry part and without memory,
    /// whose displacement does not move with its own force within a step. Such laws are solved together, by Newton's
    /// method, in place of one after the other.
    fn has_tangent(&self) -> bool {
        false
    }

    /// For a law that [`ForceLaw::has_tangent`]: the force with its slope.
    fn tangent(&self, motion: MemberMotion) -> Tangent {
        Tangent {
            force: self.force(motion),
            damping: 0.0,
        }
    }

    /// Whether the force depends on the way the member came, not on where it is alone.
    fn remembers(&self) -> bool {
        false
    }

    /// The memory at the first sample (a force, a displacement: what the law makes of it).
    fn first_memory(&self) -> f64 {
        0.0
    }

    /// For a law that [`ForceLaw::remembers`]: one step along a move, from the memory where the share
    /// `left` of the move is ahead, one at its start. The way between is taken to be monotone. A law
    /// that follows a long move in several steps stays where nothing is left; without exits or calls
    /// it becomes vector instructions where sets are marched side by side.
    fn follow_step(
        &self,
        memory: f64,
        left: f64,
        from: MemberMotion,
        to: MemberMotion,
    ) -> Followed {
        let _ = (left, from);
        Followed::arrived(self.force(to), memory)
    }

    /// Largest dry force at the sliding speed |v| (m/s), N, not negative; `None` for a law
    /// without a dry part.
    fn dry_level(&self, speed: f64) -> Option<f64> {
        let _ = speed;
        None
    }

    /// The laws of eight parameter sets side by side, this one among them; `None` where that is not
    /// offered or they are not of one type. See [`crate::lanes!`].
    fn lanes(&self, peers: &[&dyn ForceLaw]) -> Option<Box<dyn LaneLaw>> {
        let _ = peers;
        None
    }
}

impl dyn ForceLaw {
    /// The whole move by [`ForceLaw::follow_step`].
    pub fn follow(&self, memory: f64, from: MemberMotion, to: MemberMotion) -> Followed {
        let mut at = self.follow_step(memory, 1.0, from, to);
        while at.left > 0.0 {
            at = self.follow_step(at.memory, at.left, from, to);
        }
        at
    }
}

/// A law on the plant: a port that reads two numbers off the state and pushes it with one.
pub struct Element {
    /// What it reads and what it pushes.
    pub port: Port,
    /// The force it carries.
    pub law: Box<dyn ForceLaw>,
}

/// Where a law is joined to the plant, each a difference of two nodes a and b,
///
/// ```text
/// d = r_dᵀ x,    v = r_vᵀ ẋ,    the plant is pushed with − r_f F(d, v)                               (1)
/// ```
///
/// The three rows are one for a member between two nodes. An orifice reads the position of a spool and the pressure of
/// a chamber, which is the rate of a coordinate, and pushes that coordinate with its flow.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Port {
    /// r_d.
    pub displacement: [Node; 2],
    /// r_v.
    pub velocity: [Node; 2],
    /// r_f: a is pushed with −F and b with +F.
    pub force: [Node; 2],
}

impl Element {
    /// A law carried between two nodes.
    #[must_use]
    pub fn between(a: Node, b: Node, law: Box<dyn ForceLaw>) -> Element {
        let row = [a, b];
        let port = Port {
            displacement: row,
            velocity: row,
            force: row,
        };
        Element { port, law }
    }
}
