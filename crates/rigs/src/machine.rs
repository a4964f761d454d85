//! The true machine: equations of motion of any plant with its effects.

use std::f64::consts::PI;

use crate::grid::Grid;
use crate::law::Law;
use crate::plant::{Control, Node, Output, Quantity, same_pair};

/// A law between two nodes.
#[derive(Debug, Clone)]
pub struct LawAt {
    /// First node.
    pub a: Node,
    /// Second node.
    pub b: Node,
    /// The law.
    pub law: Law,
}

/// Dry friction between two nodes: sliding level, level at rest, Stribeck speed.
#[derive(Debug, Clone, Copy)]
pub struct Dry {
    /// First node.
    pub a: Node,
    /// Second node.
    pub b: Node,
    /// Level while sliding fast.
    pub sliding: f64,
    /// Level at rest.
    pub rest: f64,
    /// Stribeck speed.
    pub speed: f64,
}

impl Dry {
    /// The level at a speed.
    #[must_use]
    pub fn level(&self, v: f64) -> f64 {
        if self.rest == self.sliding {
            return self.sliding;
        }
        self.sliding + (self.rest - self.sliding) * (-(v / self.speed).powi(2)).exp()
    }
}

/// How the dry friction stands.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Mode {
    /// Sliding in a direction.
    Slip(f64),
    /// At rest.
    Stick,
}

/// What drives one input: a force, or the motion of a base with its two derivatives.
#[derive(Debug, Clone)]
pub struct Drive {
    /// What was sent, before any path has delayed or scaled it: what a recorder sees.
    pub sent: Grid,
    /// Force, displacement, or the reference of a controller.
    pub value: Grid,
    /// Its rate; for forces empty.
    pub rate: Option<Grid>,
    /// Its second rate; for forces empty.
    pub second: Option<Grid>,
}

/// A machine ready to be marched.
#[derive(Debug, Clone, Default)]
pub struct Machine {
    /// Masses, hidden ones included.
    pub masses: Vec<f64>,
    /// Springs.
    pub springs: Vec<(Node, Node, f64)>,
    /// Dampers.
    pub dampers: Vec<(Node, Node, f64)>,
    /// Gravity on arms.
    pub pendulum: Vec<(usize, f64)>,
    /// Constant forces.
    pub constant: Vec<(usize, f64)>,
    /// Harmonic forces: mass, amplitude, frequency, phase.
    pub tones: Vec<(usize, f64, f64, f64)>,
    /// Further laws.
    pub laws: Vec<LawAt>,
    /// Dry friction.
    pub dry: Option<Dry>,
    /// Where each input acts.
    pub input_at: Vec<Node>,
    /// Factor on each force input, on top of its signal.
    pub gains: Vec<f64>,
    /// Foreign: the force input falls off with the speed of its mass, 1/(1 + (v/v0)²).
    pub fading: Option<f64>,
    /// The controller.
    pub control: Option<Control>,
    /// Sensors.
    pub outputs: Vec<Output>,
}

/// Motion of all bases and forces of all inputs at one time.
#[derive(Debug, Default, Clone)]
pub(crate) struct Now {
    pub(crate) time_s: f64,
    value: Vec<f64>,
    rate: Vec<f64>,
    second: Vec<f64>,
}

impl Machine {
    /// Number of masses.
    #[must_use]
    pub fn dof(&self) -> usize {
        self.masses.len()
    }

    /// Number of states: displacements, velocities, states of the laws.
    #[must_use]
    pub fn states(&self) -> usize {
        2 * self.dof() + self.laws.len()
    }

    pub(crate) fn look(&self, drives: &[Drive], time: f64, side: f64, step_s: f64, now: &mut Now) {
        now.time_s = time * step_s;
        now.value.clear();
        now.rate.clear();
        now.second.clear();
        for drive in drives {
            let of = |grid: &Option<Grid>| grid.as_ref().map_or(0.0, |g| g.at(time, side));
            now.value.push(drive.value.at(time, side));
            now.rate.push(of(&drive.rate));
            now.second.push(of(&drive.second));
        }
    }

    /// Force or displacement that input `i` sends: its signal, or what the controller makes of it.
    pub(crate) fn input_value(&self, i: usize, x: &[f64], now: &Now) -> f64 {
        match self.control {
            Some(c) if i == 0 => {
                let v = x[self.dof() + c.mass];
                c.kp * (now.value[0] - x[c.mass]) + c.kd * (now.rate[0] - v)
            }
            _ => now.value[i],
        }
    }

    fn motion(&self, node: Node, x: &[f64], now: &Now) -> (f64, f64) {
        match node {
            Node::Ground => (0.0, 0.0),
            Node::Mass(i) => (x[i], x[self.dof() + i]),
            Node::Base(i) => (now.value[i], now.rate[i]),
        }
    }

    pub(crate) fn across(&self, a: Node, b: Node, x: &[f64], now: &Now) -> (f64, f64) {
        let (p, q) = (self.motion(a, x, now), self.motion(b, x, now));
        (p.0 - q.0, p.1 - q.1)
    }

