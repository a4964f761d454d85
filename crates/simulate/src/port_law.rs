//! Laws at the ports of a simulator, one step at a time.
//!
//! Over a step from one sample to the next a force is held, as a simulator steps. Its smooth part is the mean of what the law says
//! at the two ends; its dry part holds the port still at the end of the step if its level allows, and else opposes the motion:
//!
//! ```text
//! F = (S(start) + S(end)) / 2 + D                                                                   (1)
//! D with v(end) = 0 where |D| ≤ level(0),   D = level(|v(end)|) sgn v(end) elsewhere                (2)
//! x(end) = x_free − C F                                                                             (3)
//! ```
//!
//! x and v are displacement and velocity across the law, C what a force over the step moves them by.

use simgap_integrate::exact::{ForceLaw, MemberMotion};

/// Steps of the search for the force of (1).
const MOST_STEPS: usize = 60;
/// Relative accuracy of the force.
const ACCURATE: f64 = 1e-13;

/// A law between two ports, or a port and the ground (`None`).
pub(crate) struct PortLaw {
    /// a and b: the law reads the motion of a less that of b, and pushes a with −F and b with +F.
    pub(crate) ends: [Option<usize>; 2],
    pub(crate) law: Box<dyn ForceLaw>,
}

/// A spring and a damper.
pub(crate) struct Member {
    pub(crate) stiffness: f64,
    pub(crate) damping: f64,
}

impl ForceLaw for Member {
    fn force(&self, motion: MemberMotion) -> f64 {
        self.stiffness * motion.displacement + self.damping * motion.velocity
    }
}

impl PortLaw {
    /// What stands at a less what stands at b.
    pub(crate) fn across(&self, of_port: impl Fn(usize) -> f64) -> f64 {
        let [a, b] = self.ends.map(|end| end.map_or(0.0, &of_port));
        a - b
    }

    /// By how much a force of one newton of the law pushes a port.
    pub(crate) fn push(&self, port: usize) -> f64 {
        let [a, b] = self.ends.map(|end| f64::from(u8::from(end == Some(port))));
        b - a
    }
}

/// A law on its way along a run.
pub(crate) struct Course {
    /// Motion at the start of the step.
    from: MemberMotion,
    memory: f64,
    /// S at the start of the step.
    smooth: f64,
    /// F over the last step.
    pub(crate) force: f64,
}

/// A step that a law is solved over.
#[derive(Clone, Copy)]
pub(crate) struct Step {
    /// Displacement and velocity at its end without the force, (3).
    pub(crate) free: [f64; 2],
    /// C of (3), m/N and m/(s N).
    pub(crate) compliance: [f64; 2],
    /// Time of its end, s, and its length, s.
    pub(crate) time_s: f64,
    pub(crate) step_s: f64,
}

impl Step {
    fn end(&self, force: f64) -> MemberMotion {
        MemberMotion {
            displacement: self.free[0] - self.compliance[0] * force,
            velocity: self.free[1] - self.compliance[1] * force,
            time_s: self.time_s,
            step_s: self.step_s,
        }
    }
}

impl Course {
    pub(crate) fn new(law: &dyn ForceLaw, from: MemberMotion) -> Course {
        let memory = law.first_memory();
        let smooth = match law.remembers() {
            true => law.follow(memory, from, from).force,
            false => law.force(from),
        };
        Course {
            from,
            memory,
            smooth,
            force: 0.0,
        }
    }

    /// S at a motion.
    fn smooth(&self, law: &dyn ForceLaw, to: MemberMotion) -> f64 {
        match law.remembers() {
            true => law.follow(self.memory, self.from, to).force,
            false => law.force(to),
        }
    }

    /// F over a step by (1) to (3).
    pub(crate) fn solve(&mut self, law: &dyn ForceLaw, step: &Step) -> f64 {
        let mean = |force: f64| 0.5 * (self.smooth + self.smooth(law, step.end(force)));
        self.force = match law.dry_level(0.0) {
            None => root(|force| force - mean(force), self.force),
            Some(level) => {
                let holding = step.free[1] / step.compliance[1];
                let dry = holding - mean(holding);
                if dry.abs() <= level {
                    holding
                } else {
                    let opposed = |force: f64| {
                        let speed = step.end(force).velocity.abs();
                        law.dry_level(speed).unwrap_or(0.0) * dry.signum()
                    };
                    root(|force| force - mean(force) - opposed(force), self.force)
                }
            }
        };
        self.force
    }

