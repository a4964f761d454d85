//! Two linear masses, and one mass with dry friction and a cubic spring, as the march itself takes them.

use std::cell::RefCell;

use faer::mat;
use simgap_effects::{Action, find};
use simgap_integrate::exact::lanes::{Batch, LANES, LaneObserver, LaneSamples, LaneSet};
use simgap_integrate::exact::{Element, ExactPropagator, Excitation};
use simgap_model::{Node, StructuralMatrices};

use crate::sets::SAMPLES;

const STEP_S: f64 = 1e-3;

/// Factor on the values of a set.
fn size(set: usize, sets: usize) -> f64 {
    1.0 + 0.05 * set as f64 / sets as f64
}

/// A propagator, what acts on it, and the coordinate that is written down.
type Set = (ExactPropagator, Vec<Element>);

/// What is called: the last output of each set.
type Call = Box<dyn Fn() -> Vec<f64>>;

pub(crate) fn linear(sets: usize) -> Call {
    let set = |k| {
        let f = size(k, sets);
        let structure = StructuralMatrices {
            mass_matrix: mat![[1.0, 0.0], [0.0, 0.5]],
            damping_matrix: mat![[2.0 * f, -0.6 * f], [-0.6 * f, 0.6 * f]],
            stiffness_matrix: mat![[1800.0 * f, -900.0 * f], [-900.0 * f, 900.0 * f]],
        };
        (ExactPropagator::new(&structure, STEP_S).unwrap(), vec![])
    };
    called((0..sets).map(set).collect(), 2)
}

pub(crate) fn friction(sets: usize) -> Call {
    let set = |k| {
        let f = size(k, sets);
        let structure = StructuralMatrices {
            mass_matrix: mat![[1.0]],
            damping_matrix: mat![[2.0 * f]],
            stiffness_matrix: mat![[900.0 * f]],
        };
        let laws = [("coulomb_friction", 1.5 * f), ("cubic_stiffness", 2e6 * f)];
        let elements = laws.map(|(kind, value)| {
            let Action::Force(law) = find(kind).unwrap().action(&[value]) else {
                unreachable!("a force");
            };
            Element::between(Node::Dof(0), Node::Ground, law)
        });
        let propagator = ExactPropagator::new(&structure, STEP_S).unwrap();
        (propagator, elements.into_iter().collect())
    };
    called((0..sets).map(set).collect(), 1)
}

/// One set alone, or all of them in lanes, under three sines on the first mass; the last displacement is written down.
fn called(sets: Vec<Set>, n: usize) -> Call {
    let wave = |k: usize| {
        let t = STEP_S * k as f64;
        12.0 * (25.0 * t).sin() + 9.0 * (33.0 * t).cos() + 3.0 * (9.0 * t).sin()
    };
    let force: Vec<f64> = (0..SAMPLES * n)
        .map(|k| if k % n == 0 { wave(k / n) } else { 0.0 })
        .collect();
    let room = RefCell::new((vec![0.0; SAMPLES], vec![[0.0; LANES]; SAMPLES]));
    Box::new(move || {
        let (alone, in_lanes) = &mut *room.borrow_mut();
        let excitation = Excitation {
            dof_force: &force,
            base_displacement: &[],
            base_velocity: &[],
            base_count: 0,
            sample_count: SAMPLES,
            start_s: 0.0,
            substeps: 1,
        };
        let still = [0.0; 2];
        let still = &still[..n];
        if let [(propagator, elements)] = &sets[..] {
            propagator.march(elements, &excitation, still, still, &mut |at| {
                alone[at.sample] = at.displacement[n - 1];
            });
            return alone.last().copied().into_iter().collect();
        }
        let lanes = sets.iter().map(|(propagator, elements)| LaneSet {
            propagator,
            elements,
            excitation,
            displacement: still,
            velocity: still,
        });
        Batch::new(lanes.collect())
            .unwrap()
            .march(&mut Written(in_lanes));
        in_lanes.last().copied().into_iter().flatten().collect()
    })
}

/// The last displacement of eight sets at every sample.
struct Written<'a>(&'a mut [[f64; LANES]]);

impl LaneObserver for Written<'_> {
    fn reads_acceleration(&self, _: usize) -> bool {
        false
    }

    fn reads_forces(&self) -> bool {
        false
    }

    #[inline(always)]
    fn observe(&mut self, samples: &LaneSamples<'_>) {
        for (k, out) in self.0[samples.first..]
            .iter_mut()
            .take(samples.count)
            .enumerate()
        {
            if let Some(last) = samples.displacement(k).last() {
                *out = last.0;
            }
        }
    }
}
