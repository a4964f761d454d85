//! The nonlinear elements within one step: equations (3) and (4) of [`super::march`].

use simgap_model::Node;

use super::dry::{Dry, DryStep};
use super::joint::{Joint, joints};
use super::kernel::Kernel;
use super::law::{Element, MemberMotion};
use super::members::Together;
use super::propagator::ExactPropagator;
use super::secant::{FORCE_TOLERANCE, GAIN_ALONE, Secant};

/// Sweeps over several joints before the step is taken as it stands. Contraction per sweep is
/// the coupling through the masses within one step, far below one.
pub(super) const SWEEPS: usize = 8;

/// A velocity below this share of what the step would bring without friction is rest.
pub(super) const AT_REST: f64 = 1e-9;

/// How the forces of joint j move joint i within one step, E and Γ folded.
pub(super) struct Compliance {
    /// C: displacement of i per S of j.
    pub(super) displacement: Vec<f64>,
    /// C: velocity of i per S of j.
    pub(super) velocity: Vec<f64>,
    /// G: displacement of i per D of j.
    pub(super) dry_displacement: Vec<f64>,
    /// G: velocity of i per D of j.
    pub(super) dry_velocity: Vec<f64>,
}

impl Compliance {
    /// The four tables: displacement and velocity per S, then per D.
    pub(super) fn parts(&self) -> [&[f64]; 4] {
        [
            &self.displacement,
            &self.velocity,
            &self.dry_displacement,
            &self.dry_velocity,
        ]
    }
}

/// The elements on a propagator, and their forces. What is said of a joint is indexed by joint.
pub(super) struct Plant<'a> {
    pub(super) propagator: &'a ExactPropagator,
    pub(super) elements: &'a [Element],
    pub(super) joints: Vec<Joint>,
    pub(super) compliance: Compliance,
    pub(super) any_dry: bool,
    /// S of each joint at the end of the last step.
    pub(super) smooth: Vec<f64>,
    /// The part of each element.
    pub(super) part: Vec<f64>,
    /// D of each joint over the last step.
    pub(super) dry_force: Vec<f64>,
    /// D of each joint at the end of the last step.
    pub(super) dry_end: Vec<f64>,
    /// What a joint remembers, and where it was at the start of the step.
    pub(super) memory: Vec<f64>,
    pub(super) from: Vec<MemberMotion>,
    /// Velocity across each joint at the two ends of the step.
    start_velocity: Vec<f64>,
    pub(super) end_velocity: Vec<f64>,
    pub(super) free_displacement: Vec<f64>,
    pub(super) free_velocity: Vec<f64>,
    /// What a residual of S is multiplied with: −1 over its slope, as it was last.
    pub(super) gain: Vec<f64>,
    /// S of each joint at the ends of the four steps before the last.
    pub(super) before: Vec<[f64; 4]>,
    /// Which joints are solved together.
    pub(super) together: Together,
}

/// What stands at one node less what stands at the other.
fn across([a, b]: [Node; 2], values: &[f64], bases: &[f64]) -> f64 {
    a.of(values, bases) - b.of(values, bases)
}

/// Adds what a force carried by an element does to the degrees of freedom.
pub(super) fn spread(element: &Element, force: f64, dof_force: &mut [f64]) {
    let [a, b] = element.port.force;
    a.push(-force, dof_force);
    b.push(force, dof_force);
}

/// Where a polynomial through five equal steps leads: 5 s₀ − 10 s₁ + 10 s₂ − 5 s₃ + s₄ from the last backwards.
fn ahead(now: f64, [s1, s2, s3, s4]: [f64; 4]) -> f64 {
    5.0 * (now - s3) - 10.0 * (s1 - s2) + s4
}

/// A joint within one step, the others held.
struct Trial {
    /// Motion at its end without the forces of the joint.
    without: [f64; 2],
    /// What a unit of S, and of D, takes from displacement and velocity.
    compliance: [f64; 2],
    dry_compliance: [f64; 2],
    time_s: f64,
}

