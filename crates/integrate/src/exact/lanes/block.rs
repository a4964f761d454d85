//! Eight sets within the march.

use pulp::{Arch, Simd};
use simgap_model::{BodyPoint, Node};

use super::joint::{JointLanes, LaneLaw};
use super::kernel::LaneKernel;
use super::law::OneByOne;
use super::members::Together;
use super::row::{Row, State, change, entry};
use super::set::LaneSet;
use super::wide::{Which, Wide};
use super::{LANES, Mask, Pack};
use crate::exact::joint::Joint;
use crate::exact::law::{ForceLaw, Port};
use crate::exact::plant::Plant;

/// Eight sets of one structure, in the lanes of every number.
pub(super) struct Block<'a> {
    pub(super) arch: Arch,
    pub(super) kernel: LaneKernel,
    /// Of each element.
    pub(super) ports: Vec<Port>,
    pub(super) laws: Vec<Box<dyn LaneLaw + 'a>>,
    /// The part of each element in S of its joint, and room for a trial of it.
    pub(super) part: Vec<Pack>,
    pub(super) trial: Vec<Pack>,
    /// Which elements stand at a joint, and the joints.
    pub(super) places: Vec<Joint>,
    pub(super) joints: Vec<JointLanes>,
    /// How the forces of joint j move joint i, row-major, as in the march of one set.
    pub(super) compliance: [Vec<Pack>; 4],
    pub(super) together: Together,
    sweeps: usize,
    pub(super) any_dry: bool,
    any_memory: bool,
    /// Whether the force of an element is spread over steps in some set.
    pub(super) spread: Vec<bool>,
    pub(super) free: Vec<[Pack; 2]>,
    step_s: Pack,
    start_s: Pack,
}

/// Value at a node.
#[inline(always)]
fn at<S: Simd>(simd: S, node: Node, values: &[Pack], bases: &[Pack]) -> Pack {
    match node {
        Node::Ground | Node::Port(_) => Pack::ZERO,
        Node::Dof(i) => entry(values, i),
        Node::Base(i) => bases[i],
        Node::Point(point) => {
            let heave = Wide::of(simd, &entry(values, point.heave));
            let roll = Wide::of(simd, &entry(values, point.roll));
            (heave + Wide::splat(simd, point.arm_m()) * roll).pack()
        }
    }
}

#[inline(always)]
fn across<S: Simd>(simd: S, [a, b]: [Node; 2], values: &[Pack], bases: &[Pack]) -> Pack {
    let of_node = |node| Wide::of(simd, &at(simd, node, values, bases));
    (of_node(a) - of_node(b)).pack()
}

/// Motion across an element: displacement and velocity.
#[inline(always)]
pub(super) fn motion_across<S: Simd>(
    simd: S,
    port: Port,
    [x, v]: [&[Pack]; 2],
    [base_x, base_v]: [&[Pack]; 2],
) -> [Pack; 2] {
    [
        across(simd, port.displacement, x, base_x),
        across(simd, port.velocity, v, base_v),
    ]
}

/// Adds what a force between two nodes does to the degrees of freedom.
#[inline(always)]
fn spread<S: Simd>(simd: S, [a, b]: [Node; 2], force: &Pack, dof_force: &mut [Pack]) {
    let force = Wide::of(simd, force);
    match a {
        Node::Dof(i) => change(dof_force, i, |f| (Wide::of(simd, f) - force).pack()),
        Node::Point(point) => push_body(simd, point, Wide::zero(simd) - force, dof_force),
        Node::Ground | Node::Base(_) | Node::Port(_) => {}
    }
    match b {
        Node::Dof(i) => change(dof_force, i, |f| (Wide::of(simd, f) + force).pack()),
        Node::Point(point) => push_body(simd, point, force, dof_force),
        Node::Ground | Node::Base(_) | Node::Port(_) => {}
    }
}

/// Adds what a force on a point of a body does to its heave and roll.
#[inline(always)]
fn push_body<S: Simd>(simd: S, point: BodyPoint, force: Wide<S>, dof_force: &mut [Pack]) {
    let torque = Wide::splat(simd, point.arm_m()) * force;
    change(dof_force, point.heave, |f| {
        (Wide::of(simd, f) + force).pack()
    });
    change(dof_force, point.roll, |f| {
        (Wide::of(simd, f) + torque).pack()
    });
}

