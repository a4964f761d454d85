//! A plant with its runs: simulation, and the gap that effects leave.

use std::f64::consts::PI;

use crate::effect::{Assembly, Effect, assemble, bare};
use crate::excite::{FINE, Frame, Shape, excitation};
use crate::grid::Grid;
use crate::machine::Drive;
use crate::march::{KEPT, Run, Span, march};
use crate::plant::{Node, Plant, Quantity};
use crate::rng::Rng;

/// What is done to the machine in one record.
#[derive(Debug, Clone)]
pub struct Setup {
    /// Excitation of every input, SI.
    pub sources: Vec<Grid>,
    /// Kind of excitation.
    pub shape: Option<Shape>,
    /// Displacements at the beginning.
    pub displaced: Vec<f64>,
    /// Samples before the record.
    pub before: usize,
    /// Samples.
    pub samples: usize,
    /// s.
    pub step_s: f64,
    /// Whether the machine is at rest when the record begins.
    pub from_rest: bool,
}

/// Draws what is done in a record.
#[must_use]
pub fn draw_setup(
    plant: &Plant,
    shapes: &[Shape],
    step_s: f64,
    samples: usize,
    rng: &mut Rng,
) -> Setup {
    let factor = rng.log_uniform(0.6, 1.5);
    let before = (samples / 8).max(100);
    let from_rest = rng.chance(0.65);
    let frame = Frame {
        before,
        samples,
        step_s,
        band_hz: plant.band_hz,
        from_rest,
    };
    let shape = (!plant.inputs.is_empty()).then(|| *rng.pick(shapes));
    let mut sources = Vec::new();
    if let Some(shape) = shape {
        for _ in &plant.inputs {
            let mut grid = excitation(shape, rng, &frame);
            grid.values
                .iter_mut()
                .for_each(|v| *v *= factor * plant.drive);
            sources.push(grid);
        }
    }
    let free = plant.inputs.is_empty();
    let displaced = (0..plant.masses.len()).map(|_| match free {
        true => factor * plant.drive * rng.sign() * rng.uniform(0.4, 1.6),
        false => 0.0,
    });
    Setup {
        displaced: displaced.collect(),
        sources,
        shape,
        before,
        samples,
        step_s,
        from_rest: from_rest && !free,
    }
}

/// Shapes that suit a plant.
#[must_use]
pub fn shapes_for(plant: &Plant, held: bool) -> Vec<Shape> {
    use Shape::{Chirp, HeldPrbs, Impacts, Multisine, Noise, Prbs, Sines, Steps, Trapezoids};
    let mut list = match plant.family {
        "shear_frame" | "quarter_car" | "isolator" => {
            vec![Noise, Noise, Chirp, Multisine, Sines, Impacts, Steps]
        }
        "massless_stand" => vec![Noise, Chirp, Multisine, Sines, Trapezoids],
        "closed_axis" => vec![Trapezoids, Trapezoids, Multisine, Sines, Steps],
        "test_stand" => vec![Impacts, Chirp, Noise, Prbs, Multisine, Steps, Sines],
        _ => vec![Trapezoids, Chirp, Prbs, Multisine, Steps, Sines, Noise],
    };
    if held {
        list.retain(|s| *s != Prbs);
        list.push(HeldPrbs);
    }
    list
}

/// A plant, what it is without the cause, and its records.
#[derive(Debug, Clone)]
pub struct Bench {
    /// The true plant.
    pub plant: Plant,
    /// The true plant without the cause.
    pub without: Plant,
    /// What is done.
    pub setups: Vec<Setup>,
}

/// Drives of a machine: the sources through the paths of an assembly.
fn drives(assembly: &mut Assembly, plant: &Plant, setup: &Setup) -> Vec<Drive> {
    let mut list = Vec::new();
    for (i, source) in setup.sources.iter().enumerate() {
        let path = assembly.paths[i];
        let mut grid = source.clone();
        if path.lag_s > 0.0 {
            grid = grid.lagged(path.lag_s, setup.step_s);
        }
        if path.swing.0 > 0.0 {
            let moved = |k: usize| {
                let t = grid.start + k as f64 / grid.per;
                let swing = path.swing.0 * (2.0 * PI * path.swing.1 * t * setup.step_s).sin();
                grid.smooth(t - (path.delay_s + swing) / setup.step_s)
            };
            grid.values = (0..grid.values.len()).map(moved).collect();
        } else {
            grid.start += path.delay_s / setup.step_s;
        }
        let moving = matches!(plant.inputs[i].at, Node::Base(_));
        if moving {
            grid.values.iter_mut().for_each(|v| *v *= path.gain);
        } else {
            assembly.machine.gains[i] = path.gain;
        }
        let wanted = moving || plant.control.is_some();
        let rate = wanted.then(|| grid.rate(setup.step_s));
        let second = rate.as_ref().map(|rate| rate.rate(setup.step_s));
        list.push(Drive {
            sent: source.clone(),
            value: grid,
            rate,
            second,
        });
    }
    list
}