impl<'a> Plant<'a> {
    pub(super) fn new(propagator: &'a ExactPropagator, elements: &'a [Element]) -> Plant<'a> {
        let n = propagator.dof_count;
        let joints = joints(elements);
        let m = joints.len();
        let sum: Vec<f64> = propagator
            .gamma0
            .iter()
            .zip(&propagator.gamma1)
            .map(|(a, b)| a + b)
            .collect();
        let element = |joint: usize| &elements[joints[joint].elements[0]];
        let fold = |gamma: &[f64], offset: usize| -> Vec<f64> {
            let mut folded = vec![0.0; m * m];
            let mut column = vec![0.0; n];
            for j in 0..m {
                column.fill(0.0);
                spread(element(j), 1.0, &mut column);
                let moved: Vec<f64> = (0..n)
                    .map(|i| {
                        (0..n)
                            .map(|k| gamma[(offset + i) * n + k] * column[k])
                            .sum()
                    })
                    .collect();
                for i in 0..m {
                    let at = |node: Node| match node {
                        Node::Ground | Node::Base(_) | Node::Port(_) => 0.0,
                        Node::Dof(_) | Node::Point(_) => node.of(&moved, &[]),
                    };
                    // Pushed by −E: a positive force moves its own joint back.
                    let port = &element(i).port;
                    let [a, b] = if offset == 0 {
                        port.displacement
                    } else {
                        port.velocity
                    };
                    folded[i * m + j] = -(at(a) - at(b));
                }
            }
            folded
        };
        let compliance = Compliance {
            displacement: fold(&propagator.gamma1, 0),
            velocity: fold(&propagator.gamma1, n),
            dry_displacement: fold(&sum, 0),
            dry_velocity: fold(&sum, n),
        };
        let first_memory = |joint: &Joint| {
            let law = joint.remembers.map(|i| &elements[i].law);
            law.map_or(0.0, |law| law.first_memory())
        };
        Plant {
            together: Together::new((0..m).filter(|j| joints[*j].has_tangent).collect()),
            compliance,
            propagator,
            elements,
            any_dry: joints.iter().any(|joint| joint.dry),
            memory: joints.iter().map(first_memory).collect(),
            from: vec![MemberMotion::default(); m],
            smooth: vec![0.0; m],
            part: vec![0.0; elements.len()],
            dry_force: vec![0.0; m],
            dry_end: vec![0.0; m],
            start_velocity: vec![0.0; m],
            end_velocity: vec![0.0; m],
            free_displacement: vec![0.0; m],
            free_velocity: vec![0.0; m],
            gain: vec![GAIN_ALONE; m],
            before: vec![[0.0; 4]; m],
            joints,
        }
    }

    /// Motion across an element.
    fn motion(&self, element: &Element, state: &[f64], base: &[f64], time_s: f64) -> MemberMotion {
        let (x, v) = state.split_at(self.propagator.dof_count);
        let (base_x, base_v) = base.split_at(base.len() / 2);
        MemberMotion {
            displacement: across(element.port.displacement, x, base_x),
            velocity: across(element.port.velocity, v, base_v),
            time_s,
            step_s: self.propagator.time_step_s,
        }
    }

    /// Forces that the elements carry at a sample.
    pub(super) fn carry(&self, state: &[f64], base: &[f64], time_s: f64, carried: &mut [f64]) {
        carried.copy_from_slice(&self.part);
        for (joint, dry) in self.joints.iter().zip(&self.dry_end) {
            carried[joint.elements[0]] += dry;
        }
        for (element, carried) in self.elements.iter().zip(carried) {
            if element.law.is_spread_over_steps() {
                let motion = self.motion(element, state, base, time_s);
                *carried += element.law.beyond_step(motion);
            }
        }
    }

    /// Forces at the first sample, where the motion is given.
    pub(super) fn begin(&mut self, state: &[f64], force: &[f64], base: &[f64], time_s: f64) {
        let no_force = vec![0.0; base.len() / 2];
        for (k, joint) in self.joints.iter().enumerate() {
            let first = &self.elements[joint.elements[0]];
            let motion = self.motion(first, state, base, time_s);
            self.from[k] = motion;
            for &i in &joint.elements {
                let law = &self.elements[i].law;
                self.part[i] = if joint.remembers == Some(i) {
                    let first = law.follow(self.memory[k], motion, motion);
                    self.memory[k] = first.memory;
                    first.force
                } else {
                    law.force(motion)
                };
                self.smooth[k] += self.part[i];
            }
            let level = first.law.dry_level(motion.velocity.abs()).unwrap_or(0.0);
            // At rest the dry force balances what it can of the excitation across it.
            let at_rest = across(first.port.force, force, &no_force).clamp(-level, level);
            self.end_velocity[k] = motion.velocity;
            self.dry_end[k] = if motion.velocity == 0.0 {
                at_rest
            } else {
                level * motion.velocity.signum()
            };
            self.before[k] = [self.smooth[k]; 4];
        }
    }

    /// Solves (3) and (4) for the forces at the end of the step.
    #[inline(always)]
    pub(super) fn solve(&mut self, free: &[f64], base: &[f64], time_s: f64) {
        let (free_x, free_v) = free.split_at(free.len() / 2);
        let (base_x, base_v) = base.split_at(base.len() / 2);
        for (k, joint) in self.joints.iter().enumerate() {
            let port = &self.elements[joint.elements[0]].port;
            self.free_displacement[k] = across(port.displacement, free_x, base_x);
            self.free_velocity[k] = across(port.velocity, free_v, base_v);
        }
        self.start_velocity.copy_from_slice(&self.end_velocity);
        // What sticks ends a step at rest but for rounding.
        for (velocity, free) in self.start_velocity.iter_mut().zip(&self.free_velocity) {
            if velocity.abs() <= AT_REST * free.abs() {
                *velocity = 0.0;
            }
        }
        for (smooth, before) in self.smooth.iter_mut().zip(&mut self.before) {
            let now = *smooth;
            *smooth = ahead(now, *before);
            *before = [now, before[0], before[1], before[2]];
        }
        for _ in 0..self.sweeps() {
            let mut settled = true;
            if !self.together.members.is_empty() {
                settled &= self.solve_together(time_s);
            }
            for k in 0..self.joints.len() {
                if !self.joints[k].has_tangent {
                    settled &= self.solve_joint(k, time_s);
                }
            }
            if settled {
                break;
            }
        }
        for k in 0..self.joints.len() {
            if let Some(element) = self.joints[k].remembers {
                self.remember(k, element, time_s);
            }
        }
    }

    /// Sweeps over the joints at the most: none is solved again where nothing else moves it.
    pub(super) fn sweeps(&self) -> usize {
        let count = self.joints.len();
        if count == 1 || self.together.members.len() == count {
            1
        } else {
            SWEEPS
        }
    }

    /// Motion across a joint at the end of the step under the forces of some joints.
    #[inline(always)]
    pub(super) fn motion_under(&self, k: usize, acts: impl Fn(usize) -> bool) -> [f64; 2] {
        let m = self.joints.len();
        let c = &self.compliance;
        let (mut displacement, mut velocity) = (self.free_displacement[k], self.free_velocity[k]);
        for j in (0..m).filter(|&j| acts(j)) {
            let entry = k * m + j;
            let (smooth, dry) = (self.smooth[j], self.dry_force[j]);
            displacement -= c.displacement[entry] * smooth + c.dry_displacement[entry] * dry;
            velocity -= c.velocity[entry] * smooth + c.dry_velocity[entry] * dry;
        }
        [displacement, velocity]
    }

    /// Commits the memory of a joint at the end of a step, with the others where they settled.
    fn remember(&mut self, k: usize, element: usize, time_s: f64) {
        let to = MemberMotion {
            displacement: self.motion_under(k, |_| true)[0],
            velocity: self.end_velocity[k],
            time_s,
            step_s: self.propagator.time_step_s,
        };
        self.memory[k] = self.elements[element]
            .law
            .follow(self.memory[k], self.from[k], to)
            .memory;
        self.from[k] = to;
    }

    /// Updates S and D of one joint with the others held; true if they stayed where they were.
    #[inline(always)]
    fn solve_joint(&mut self, k: usize, time_s: f64) -> bool {
        let m = self.joints.len();
        let c = &self.compliance;
        let without = self.motion_under(k, |j| j != k);
        let own = k * m + k;
        let trial = Trial {
            without,
            compliance: [c.displacement[own], c.velocity[own]],
            dry_compliance: [c.dry_displacement[own], c.dry_velocity[own]],
            time_s,
        };
        let (old_smooth, old_dry) = (self.smooth[k], self.dry_force[k]);
        let (mut force, mut dry) = self.act(k, &trial, old_smooth);
        let mut secant = Secant::begin(old_smooth, force, self.gain[k]);
        while secant.is_open() {
            (force, dry) = self.act(k, &trial, secant.tried);
            secant.step(force);
        }
        let smooth = secant.smooth;
        self.gain[k] = secant.kept_gain();
        self.part[self.joints[k].elements[0]] += smooth - force;
        // What D is where it holds against the last of S.
        let moved = trial.compliance[1] * (smooth - secant.tried);
        let dry_force = dry.mean - dry.stiffness * moved;
        self.dry_end[k] = dry.end - dry.stiffness * moved;
        let [_, give] = trial.compliance;
        let [_, dry_give] = trial.dry_compliance;
        self.end_velocity[k] = without[1] - dry_give * dry_force - give * smooth;
        (self.smooth[k], self.dry_force[k]) = (smooth, dry_force);
        let change = (smooth - old_smooth).abs() + (dry_force - old_dry).abs();
        change <= FORCE_TOLERANCE * (smooth.abs() + dry_force.abs())
    }

    /// What the laws of a joint say where S is `smooth`: S, and D.
    #[inline(always)]
    fn act(&mut self, k: usize, trial: &Trial, smooth: f64) -> (f64, Dry) {
        let [give, give_velocity] = trial.compliance;
        let mut displacement = trial.without[0] - give * smooth;
        let mut velocity = trial.without[1] - give_velocity * smooth;
        let joint = &self.joints[k];
        let mut dry = Dry::NONE;
        if joint.dry {
            let law = &self.elements[joint.elements[0]].law;
            let [dry_give, dry_give_velocity] = trial.dry_compliance;
            let step = DryStep {
                before: self.dry_end[k],
                start: self.start_velocity[k],
                free: velocity,
                compliance: dry_give_velocity,
            };
            dry = step.force(law.as_ref());
            displacement -= dry_give * dry.mean;
            velocity -= dry_give_velocity * dry.mean;
        }
        let motion = MemberMotion {
            displacement,
            velocity,
            time_s: trial.time_s,
            step_s: self.propagator.time_step_s,
        };
        let mut sum = 0.0;
        for &i in &joint.elements {
            let law = &self.elements[i].law;
            self.part[i] = if joint.remembers == Some(i) {
                law.follow(self.memory[k], self.from[k], motion).force
            } else {
                law.force(motion)
            };
            sum += self.part[i];
        }
        (sum, dry)
    }

    /// Adds what S₁ and D₁ do to the free state, (1).
    #[inline(always)]
    pub(super) fn push(&self, kernel: &mut impl Kernel, next: &mut [f64], net: &mut [f64]) {
        net.fill(0.0);
        self.spread_smooth(net);
        kernel.push_end(net, next);
        if self.any_dry {
            net.fill(0.0);
            for (joint, &d) in self.joints.iter().zip(&self.dry_force) {
                spread(&self.elements[joint.elements[0]], d, net);
            }
            kernel.push_held(net, next);
        }
    }

    /// Adds what S of all joints does to the degrees of freedom.
    #[inline(always)]
    pub(super) fn spread_smooth(&self, dof_force: &mut [f64]) {
        for (joint, &s) in self.joints.iter().zip(&self.smooth) {
            spread(&self.elements[joint.elements[0]], s, dof_force);
        }
    }
}
