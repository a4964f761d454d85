//! The nonlinear elements within one step: equations (3) and (4) of [`super::march`].

use simgap_model::Node;

use super::dry::DryStep;
use super::kernel::Kernel;
use super::law::{Element, MemberMotion};
use super::members::Together;
use super::propagator::ExactPropagator;

/// Sweeps over several elements before the step is taken as it stands. Contraction per sweep is
/// the coupling through the masses within one step, far below one.
pub(super) const SWEEPS: usize = 8;
/// Secant iterations on (3); smooth laws need two, a hard stop a few more.
pub(super) const SECANT_STEPS: usize = 12;
/// Relative accuracy of the element forces, far below what the trapezoidal rule leaves.
pub(super) const FORCE_TOLERANCE: f64 = 1e-8;

/// A velocity below this share of what the step would bring without friction is rest.
pub(super) const AT_REST: f64 = 1e-9;

/// How the forces of element j move element i within one step, E and Γ folded.
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

/// The elements on a propagator, and their forces.
pub(super) struct Plant<'a> {
    pub(super) propagator: &'a ExactPropagator,
    pub(super) elements: &'a [Element],
    pub(super) compliance: Compliance,
    pub(super) dry: Vec<bool>,
    pub(super) any_dry: bool,
    /// S of each element at the end of the last step.
    pub(super) smooth: Vec<f64>,
    /// D of each element over the last step.
    pub(super) dry_force: Vec<f64>,
    /// D of each element at the end of the last step.
    pub(super) dry_end: Vec<f64>,
    /// Which elements remember, what, and where they were at the start of the step.
    pub(super) remembers: Vec<bool>,
    pub(super) memory: Vec<f64>,
    pub(super) from: Vec<MemberMotion>,
    /// Velocity across each element at the two ends of the step.
    start_velocity: Vec<f64>,
    pub(super) end_velocity: Vec<f64>,
    pub(super) free_displacement: Vec<f64>,
    pub(super) free_velocity: Vec<f64>,
    /// Which elements are solved together.
    pub(super) has_tangent: Vec<bool>,
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

