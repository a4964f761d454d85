//! Eight sets within the march.

use pulp::{Arch, Simd};
use simgap_model::Node;

use super::arithmetic::{add, add_product, either, mul, sub};
use super::batch::LaneSet;
use super::kernel::LaneKernel;
use super::law::{ElementLanes, LaneLaw, OneByOne};
use super::{LANES, Mask, Pack};
use crate::exact::law::ForceLaw;
use crate::exact::plant::{Plant, SWEEPS};

/// Eight sets of one structure, in the lanes of every number.
pub(super) struct Block<'a> {
    arch: Arch,
    pub(super) kernel: LaneKernel,
    nodes: Vec<[Node; 2]>,
    laws: Vec<Box<dyn LaneLaw + 'a>>,
    pub(super) elements: Vec<ElementLanes>,
    /// How the forces of element j move element i, row-major, as in the march of one set.
    compliance: [Vec<Pack>; 4],
    sweeps: usize,
    any_dry: bool,
    any_memory: bool,
    pub(super) state: Vec<Pack>,
    next: Vec<Pack>,
    /// Forces on the degrees of freedom at the two ends of a step.
    pub(super) before: Vec<Pack>,
    pub(super) after: Vec<Pack>,
    pub(super) net: Vec<Pack>,
    /// Displacements, then velocities of the bases at the end of a step.
    pub(super) base: Vec<Pack>,
    free: Vec<[Pack; 2]>,
    step_s: Pack,
    start_s: Pack,
}

/// Value at a node.
#[inline(always)]
fn at(node: Node, values: &[Pack], bases: &[Pack]) -> Pack {
    match node {
        Node::Ground => Pack::ZERO,
        Node::Dof(i) => values[i],
        Node::Base(i) => bases[i],
    }
}

#[inline(always)]
fn across<S: Simd>(simd: S, [a, b]: [Node; 2], values: &[Pack], bases: &[Pack]) -> Pack {
    sub(simd, &at(a, values, bases), &at(b, values, bases))
}

/// Adds what a force between two nodes does to the degrees of freedom.
#[inline(always)]
fn spread<S: Simd>(simd: S, [a, b]: [Node; 2], force: &Pack, dof_force: &mut [Pack]) {
    if let Node::Dof(i) = a {
        dof_force[i] = sub(simd, &dof_force[i], force);
    }
    if let Node::Dof(i) = b {
        dof_force[i] = add(simd, &dof_force[i], force);
    }
}

/// `value − (a b + c d)`.
#[inline(always)]
fn less_products<S: Simd>(simd: S, value: &Pack, first: [&Pack; 2], second: [&Pack; 2]) -> Pack {
    let products = add_product(simd, &mul(simd, first[0], first[1]), second[0], second[1]);
    sub(simd, value, &products)
}