/// `value − (a b + c d)`.
#[inline(always)]
pub(super) fn less_products<S: Simd>(
    simd: S,
    value: &Pack,
    first: [&Pack; 2],
    second: [&Pack; 2],
) -> Pack {
    let product = |[a, b]: [&Pack; 2]| Wide::of(simd, a) * Wide::of(simd, b);
    (Wide::of(simd, value) - (product(first) + product(second))).pack()
}

impl<'a> Block<'a> {
    /// The sets at their first sample.
    pub(super) fn new(
        arch: Arch,
        sets: &[&LaneSet<'a>; LANES],
        is_read: &dyn Fn(usize) -> bool,
    ) -> Block<'a> {
        let plants = sets.map(LaneSet::begin);
        let m = plants[0].joints.len();
        let count = sets[0].elements.len();
        let of_plants = |value: &dyn Fn(&Plant<'_>) -> f64| Pack::of(|l| value(&plants[l]));
        let fold = |part: usize| -> Vec<Pack> {
            let entry = |k: usize| of_plants(&|p| p.compliance.parts()[part][k]);
            (0..m * m).map(entry).collect()
        };
        let compliance = [fold(0), fold(1), fold(2), fold(3)];
        let joint = |i: usize| JointLanes {
            displacement: Pack::ZERO,
            velocity: Pack::ZERO,
            without: [Pack::ZERO; 2],
            time_s: Pack::ZERO,
            step_s: Pack::of(|l| sets[l].propagator.time_step_s),
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
            force: Pack::ZERO,
            dry: [Pack::ZERO; 3],
            tangent: [Pack::ZERO; 2],
            gain: of_plants(&|p| p.gain[i]),
            before: [0, 1, 2, 3].map(|k| of_plants(&|p| p.before[i][k])),
        };
        let law = |i: usize| -> Box<dyn LaneLaw + 'a> {
            let peers: [&'a dyn ForceLaw; LANES] = sets.map(|set| set.elements[i].law.as_ref());
            peers[0]
                .lanes(&peers)
                .unwrap_or_else(|| Box::new(OneByOne(peers)))
        };
        Block {
            arch,
            kernel: LaneKernel::new(arch, sets, is_read),
            ports: sets[0].elements.iter().map(|e| e.port).collect(),
            laws: (0..count).map(law).collect(),
            part: (0..count).map(|i| of_plants(&|p| p.part[i])).collect(),
            trial: vec![Pack::ZERO; count],
            places: plants[0].joints.clone(),
            joints: (0..m).map(joint).collect(),
            compliance,
            together: Together::new(&plants[0].together.members),
            sweeps: plants[0].sweeps(),
            any_dry: plants[0].any_dry,
            spread: (0..count)
                .map(|i| {
                    sets.iter()
                        .any(|set| set.elements[i].law.is_spread_over_steps())
                })
                .collect(),
            any_memory: sets[0].elements.iter().any(|e| e.law.remembers()),
            free: vec![[Pack::ZERO; 2]; m],
            step_s: Pack::of(|l| sets[l].propagator.time_step_s),
            start_s: Pack::of(|l| sets[l].excitation.start_s),
        }
    }

    /// When so many steps have passed, s.
    #[inline(always)]
    pub(super) fn time_s<S: Simd>(&self, simd: S, steps: usize) -> Pack {
        let passed = Wide::splat(simd, steps as f64) * Wide::of(simd, &self.step_s);
        (Wide::of(simd, &self.start_s) + passed).pack()
    }

    /// Forces of the elements at the end of the step.
    #[inline(always)]
    pub(super) fn solve<S: Simd, R: Row>(
        &mut self,
        simd: S,
        next: &State<R>,
        base: [&[Pack]; 2],
        steps: usize,
    ) {
        let time_s = self.time_s(simd, steps);
        for (k, (joint, free)) in self.joints.iter_mut().zip(&mut self.free).enumerate() {
            let port = self.ports[self.places[k].elements[0]];
            *free = motion_across(simd, port, next.packs(), base);
            joint.begin(simd, free[1], time_s);
        }
        let mut open = Mask::ALL;
        for _ in 0..self.sweeps {
            let mut moved = Which::of(simd, &Mask::NONE);
            if !self.together.members.is_empty() {
                moved = moved | Which::of(simd, &self.solve_together(&open));
            }
            for k in 0..self.joints.len() {
                if !self.places[k].has_tangent {
                    moved = moved | Which::of(simd, &self.solve_joint(simd, k, &open));
                }
            }
            if !moved.any() {
                break;
            }
            open = moved.mask();
        }
        if self.any_memory {
            self.remember(simd);
        }
    }

    /// Motion across a joint at the end of the step under the forces of some joints.
    #[inline(always)]
    pub(super) fn motion_under<S: Simd>(
        &self,
        simd: S,
        k: usize,
        acts: impl Fn(usize) -> bool,
    ) -> [Pack; 2] {
        let m = self.joints.len();
        let [mut displacement, mut velocity] = self.free[k];
        let [x, v, dry_x, dry_v] = &self.compliance;
        for j in (0..m).filter(|&j| acts(j)) {
            let (entry, other) = (k * m + j, &self.joints[j]);
            let forces = [&other.smooth, &other.dry_force];
            let (xs, vs) = ([&x[entry], forces[0]], [&v[entry], forces[0]]);
            displacement = less_products(simd, &displacement, xs, [&dry_x[entry], forces[1]]);
            velocity = less_products(simd, &velocity, vs, [&dry_v[entry], forces[1]]);
        }
        [displacement, velocity]
    }

    /// Commits the memories, with all forces where they settled.
    #[inline(always)]
    fn remember<S: Simd>(&mut self, simd: S) {
        for i in 0..self.joints.len() {
            let Some(element) = self.places[i].remembers else {
                continue;
            };
            let [displacement, _] = self.motion_under(simd, i, |_| true);
            let joint = &mut self.joints[i];
            joint.displacement = displacement;
            self.laws[element].remember(self.arch, joint);
        }
    }

    /// Adds what the forces of the elements do to the state; `net` is room.
    #[inline(always)]
    pub(super) fn push<S: Simd, R: Row>(&mut self, simd: S, net: &mut R, next: &mut State<R>) {
        net.packs_mut().fill(Pack::ZERO);
        self.spread_smooth(simd, net);
        self.kernel.push_end(simd, net, next);
        if self.any_dry {
            net.packs_mut().fill(Pack::ZERO);
            for (joint, place) in self.joints.iter().zip(&self.places) {
                let port = self.ports[place.elements[0]];
                spread(simd, port.force, &joint.dry_force, net.packs_mut());
            }
            self.kernel.push_held(simd, net, next);
        }
    }

    /// Adds what S of all joints does to the degrees of freedom.
    #[inline(always)]
    pub(super) fn spread_smooth<S: Simd, R: Row>(&self, simd: S, net: &mut R) {
        for (joint, place) in self.joints.iter().zip(&self.places) {
            let port = self.ports[place.elements[0]];
            spread(simd, port.force, &joint.smooth, net.packs_mut());
        }
    }

    /// Forces that the elements carry at a sample.
    #[inline(always)]
    pub(super) fn carried<S: Simd>(&self, simd: S, carried: &mut [Pack]) {
        carried.copy_from_slice(&self.part);
        for (joint, place) in self.joints.iter().zip(&self.places) {
            let carried = &mut carried[place.elements[0]];
            *carried = (Wide::of(simd, carried) + Wide::of(simd, &joint.dry_end)).pack();
        }
    }

    /// Adds what these forces do to those on the degrees of freedom.
    #[inline(always)]
    pub(super) fn add_to<S: Simd, R: Row>(&self, simd: S, carried: &[Pack], net: &mut R) {
        for (carried, &port) in carried.iter().zip(&self.ports) {
            spread(simd, port.force, carried, net.packs_mut());
        }
    }
}