impl<'a> Plant<'a> {
    pub(super) fn new(propagator: &'a ExactPropagator, elements: &'a [Element]) -> Plant<'a> {
        let (n, m) = (propagator.dof_count, elements.len());
        let sum: Vec<f64> = propagator
            .gamma0
            .iter()
            .zip(&propagator.gamma1)
            .map(|(a, b)| a + b)
            .collect();
        let fold = |gamma: &[f64], offset: usize| -> Vec<f64> {
            let mut folded = vec![0.0; m * m];
            let mut column = vec![0.0; n];
            for j in 0..m {
                column.fill(0.0);
                spread(&elements[j], 1.0, &mut column);
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
                    // Pushed by −E: a positive force moves its own element back.
                    let port = &elements[i].port;
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
        let has_tangent: Vec<bool> = elements.iter().map(|e| e.law.has_tangent()).collect();
        Plant {
            together: Together::new((0..m).filter(|i| has_tangent[*i]).collect()),
            has_tangent,
            compliance: Compliance {
                displacement: fold(&propagator.gamma1, 0),
                velocity: fold(&propagator.gamma1, n),
                dry_displacement: fold(&sum, 0),
                dry_velocity: fold(&sum, n),
            },
            propagator,
            elements,
            any_dry: elements.iter().any(|e| e.law.dry_level(0.0).is_some()),
            dry: elements
                .iter()
                .map(|e| e.law.dry_level(0.0).is_some())
                .collect(),
            remembers: elements.iter().map(|e| e.law.remembers()).collect(),
            memory: elements.iter().map(|e| e.law.first_memory()).collect(),
            from: vec![MemberMotion::default(); m],
            smooth: vec![0.0; m],
            dry_force: vec![0.0; m],
            dry_end: vec![0.0; m],
            start_velocity: vec![0.0; m],
            end_velocity: vec![0.0; m],
            free_displacement: vec![0.0; m],
            free_velocity: vec![0.0; m],
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

    /// The force that an element carries at a sample.
    pub(super) fn carried(&self, i: usize, state: &[f64], base: &[f64], time_s: f64) -> f64 {
        let element = &self.elements[i];
        let carried = self.smooth[i] + self.dry_end[i];
        if element.law.is_spread_over_steps() {
            let motion = self.motion(element, state, base, time_s);
            carried + element.law.beyond_step(motion)
        } else {
            carried
        }
    }

    /// Forces at the first sample, where the motion is given.
    pub(super) fn begin(&mut self, state: &[f64], force: &[f64], base: &[f64], time_s: f64) {
        let no_force = vec![0.0; base.len() / 2];
        for (i, element) in self.elements.iter().enumerate() {
            let motion = self.motion(element, state, base, time_s);
            self.from[i] = motion;
            self.smooth[i] = if self.remembers[i] {
                let first = element.law.follow(self.memory[i], motion, motion);
                self.memory[i] = first.memory;
                first.force
            } else {
                element.law.force(motion)
            };
            let level = element.law.dry_level(motion.velocity.abs()).unwrap_or(0.0);
            // At rest the dry force balances what it can of the excitation across it.
            let at_rest = across(element.port.force, force, &no_force).clamp(-level, level);
            self.end_velocity[i] = motion.velocity;
            self.dry_end[i] = if motion.velocity == 0.0 {
                at_rest
            } else {
                level * motion.velocity.signum()
            };
        }
        self.together.begin(&self.smooth);
    }

    /// Solves (3) and (4) for the forces at the end of the step.
    #[inline(always)]
    pub(super) fn solve(&mut self, free: &[f64], base: &[f64], time_s: f64) {
        let (free_x, free_v) = free.split_at(free.len() / 2);
        let (base_x, base_v) = base.split_at(base.len() / 2);
        let m = self.elements.len();
        for (i, element) in self.elements.iter().enumerate() {
            self.free_displacement[i] = across(element.port.displacement, free_x, base_x);
            self.free_velocity[i] = across(element.port.velocity, free_v, base_v);
        }
        self.start_velocity.copy_from_slice(&self.end_velocity);
        // What sticks ends a step at rest but for rounding.
        for (i, velocity) in self.start_velocity.iter_mut().enumerate() {
            if velocity.abs() <= AT_REST * self.free_velocity[i].abs() {
                *velocity = 0.0;
            }
        }
        self.extrapolate();
        for _ in 0..self.sweeps() {
            let mut settled = true;
            if !self.together.members.is_empty() {
                settled &= self.solve_together(time_s);
            }
            for i in 0..m {
                if !self.has_tangent[i] {
                    settled &= self.solve_element(i, time_s);
                }
            }
            if settled {
                break;
            }
        }
        for i in 0..m {
            if self.remembers[i] {
                self.remember(i, time_s);
            }
        }
    }

    /// Commits the memory of an element at the end of a step, with the others where they settled.
    fn remember(&mut self, i: usize, time_s: f64) {
        let m = self.elements.len();
        let c = &self.compliance;
        let mut displacement = self.free_displacement[i];
        for j in 0..m {
            let k = i * m + j;
            displacement -=
                c.displacement[k] * self.smooth[j] + c.dry_displacement[k] * self.dry_force[j];
        }
        let to = MemberMotion {
            displacement,
            velocity: self.end_velocity[i],
            time_s,
            step_s: self.propagator.time_step_s,
        };
        self.memory[i] = self.elements[i]
            .law
            .follow(self.memory[i], self.from[i], to)
            .memory;
        self.from[i] = to;
    }

    /// Updates S and D of one element with the others held; true if they stayed where they were.
    #[inline(always)]
    fn solve_element(&mut self, i: usize, time_s: f64) -> bool {
        let m = self.elements.len();
        let law = &self.elements[i].law;
        let c = &self.compliance;
        let (mut displacement, mut velocity) = (self.free_displacement[i], self.free_velocity[i]);
        for j in (0..m).filter(|&j| j != i) {
            let k = i * m + j;
            displacement -=
                c.displacement[k] * self.smooth[j] + c.dry_displacement[k] * self.dry_force[j];
            velocity -= c.velocity[k] * self.smooth[j] + c.dry_velocity[k] * self.dry_force[j];
        }
        let own = i * m + i;
        let (old_smooth, old_dry) = (self.smooth[i], self.dry_force[i]);
        if self.dry[i] {
            let free_velocity = velocity - c.velocity[own] * self.smooth[i];
            let step = DryStep {
                before: self.dry_end[i],
                start: self.start_velocity[i],
                free: free_velocity,
                compliance: c.dry_velocity[own],
            };
            let dry = step.force(|speed| law.dry_level(speed).unwrap_or(0.0));
            (self.dry_force[i], self.dry_end[i]) = (dry.mean, dry.end);
            displacement -= c.dry_displacement[own] * self.dry_force[i];
            velocity -= c.dry_velocity[own] * self.dry_force[i];
        }
        let motion = |s: f64| MemberMotion {
            displacement: displacement - c.displacement[own] * s,
            velocity: velocity - c.velocity[own] * s,
            time_s,
            step_s: self.propagator.time_step_s,
        };
        self.smooth[i] = if self.remembers[i] {
            let (memory, from) = (self.memory[i], self.from[i]);
            smooth_force(old_smooth, |s| law.follow(memory, from, motion(s)).force)
        } else {
            smooth_force(old_smooth, |s| law.force(motion(s)))
        };
        self.end_velocity[i] = velocity - c.velocity[own] * self.smooth[i];
        let size = self.smooth[i].abs() + self.dry_force[i].abs();
        // D follows from S: alone, an element with the S that its D was found for is done.
        let dry_change = if m == 1 {
            0.0
        } else {
            (self.dry_force[i] - old_dry).abs()
        };
        let change = (self.smooth[i] - old_smooth).abs() + dry_change;
        change <= FORCE_TOLERANCE * size
    }

    /// Adds what S₁ and D₁ do to the free state, (1).
    #[inline(always)]
    pub(super) fn push(&self, kernel: &mut impl Kernel, next: &mut [f64], net: &mut [f64]) {
        net.fill(0.0);
        for (element, &s) in self.elements.iter().zip(&self.smooth) {
            spread(element, s, net);
        }
        kernel.push_end(net, next);
        if self.any_dry {
            net.fill(0.0);
            for (element, &d) in self.elements.iter().zip(&self.dry_force) {
                spread(element, d, net);
            }
            kernel.push_held(net, next);
        }
    }
}

/// (3): solves S = φ(S) from a first guess by the secant method.
///
/// With r₀ and r₁ the residuals of two iterates, the secant step leaves about r₁²/r₀: two
/// evaluations are enough for a law that is smooth on the scale of a step.
#[inline(always)]
fn smooth_force(guess: f64, law: impl Fn(f64) -> f64) -> f64 {
    let mut s0 = guess;
    let mut s1 = law(s0);
    let mut residual0 = s1 - s0;
    for _ in 0..SECANT_STEPS {
        if residual0.abs() <= FORCE_TOLERANCE * s1.abs() {
            return s1;
        }
        let residual1 = law(s1) - s1;
        let slope = residual1 - residual0;
        if slope == 0.0 || !slope.is_finite() {
            return s1 + residual1;
        }
        let s2 = s1 - residual1 * (s1 - s0) / slope;
        let left = residual1 * residual1;
        if left <= FORCE_TOLERANCE * (s2 * residual0).abs() {
            return s2;
        }
        (s0, residual0, s1) = (s1, residual1, s2);
    }
    s1
}
