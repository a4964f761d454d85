//! Runge-Kutta 4 with events of dry friction.

use crate::machine::{Drive, Dry, Machine, Mode, Now};

/// Readings kept per sample.
pub const KEPT: usize = 4;
/// Switches of the friction within one substep, at the most.
const SWITCHES: usize = 6;
/// Halvings of the place of a switch.
const HALVINGS: usize = 40;

/// What a run left: per channel, and the recorded inputs, on a grid of [`KEPT`] per sample.
#[derive(Debug, Clone)]
pub struct Run {
    /// Readings in SI.
    pub outputs: Vec<Vec<f64>>,
    /// Inputs as the recorder sees them, SI.
    pub inputs: Vec<Vec<f64>>,
    /// Time of the first value, in samples.
    pub start: f64,
    /// Displacements and velocities at the samples of the grid, state by state.
    pub states: Vec<Vec<f64>>,
}

/// From when to when, and how finely.
#[derive(Debug, Clone, Copy)]
pub struct Span {
    /// Samples before the record.
    pub before: usize,
    /// Samples of the record.
    pub samples: usize,
    /// s.
    pub step_s: f64,
    /// Substeps per sample, a multiple of [`KEPT`].
    pub substeps: usize,
}

struct March<'a> {
    machine: &'a Machine,
    drives: &'a [Drive],
    step_s: f64,
    side: f64,
    mode: Mode,
    now: Now,
    force: Vec<f64>,
    k: [Vec<f64>; 4],
    trial: Vec<f64>,
}

impl March<'_> {
    fn rates_into(&mut self, x: &[f64], time: f64, stage: usize) -> (f64, f64) {
        let (machine, drives) = (self.machine, self.drives);
        machine.look(drives, time, self.side, self.step_s, &mut self.now);
        let mut rates = std::mem::take(&mut self.k[stage]);
        let held = machine.rates(x, &self.now, self.mode, &mut self.force, &mut rates);
        self.k[stage] = rates;
        held
    }

    /// One step of classical Runge-Kutta, h in samples.
    fn step(&mut self, x: &[f64], time: f64, h: f64, out: &mut [f64]) {
        let dt = h * self.step_s;
        self.rates_into(x, time, 0);
        for (stage, share) in [(1, 0.5), (2, 0.5), (3, 1.0)] {
            let mut trial = std::mem::take(&mut self.trial);
            for i in 0..x.len() {
                trial[i] = x[i] + share * dt * self.k[stage - 1][i];
            }
            self.rates_into(&trial, time + share * h, stage);
            self.trial = trial;
        }
        for i in 0..x.len() {
            let sum = self.k[0][i] + 2.0 * (self.k[1][i] + self.k[2][i]) + self.k[3][i];
            out[i] = x[i] + dt / 6.0 * sum;
        }
    }

    /// Below zero once the mode of the friction has ended.
    fn margin(&mut self, dry: &Dry, x: &[f64], time: f64) -> f64 {
        match self.mode {
            Mode::Slip(s) => {
                let (machine, drives) = (self.machine, self.drives);
                machine.look(drives, time, self.side, self.step_s, &mut self.now);
                s * machine.across(dry.a, dry.b, x, &self.now).1
            }
            Mode::Stick => dry.rest - self.rates_into(x, time, 0).1.abs(),
        }
    }

    /// The mode that follows at a switch.
    fn switch(&mut self, dry: &Dry, x: &mut [f64], time: f64) {
        if matches!(self.mode, Mode::Slip(_)) {
            self.mode = Mode::Stick;
        }
        let held = self.rates_into(x, time, 0).1;
        if held.abs() >= dry.rest {
            self.mode = Mode::Slip(held.signum());
        }
    }

    /// A substep in which the friction may stick and break away.
    fn advance(&mut self, x: &mut Vec<f64>, next: &mut Vec<f64>, time: f64, h: f64) {
        let has_mass = |dry: &Dry| {
            let moved = |node| matches!(node, crate::plant::Node::Mass(_));
            moved(dry.a) || moved(dry.b)
        };
        let Some(dry) = self.machine.dry.filter(has_mass) else {
            self.step(x, time, h, next);
            std::mem::swap(x, next);
            return;
        };
        let (mut at, end) = (time, time + h);
        for _ in 0..SWITCHES {
            self.step(x, at, end - at, next);
            if self.margin(&dry, next, end) >= 0.0 {
                std::mem::swap(x, next);
                return;
            }
            let (mut low, mut high) = (0.0, end - at);
            for _ in 0..HALVINGS {
                let middle = 0.5 * (low + high);
                self.step(x, at, middle, next);
                if self.margin(&dry, next, at + middle) >= 0.0 {
                    low = middle;
                } else {
                    high = middle;
                }
            }
            self.step(x, at, high, next);
            std::mem::swap(x, next);
            at += high;
            self.switch(&dry, x, at);
            if end - at < 1e-12 {
                return;
            }
        }
        self.step(x, at, end - at, next);
        std::mem::swap(x, next);
    }
}

/// Marches a machine from a state at the beginning of the span.
#[must_use]
pub fn march(machine: &Machine, drives: &[Drive], first: &[f64], span: Span) -> Run {
    let states = machine.states();
    let mut x = first.to_vec();
    x.resize(states, 0.0);
    let mut next = vec![0.0; states];
    let mut march = March {
        machine,
        drives,
        step_s: span.step_s,
        side: 0.0,
        mode: Mode::Stick,
        now: Now::default(),
        force: vec![0.0; machine.dof()],
        k: std::array::from_fn(|_| vec![0.0; states]),
        trial: vec![0.0; states],
    };
    let start = -(span.before as f64);
    march.side = start;
    if let Some(dry) = &machine.dry {
        machine.look(drives, start, start, span.step_s, &mut march.now);
        let v = machine.across(dry.a, dry.b, &x, &march.now).1;
        if v == 0.0 {
            march.switch(dry, &mut x, start);
        } else {
            march.mode = Mode::Slip(v.signum());
        }
    }
    let count = (span.before + span.samples - 1) * KEPT + 1;
    let mut run = Run {
        outputs: vec![Vec::with_capacity(count); machine.outputs.len()],
        inputs: vec![Vec::with_capacity(count); machine.input_at.len()],
        start,
        states: vec![Vec::with_capacity(count); 2 * machine.dof()],
    };
    let inner = span.substeps / KEPT;
    let h = 1.0 / span.substeps as f64;
    for kept in 0..count {
        let time = start + kept as f64 / KEPT as f64;
        march.side = time;
        let friction = march.rates_into(&x, time, 0).0;
        keep(&march, &x, time, friction, &mut run);
        if kept + 1 < count {
            for part in 0..inner {
                let at = time + part as f64 * h;
                march.side = at;
                march.advance(&mut x, &mut next, at, h);
            }
        }
    }
    run
}

fn keep(march: &March<'_>, x: &[f64], time: f64, friction: f64, run: &mut Run) {
    let machine = march.machine;
    let readings = machine.read(x, &march.now, &march.k[0], friction);
    for (list, value) in run.outputs.iter_mut().zip(readings) {
        list.push(value);
    }
    for (i, list) in run.inputs.iter_mut().enumerate() {
        list.push(match machine.control {
            Some(_) if i == 0 => machine.input_value(i, x, &march.now),
            _ => march.drives[i].sent.at(time, time),
        });
    }
    for (list, value) in run.states.iter_mut().zip(x) {
        list.push(*value);
    }
}