fn first_state(assembly: &Assembly, setup: &Setup) -> Vec<f64> {
    let machine = &assembly.machine;
    let mut x = vec![0.0; machine.states()];
    let free = setup.sources.is_empty();
    if free {
        x[..setup.displaced.len()].copy_from_slice(&setup.displaced);
        // A hidden mass rides along.
        for i in setup.displaced.len()..machine.dof() {
            let host = machine.springs.iter().find_map(|s| match *s {
                (Node::Mass(h), Node::Mass(j), _) if h == i => Some(j),
                _ => None,
            });
            x[i] = host.map_or(0.0, |j| x[j]);
        }
        return x;
    }
    if !machine.constant.is_empty() {
        let n = machine.dof();
        if let Some(rest) = crate::linear::rest(machine) {
            x[..n].copy_from_slice(&rest);
        }
    }
    x
}

impl Bench {
    fn span(&self, record: usize, substeps: usize) -> Span {
        let setup = &self.setups[record];
        Span {
            before: setup.before,
            samples: setup.samples,
            step_s: setup.step_s,
            substeps,
        }
    }

    /// Simulates a record; `None` where the motion runs away.
    #[must_use]
    pub fn run(
        &self,
        plant: &Plant,
        effects: &[Effect],
        record: usize,
        substeps: usize,
    ) -> Option<(Assembly, Run)> {
        let setup = &self.setups[record];
        let mut assembly = assemble(plant, effects, record);
        let drives = drives(&mut assembly, plant, setup);
        let first = first_state(&assembly, setup);
        let run = march(
            &assembly.machine,
            &drives,
            &first,
            self.span(record, substeps),
        );
        let fine = run
            .outputs
            .iter()
            .flatten()
            .all(|v| v.is_finite() && v.abs() < 1e9);
        fine.then_some((assembly, run))
    }

    /// The plant without the cause in open loop, driven by what was recorded.
    #[must_use]
    pub fn run_open(&self, record: usize, recorded: &Run) -> Run {
        let setup = &self.setups[record];
        let mut plant = self.without.clone();
        let mut setup = setup.clone();
        if plant.control.take().is_some() {
            for (source, values) in setup.sources.iter_mut().zip(&recorded.inputs) {
                *source = Grid {
                    values: values.clone(),
                    start: recorded.start,
                    per: KEPT as f64,
                    hold: false,
                };
            }
        }
        let mut assembly = bare(&plant);
        let drives = drives(&mut assembly, &plant, &setup);
        let first = first_state(&assembly, &setup);
        march(&assembly.machine, &drives, &first, self.span(record, 8))
    }

    /// The linear plant without the cause and its inputs, and drives that stand still.
    fn quiet(&self, record: usize) -> (Assembly, Vec<Drive>) {
        let mut plant = self.without.clone();
        plant.control = None;
        let mut assembly = bare(&plant);
        let machine = &mut assembly.machine;
        for (mass, value) in std::mem::take(&mut machine.pendulum) {
            machine
                .springs
                .push((Node::Mass(mass), Node::Ground, value));
        }
        let setup = &self.setups[record];
        let still = |grid: &Grid| Grid {
            values: vec![0.0; 2 * FINE],
            ..grid.clone()
        };
        let quiet = Setup {
            sources: setup.sources.iter().map(still).collect(),
            ..setup.clone()
        };
        let drives = drives(&mut assembly, &plant, &quiet);
        (assembly, drives)
    }

    /// Readings of the quiet plant from a first state under constant forces, all channels in a row.
    #[must_use]
    pub fn quiet_response(
        &self,
        record: usize,
        first: &[f64],
        constant: &[(usize, f64)],
    ) -> Vec<f64> {
        let (mut assembly, drives) = self.quiet(record);
        assembly.machine.constant = constant.to_vec();
        let span = Span {
            before: 0,
            ..self.span(record, 8)
        };
        let run = march(&assembly.machine, &drives, first, span);
        let at_samples = |c: &Vec<f64>| c.iter().step_by(KEPT).copied().collect::<Vec<_>>();
        run.outputs.iter().flat_map(at_samples).collect()
    }

