//! One parameter set alone against 1 to 32 in lanes, 60 s at 1 kHz.
//!
//! `cargo bench -p simgap-integrate --bench lanes`; the items counted are samples times sets, so
//! that the throughput is that of one sample of one set.
#![allow(clippy::unwrap_used, missing_docs)]

use divan::counter::ItemsCount;
use simgap_integrate::exact::lanes::{Batch, LANES, LaneObserver, LaneSamples, LaneSet, Pack};
use simgap_integrate::exact::{Element, ExactPropagator, Excitation, ForceLaw, MemberMotion};
use simgap_model::{Node, StructuralMatrices};

const SAMPLES: usize = 60_000;
const STEP_S: f64 = 1e-3;
const SETS: [usize; 4] = [1, 4, 8, 32];

struct Cubic {
    factor: f64,
}

impl ForceLaw for Cubic {
    simgap_integrate::lanes!(factor);

    fn force(&self, motion: MemberMotion) -> f64 {
        self.factor * motion.displacement * motion.displacement * motion.displacement
    }
}

struct Coulomb {
    level: f64,
}

impl ForceLaw for Coulomb {
    simgap_integrate::lanes!(level);

    fn force(&self, _: MemberMotion) -> f64 {
        0.0
    }

    fn dry_level(&self, _: f64) -> Option<f64> {
        Some(self.level)
    }
}

/// What is simulated: masses, and laws between the first of them and the ground.
#[derive(Debug, Clone, Copy)]
enum Plant {
    Linear2,
    Cubic1,
    FrictionAndCubic1,
    Friction2,
    /// At the first mass, and a spring between the two.
    FrictionAndCubic2,
}

use Plant::{Cubic1, Friction2, FrictionAndCubic1, FrictionAndCubic2, Linear2};

/// A set whose values are off by some per cent.
fn set(plant: Plant, share: f64) -> (ExactPropagator, Vec<Element>) {
    let size = 1.0 + 0.05 * share;
    let structure = match plant {
        Cubic1 | FrictionAndCubic1 => StructuralMatrices {
            mass_matrix: faer::mat![[1.0]],
            damping_matrix: faer::mat![[2.0 * size]],
            stiffness_matrix: faer::mat![[900.0 * size]],
        },
        Linear2 | Friction2 | FrictionAndCubic2 => StructuralMatrices {
            mass_matrix: faer::mat![[1.0, 0.0], [0.0, 0.5]],
            damping_matrix: faer::mat![[2.0, -0.6], [-0.6, 0.9 * size]],
            stiffness_matrix: faer::mat![[1800.0, -900.0], [-900.0, 1200.0 * size]],
        },
    };
    let element = |law: Box<dyn ForceLaw>| Element::between(Node::Dof(0), Node::Ground, law);
    let cubic = || element(Box::new(Cubic { factor: 2e6 * size }));
    let friction = || element(Box::new(Coulomb { level: 1.5 * size }));
    let elements = match plant {
        Linear2 => vec![],
        Cubic1 => vec![cubic()],
        FrictionAndCubic1 => vec![friction(), cubic()],
        Friction2 => vec![friction()],
        FrictionAndCubic2 => {
            let factor = 2e6 * size;
            let spring = Box::new(Cubic { factor });
            vec![
                friction(),
                Element::between(Node::Dof(0), Node::Dof(1), spring),
            ]
        }
    };
    (ExactPropagator::new(&structure, STEP_S).unwrap(), elements)
}

fn dof_count(plant: Plant) -> usize {
    match plant {
        Cubic1 | FrictionAndCubic1 => 1,
        Linear2 | Friction2 | FrictionAndCubic2 => 2,
    }
}

fn force(n: usize) -> Vec<f64> {
    (0..SAMPLES * n)
        .map(|k| {
            let t = STEP_S * (k / n) as f64;
            12.0 * (25.0 * t).sin() + 9.0 * (33.0 * t).cos() + 3.0 * (9.0 * t).sin()
        })
        .collect()
}

fn excitation(force: &[f64]) -> Excitation<'_> {
    Excitation {
        dof_force: force,
        base_displacement: &[],
        base_velocity: &[],
        base_count: 0,
        sample_count: SAMPLES,
        start_s: 0.0,
        substeps: 1,
    }
}

/// Sums the first displacement of every set: to write it down would be timed too.
struct Sums(Vec<Pack>);

impl LaneObserver for Sums {
    fn reads_acceleration(&self, _: usize) -> bool {
        false
    }

    fn reads_forces(&self) -> bool {
        false
    }

    #[inline(always)]
    fn observe(&mut self, samples: &LaneSamples<'_>) {
        let sum = &mut self.0[samples.first_set / LANES];
        for k in 0..samples.count {
            for (sum, value) in sum.0.iter_mut().zip(&samples.displacement(k)[0].0) {
                *sum += value;
            }
        }
    }
}

#[divan::bench(args = [Linear2, Cubic1, FrictionAndCubic1, Friction2, FrictionAndCubic2], sample_count = 10)]
fn alone(bencher: divan::Bencher<'_, '_>, plant: Plant) {
    let n = dof_count(plant);
    let force = force(n);
    let (propagator, elements) = set(plant, 0.0);
    let still = [0.0; 2];
    bencher.counter(ItemsCount::new(SAMPLES)).bench_local(|| {
        let mut sum = 0.0;
        let excitation = excitation(&force);
        propagator.march(
            &elements,
            &excitation,
            &still[..n],
            &still[..n],
            &mut |at| {
                sum += at.displacement[0];
            },
        );
        sum
    });
}

#[divan::bench(args = [Linear2, Cubic1, FrictionAndCubic1, Friction2, FrictionAndCubic2], consts = SETS, sample_count = 10)]
fn in_lanes<const SETS: usize>(bencher: divan::Bencher<'_, '_>, plant: Plant) {
    let n = dof_count(plant);
    let force = force(n);
    let sets: Vec<_> = (0..SETS)
        .map(|k| set(plant, k as f64 / SETS as f64))
        .collect();
    let still = [0.0; 2];
    bencher
        .counter(ItemsCount::new(SAMPLES * SETS))
        .bench_local(|| {
            let lanes = sets.iter().map(|(propagator, elements)| LaneSet {
                propagator,
                elements,
                excitation: excitation(&force),
                displacement: &still[..n],
                velocity: &still[..n],
            });
            let mut sums = Sums(vec![Pack::ZERO; SETS.div_ceil(LANES)]);
            Batch::new(lanes.collect()).unwrap().march(&mut sums);
            sums.0
        });
}

fn main() {
    divan::main();
}
