//! How large the motion is at a place.

use crate::bench::{Bench, deviation};
use crate::march::{KEPT, Run};
use crate::plant::{Node, Place};
use crate::size::Scale;

fn rms(y: &[f64]) -> f64 {
    (y.iter().map(|v| v * v).sum::<f64>() / y.len().max(1) as f64).sqrt()
}

fn slope(y: &[f64], step_s: f64) -> Vec<f64> {
    let of = |w: &[f64]| (w[2] - w[0]) / (2.0 * step_s);
    y.windows(3).map(of).collect()
}

/// One signal of a run from the beginning of the record on.
struct View<'a> {
    bench: &'a Bench,
    run: &'a Run,
    record: usize,
}

impl View<'_> {
    fn record_of(&self, values: &[f64]) -> Vec<f64> {
        values[self.bench.setups[self.record].before * KEPT..].to_vec()
    }

    fn displacement(&self, node: Node) -> Option<Vec<f64>> {
        match node {
            Node::Ground => None,
            Node::Mass(i) => Some(self.record_of(&self.run.states[i])),
            Node::Base(i) => Some(self.record_of(&self.run.inputs[i])),
        }
    }

    fn across(&self, a: Node, b: Node) -> Vec<f64> {
        match (self.displacement(a), self.displacement(b)) {
            (Some(x), Some(y)) => x.iter().zip(&y).map(|(x, y)| x - y).collect(),
            (Some(x), None) => x,
            (None, Some(y)) => y.iter().map(|v| -v).collect(),
            (None, None) => vec![0.0],
        }
    }

    /// Inertia force of a mass.
    fn inertia(&self, mass: usize, step_s: f64) -> f64 {
        let n = self.bench.plant.masses.len();
        let v = self.record_of(&self.run.states[n + mass]);
        self.bench.plant.masses[mass] * rms(&slope(&v, step_s))
    }
}

/// The scale at a place, from a run of the plant without the cause.
pub(crate) fn scale(bench: &Bench, run: &Run, record: usize, at: Place, kind: &str) -> Scale {
    let plant = &bench.plant;
    let setup = &bench.setups[record];
    let view = View { bench, run, record };
    let h = setup.step_s / KEPT as f64;
    let all = (0..plant.masses.len()).map(|i| view.inertia(i, h));
    let mut scale = Scale {
        rms: 1.0,
        range: (0.0, 0.0),
        rate: 1.0,
        force: all.fold(0.0, f64::max),
        stiffness: plant.springs.iter().map(|s| s.value).fold(0.0, f64::max),
        mass: plant.masses.iter().copied().fold(0.0, f64::max),
        duration_s: setup.samples as f64 * setup.step_s,
        step_s: setup.step_s,
        band_hz: plant.band_hz,
    };
    let mut centred = false;
    let signal = match at {
        Place::Between(a, b) => {
            let d = view.across(a, b);
            let v = slope(&d, h);
            let pairs = |list: &[crate::plant::Member]| -> f64 {
                let at_pair = list.iter().filter(|m| crate::plant::joins(m, a, b));
                at_pair.map(|m| m.value).sum()
            };
            let carried = pairs(&plant.springs) * rms(&d) + pairs(&plant.dampers) * rms(&v);
            let inertia = [a, b].into_iter().filter_map(|node| match node {
                Node::Mass(i) => Some(view.inertia(i, h)),
                _ => None,
            });
            scale.force = inertia.fold(carried, f64::max);
            scale.stiffness = plant.stiffness(a, b);
            if let Node::Mass(i) = a {
                scale.mass = plant.masses[i];
            }
            d
        }
        Place::Mass(i) => {
            scale.force = view.inertia(i, h);
            scale.mass = plant.masses[i];
            view.across(Node::Mass(i), Node::Ground)
        }
        Place::Input(i) => match (kind, plant.inputs[i].at) {
            ("foreign_fading_gain", node @ Node::Mass(_)) => view.across(node, Node::Ground),
            _ => view.record_of(&run.inputs[i]),
        },
        Place::Channel(i) => {
            centred = true;
            view.record_of(&run.outputs[i])
        }
    };
    let rate = rms(&slope(&signal, h));
    scale.rms = if centred {
        deviation(&signal)
    } else {
        rms(&signal)
    };
    scale.rate = rate;
    scale.range = signal
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, u), v| {
            (l.min(*v), u.max(*v))
        });
    scale
}