impl<'a> Block<'a> {
    /// The sets at their first sample.
    pub(super) fn new(arch: Arch, sets: &[&LaneSet<'a>; LANES]) -> Block<'a> {
        let n = sets[0].propagator.dof_count;
        let m = sets[0].elements.len();
        let bases = sets[0].excitation.base_count;
        let plants = sets.map(LaneSet::begin);
        let of_plants = |value: &dyn Fn(&Plant<'_>) -> f64| Pack::of(|l| value(&plants[l]));
        let fold = |part: usize| -> Vec<Pack> {
            let entry = |k: usize| of_plants(&|p| p.compliance.parts()[part][k]);
            (0..m * m).map(entry).collect()
        };
        let compliance = [fold(0), fold(1), fold(2), fold(3)];
        let element = |i: usize| ElementLanes {
            alone: m == 1,
            dry: plants[0].dry[i],
            remembers: plants[0].remembers[i],
            displacement: Pack::ZERO,
            velocity: Pack::ZERO,
            time_s: Pack::ZERO,
            compliance: [compliance[0][i * m + i], compliance[1][i * m + i]],
            dry_compliance: [compliance[2][i * m + i], compliance[3][i * m + i]],
            start_velocity: Pack::ZERO,
            free_velocity: Pack::ZERO,
            end_velocity: of_plants(&|p| p.end_velocity[i]),
            smooth: of_plants(&|p| p.smooth[i]),
            dry_force: of_plants(&|p| p.dry_force[i]),
            dry_end: of_plants(&|p| p.dry_end[i]),
            memory: of_plants(&|p| p.memory[i]),
            from: [
                of_plants(&|p| p.from[i].displacement),
                of_plants(&|p| p.from[i].velocity),
                of_plants(&|p| p.from[i].time_s),
            ],
            open: Mask::ALL,
        };
        let law = |i: usize| -> Box<dyn LaneLaw + 'a> {
            let peers: [&'a dyn ForceLaw; LANES] = sets.map(|set| set.elements[i].law.as_ref());
            peers[0]
                .lanes(&peers)
                .unwrap_or_else(|| Box::new(OneByOne(peers)))
        };
        let state = |i: usize| {
            Pack::of(|l| {
                let (values, i) = if i < n {
                    (sets[l].displacement, i)
                } else {
                    (sets[l].velocity, i - n)
                };
                values.get(i).copied().unwrap_or(0.0)
            })
        };
        Block {
            arch,
            kernel: LaneKernel::new(&sets.map(|set| set.propagator)),
            nodes: sets[0].elements.iter().map(|e| [e.a, e.b]).collect(),
            laws: (0..m).map(law).collect(),
            elements: (0..m).map(element).collect(),
            compliance,
            sweeps: if m == 1 && !plants[0].dry[0] {
                1
            } else {
                SWEEPS
            },
            any_dry: plants[0].dry.contains(&true),
            any_memory: plants[0].remembers.contains(&true),
            state: (0..2 * n).map(state).collect(),
            next: vec![Pack::ZERO; 2 * n],
            before: vec![Pack::ZERO; n],
            after: vec![Pack::ZERO; n],
            net: vec![Pack::ZERO; n],
            base: vec![Pack::ZERO; 2 * bases],
            free: vec![[Pack::ZERO; 2]; m],
            step_s: Pack::of(|l| sets[l].propagator.time_step_s),
            start_s: Pack::of(|l| sets[l].excitation.start_s),
        }
    }

    /// One step, with the forces at its two ends and the bases at its end in place; `steps` counts
    /// from the first sample.
    #[inline(always)]
    pub(super) fn step<S: Simd>(&mut self, simd: S, n: usize, steps: usize) {
        for (element, &nodes) in self.elements.iter().zip(&self.nodes) {
            spread(simd, nodes, &element.smooth, &mut self.before);
        }
        let from = [&self.state[..], &self.before, &self.after];
        self.kernel.step(simd, n, from, &mut self.next);
        if !self.elements.is_empty() {
            self.solve(simd, n, steps as f64);
            self.push(simd, n);
        }
        // Copied, not swapped: the next loads would wait for the pointers.
        self.state[..2 * n].copy_from_slice(&self.next[..2 * n]);
    }

    /// Forces of the elements at the end of the step.
    #[inline(always)]
    fn solve<S: Simd>(&mut self, simd: S, n: usize, steps: f64) {
        let bases = self.base.len() / 2;
        let time_s = add_product(simd, &self.start_s, &Pack([steps; LANES]), &self.step_s);
        let (x, v) = self.next[..2 * n].split_at(n);
        let (base_x, base_v) = self.base.split_at(bases);
        for (i, element) in self.elements.iter_mut().enumerate() {
            let free = [
                across(simd, self.nodes[i], x, base_x),
                across(simd, self.nodes[i], v, base_v),
            ];
            self.free[i] = free;
            element.time_s = time_s;
            element.free_velocity = free[1];
            element.start_velocity = element.end_velocity;
        }
        let mut open = Mask::ALL;
        for _ in 0..self.sweeps {
            let mut moved = Mask([0; LANES]);
            for i in 0..self.elements.len() {
                self.prepare(simd, i);
                let element = &mut self.elements[i];
                element.open = open;
                self.laws[i].solve(self.arch, element);
                moved = either(simd, &moved, &element.open);
            }
            open = moved;
            if !open.any() {
                break;
            }
        }
        if self.any_memory {
            self.remember(simd);
        }
    }

    /// Motion of an element without its own forces.
    #[inline(always)]
    fn prepare<S: Simd>(&mut self, simd: S, i: usize) {
        let m = self.elements.len();
        let [mut displacement, mut velocity] = self.free[i];
        let [x, v, dry_x, dry_v] = &self.compliance;
        for j in (0..m).filter(|&j| j != i) {
            let (k, other) = (i * m + j, &self.elements[j]);
            let forces = [&other.smooth, &other.dry_force];
            displacement = less_products(
                simd,
                &displacement,
                [&x[k], forces[0]],
                [&dry_x[k], forces[1]],
            );
            velocity = less_products(simd, &velocity, [&v[k], forces[0]], [&dry_v[k], forces[1]]);
        }
        let element = &mut self.elements[i];
        (element.displacement, element.velocity) = (displacement, velocity);
    }

    /// Commits the memories, with all forces where they settled.
    #[inline(always)]
    fn remember<S: Simd>(&mut self, simd: S) {
        let m = self.elements.len();
        let [x, _, dry_x, _] = &self.compliance;
        for i in 0..m {
            if !self.elements[i].remembers {
                continue;
            }
            let mut displacement = self.free[i][0];
            for j in 0..m {
                let (k, other) = (i * m + j, &self.elements[j]);
                let forces = [&other.smooth, &other.dry_force];
                displacement = less_products(
                    simd,
                    &displacement,
                    [&x[k], forces[0]],
                    [&dry_x[k], forces[1]],
                );
            }
            let element = &mut self.elements[i];
            element.displacement = displacement;
            self.laws[i].remember(self.arch, element);
        }
    }

    /// Adds what the forces of the elements do to the state.
    #[inline(always)]
    fn push<S: Simd>(&mut self, simd: S, n: usize) {
        self.net[..n].fill(Pack::ZERO);
        for (element, &nodes) in self.elements.iter().zip(&self.nodes) {
            spread(simd, nodes, &element.smooth, &mut self.net);
        }
        self.kernel.push_end(simd, n, &self.net, &mut self.next);
        if self.any_dry {
            self.net[..n].fill(Pack::ZERO);
            for (element, &nodes) in self.elements.iter().zip(&self.nodes) {
                spread(simd, nodes, &element.dry_force, &mut self.net);
            }
            self.kernel.push_held(simd, n, &self.net, &mut self.next);
        }
    }

    /// Forces on the degrees of freedom at a sample, those of the elements included.
    #[inline(always)]
    pub(super) fn load<S: Simd>(&mut self, simd: S, n: usize, carried: &mut [Pack]) {
        self.net[..n].copy_from_slice(&self.after[..n]);
        for (i, element) in self.elements.iter().enumerate() {
            carried[i] = add(simd, &element.smooth, &element.dry_end);
            spread(simd, self.nodes[i], &carried[i], &mut self.net);
        }
    }
}