    /// Forces on the masses without dry friction, into `force`.
    fn forces(&self, x: &[f64], now: &Now, force: &mut [f64]) {
        force.fill(0.0);
        for &(mass, value) in &self.constant {
            force[mass] += value;
        }
        for &(mass, value) in &self.pendulum {
            force[mass] -= value * x[mass].sin();
        }
        for &(mass, amplitude, frequency, phase) in &self.tones {
            force[mass] += amplitude * (2.0 * PI * frequency * now.time_s + phase).sin();
        }
        for (i, &at) in self.input_at.iter().enumerate() {
            if let Node::Mass(mass) = at {
                let fading = self.fading.map_or(1.0, |speed| {
                    1.0 / (1.0 + (x[self.dof() + mass] / speed).powi(2))
                });
                force[mass] += fading * self.gains[i] * self.input_value(i, x, now);
            }
        }
        let mut put = |a: Node, b: Node, f: f64| {
            if let Node::Mass(i) = a {
                force[i] -= f;
            }
            if let Node::Mass(i) = b {
                force[i] += f;
            }
        };
        for &(a, b, k) in &self.springs {
            put(a, b, k * self.across(a, b, x, now).0);
        }
        for &(a, b, c) in &self.dampers {
            put(a, b, c * self.across(a, b, x, now).1);
        }
        for (i, law) in self.laws.iter().enumerate() {
            let (d, v) = self.across(law.a, law.b, x, now);
            let z = x[2 * self.dof() + i];
            put(law.a, law.b, law.law.force(d, v, now.time_s, z));
        }
    }

    /// The friction force that keeps its two nodes together, given the other forces.
    pub(crate) fn holding(&self, dry: &Dry, force: &[f64], now: &Now) -> Option<f64> {
        let part = |node: Node| match node {
            Node::Ground => (0.0, 0.0),
            Node::Base(i) => (now.second[i], 0.0),
            Node::Mass(i) => (force[i] / self.masses[i], 1.0 / self.masses[i]),
        };
        let (p, q) = (part(dry.a), part(dry.b));
        let mobility = p.1 + q.1;
        (mobility > 0.0).then(|| (p.0 - q.0) / mobility)
    }

    /// Friction in a mode.
    fn friction(&self, dry: &Dry, mode: Mode, x: &[f64], now: &Now, force: &[f64]) -> f64 {
        let v = self.across(dry.a, dry.b, x, now).1;
        match (mode, self.holding(dry, force, now)) {
            (Mode::Slip(s), Some(_)) => s * dry.level(v),
            (Mode::Stick, Some(held)) => held,
            (_, None) if v == 0.0 => 0.0,
            (_, None) => v.signum() * dry.level(v),
        }
    }

    /// Rates of the states; returns what the friction carries and what would hold it.
    pub(crate) fn rates(
        &self,
        x: &[f64],
        now: &Now,
        mode: Mode,
        force: &mut [f64],
        out: &mut [f64],
    ) -> (f64, f64) {
        let n = self.dof();
        self.forces(x, now, force);
        let mut carried = (0.0, 0.0);
        if let Some(dry) = &self.dry {
            let f = self.friction(dry, mode, x, now, force);
            carried = (f, self.holding(dry, force, now).unwrap_or(0.0));
            if let Node::Mass(i) = dry.a {
                force[i] -= f;
            }
            if let Node::Mass(i) = dry.b {
                force[i] += f;
            }
        }
        for i in 0..n {
            out[i] = x[n + i];
            out[n + i] = force[i] / self.masses[i];
        }
        for (i, law) in self.laws.iter().enumerate() {
            let (d, v) = self.across(law.a, law.b, x, now);
            out[2 * n + i] = law.law.state_rate(d, v, x[2 * n + i]);
        }
        carried
    }

    /// Readings of the sensors, SI, given the rates of [`Machine::rates`].
    pub(crate) fn read(&self, x: &[f64], now: &Now, rates: &[f64], friction: f64) -> Vec<f64> {
        let n = self.dof();
        let of = |output: &Output| match (output.quantity, output.a) {
            (Quantity::Force, _) => self.carried(output.a, output.b, x, now, friction),
            (Quantity::Displacement, node) => self.motion(node, x, now).0,
            (Quantity::Velocity, node) => self.motion(node, x, now).1,
            (Quantity::Acceleration, Node::Mass(i)) => rates[n + i],
            (Quantity::Acceleration, Node::Base(i)) => now.second[i],
            (Quantity::Acceleration, Node::Ground) => 0.0,
        };
        self.outputs.iter().map(of).collect()
    }

    /// What the members between two nodes carry.
    fn carried(&self, a: Node, b: Node, x: &[f64], now: &Now, friction: f64) -> f64 {
        let way = |p: Node, q: Node| match ((p, q) == (a, b), same_pair((p, q), (a, b))) {
            (true, _) => 1.0,
            (false, true) => -1.0,
            _ => 0.0,
        };
        let mut sum = 0.0;
        for &(p, q, k) in &self.springs {
            sum += way(p, q) * k * self.across(p, q, x, now).0;
        }
        for &(p, q, c) in &self.dampers {
            sum += way(p, q) * c * self.across(p, q, x, now).1;
        }
        for (i, law) in self.laws.iter().enumerate() {
            let (d, v) = self.across(law.a, law.b, x, now);
            let z = x[2 * self.dof() + i];
            sum += way(law.a, law.b) * law.law.force(d, v, now.time_s, z);
        }
        match &self.dry {
            Some(dry) => sum + way(dry.a, dry.b) * friction,
            None => sum,
        }
    }
}