    /// Readings that each first state of the linear plant leaves.
    #[must_use]
    pub fn free_responses(&self, record: usize) -> Vec<Vec<f64>> {
        let states = 2 * self.without.masses.len();
        let unit = |i: usize| {
            let mut x = vec![0.0; states];
            x[i] = 1.0;
            x
        };
        (0..states)
            .map(|i| self.quiet_response(record, &unit(i), &[]))
            .collect()
    }

    /// Samples of all channels, without noise.
    #[must_use]
    pub fn samples(&self, assembly: &Assembly, run: &Run, record: usize) -> Vec<Vec<f64>> {
        self.noisy(assembly, run, record, &[])
    }

    /// Samples of all channels with given noise.
    #[must_use]
    pub fn noisy(
        &self,
        assembly: &Assembly,
        run: &Run,
        record: usize,
        noise: &[Vec<f64>],
    ) -> Vec<Vec<f64>> {
        let setup = &self.setups[record];
        let channels = run.outputs.iter().zip(&assembly.chains).enumerate();
        channels
            .map(|(c, (values, chain))| {
                let grid = Grid {
                    values: values.clone(),
                    start: run.start,
                    per: KEPT as f64,
                    hold: false,
                };
                let mut rng = Rng::new(&format!("strikes/{record}/{c}/{}", setup.samples));
                let noise = noise.get(c).map_or(&[][..], Vec::as_slice);
                chain.sample(&grid, setup.samples, setup.step_s, noise, &mut rng)
            })
            .collect()
    }

    /// The gap of each channel, as a share of the deviation of what is measured: what the plant
    /// without the cause, from its best first state, leaves of the record.
    #[must_use]
    pub fn gap(&self, effects: &[Effect], record: usize, free: &[Vec<f64>]) -> Option<Vec<f64>> {
        let (assembly, run) = self.run(&self.plant, effects, record, 8)?;
        let with = self.samples(&assembly, &run, record);
        let open = self.run_open(record, &run);
        let plain = self.samples(&bare(&self.without), &open, record);
        let spread: Vec<f64> = with.iter().map(|y| deviation(y)).collect();
        if spread.iter().any(|s| !(s.is_finite() && *s > 0.0)) {
            return None;
        }
        let n = self.setups[record].samples;
        let scaled = |list: &[f64]| -> Vec<f64> {
            let parts = list.iter().enumerate();
            parts.map(|(i, v)| v / spread[i / n]).collect()
        };
        let difference: Vec<f64> = with
            .iter()
            .flatten()
            .zip(plain.iter().flatten())
            .map(|(a, b)| a - b)
            .collect();
        let basis: Vec<Vec<f64>> = free.iter().map(|f| scaled(f)).collect();
        let left = crate::linear::remainder(&basis, scaled(&difference));
        Some(
            left.chunks(n)
                .map(|c| (c.iter().map(|v| v * v).sum::<f64>() / n as f64).sqrt())
                .collect(),
        )
    }

    /// Substeps at which halving them changes no output by a tenth of its noise; `None` where
    /// they would be too many.
    #[must_use]
    pub fn substeps(&self, effects: &[Effect], record: usize, noise: &[f64]) -> Option<usize> {
        let mut steps = 4;
        let mut last = self.run(&self.plant, effects, record, steps)?.1;
        while steps < 256 {
            steps *= 2;
            let next = self.run(&self.plant, effects, record, steps)?.1;
            let close = (0..noise.len()).all(|c| {
                let pairs = last.outputs[c].iter().zip(&next.outputs[c]);
                let square = pairs.map(|(a, b)| (a - b).powi(2)).sum::<f64>();
                (square / next.outputs[c].len() as f64).sqrt() < 0.1 * noise[c]
            });
            if close {
                return Some(steps);
            }
            last = next;
        }
        None
    }
}

/// Standard deviation.
#[must_use]
pub fn deviation(y: &[f64]) -> f64 {
    let n = y.len() as f64;
    let mean = y.iter().sum::<f64>() / n;
    (y.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / n).sqrt()
}

/// Whether a plant measures a force only.
#[must_use]
pub fn measures_force(plant: &Plant) -> bool {
    plant.outputs.iter().all(|o| o.quantity == Quantity::Force)
}