    /// Goes to the end of the step.
    pub(crate) fn advance(&mut self, law: &dyn ForceLaw, step: &Step) {
        let to = step.end(self.force);
        if law.remembers() {
            let followed = law.follow(self.memory, self.from, to);
            (self.smooth, self.memory) = (followed.force, followed.memory);
        } else {
            self.smooth = law.force(to);
        }
        self.from = to;
    }
}

/// Where a rising function is zero: between bounds, which a slope of one or more gives at once, by false position with
/// halved ends (Illinois) and by halves where that is slow.
fn root(value: impl Fn(f64) -> f64, guess: f64) -> f64 {
    let (mut a, mut at_a) = (guess, value(guess));
    let mut b = a - at_a;
    let mut at_b = value(b);
    let mut reach = at_a;
    for _ in 0..MOST_STEPS {
        if at_a * at_b <= 0.0 || !at_b.is_finite() {
            break;
        }
        (a, at_a) = (b, at_b);
        reach *= 2.0;
        b -= reach;
        at_b = value(b);
    }
    let mut width = f64::INFINITY;
    for _ in 0..MOST_STEPS {
        let is_accurate = at_b.abs() <= ACCURATE * b.abs();
        if is_accurate || (b - a).abs() <= ACCURATE * (a.abs() + b.abs()) || !at_b.is_finite() {
            return b;
        }
        let is_slow = (b - a).abs() > 0.5 * width;
        width = (b - a).abs();
        let next = match is_slow {
            true => 0.5 * (a + b),
            false => b - at_b * (b - a) / (at_b - at_a),
        };
        let at_next = value(next);
        if at_next * at_b < 0.0 {
            (a, at_a) = (b, at_b);
        } else {
            at_a *= 0.5;
        }
        (b, at_b) = (next, at_next);
    }
    b
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Friction(f64);

    impl ForceLaw for Friction {
        fn force(&self, _: MemberMotion) -> f64 {
            0.0
        }

        fn dry_level(&self, _: f64) -> Option<f64> {
            Some(self.0)
        }
    }

    fn step(free_velocity: f64) -> Step {
        Step {
            free: [0.0, free_velocity],
            compliance: [0.0005, 0.01],
            time_s: 0.1,
            step_s: 0.1,
        }
    }

    fn over(law: &dyn ForceLaw, step: &Step) -> f64 {
        Course::new(law, MemberMotion::default()).solve(law, step)
    }

    #[test]
    fn verify_friction_holds_up_to_its_level_and_slides_beyond() {
        let law = Friction(3.0);
        assert!((over(&law, &step(0.02)) - 2.0).abs() < 1e-12);
        assert!((over(&law, &step(0.05)) - 3.0).abs() < 1e-12);
        assert!((over(&law, &step(-0.05)) + 3.0).abs() < 1e-12);
    }

    /// F = (S₀ + c (v − C F)) / 2 with S₀ = 0.
    #[test]
    fn verify_a_damper_and_a_stop_are_solved() {
        let (c, v) = (250.0, 0.3);
        let damper = Member {
            stiffness: 0.0,
            damping: c,
        };
        let closed = 0.5 * c * v / (1.0 + 0.5 * c * 0.01);
        assert!((over(&damper, &step(v)) - closed).abs() < 1e-9 * closed);
        struct Stop;
        impl ForceLaw for Stop {
            fn force(&self, motion: MemberMotion) -> f64 {
                1e6 * (motion.displacement - 0.001).max(0.0)
            }
        }
        let into = Step {
            free: [0.01, 1.0],
            ..step(1.0)
        };
        let force = over(&Stop, &into);
        let needed = 0.5 * 1e6 * (0.01 - 0.0005 * force - 0.001);
        assert!((force - needed).abs() < 1e-6 * needed, "{force} {needed}");
    }

    #[test]
    fn verify_ends_push_and_read_with_their_signs() {
        let law = PortLaw {
            ends: [Some(1), None],
            law: Box::new(Friction(1.0)),
        };
        assert_eq!(law.across(|port| [5.0, 7.0][port]), 7.0);
        assert_eq!([law.push(0), law.push(1)], [0.0, -1.0]);
    }
}
