//! From the state of the plant to the outputs of the model.

use simgap_integrate::exact::lanes::{LANES, LaneSamples, Pack};
use simgap_integrate::exact::{Element, Snapshot};
use simgap_model::{Form, Model, ModelError, Node, PRESSURE_UNIT_PA, Reading};

use crate::prepared::Prepared;

/// What is made of the difference of two nodes.
#[derive(Clone, Copy, PartialEq)]
enum Read {
    Displacement,
    Velocity,
    Acceleration,
    /// Stiffness times displacement, damping times velocity, the forces of elements and an offset.
    Sum,
}

/// How one output is read off a sample.
pub(crate) struct OutputPlan {
    read: Read,
    a: Node,
    b: Node,
    pub(crate) stiffness: f64,
    pub(crate) damping: f64,
    /// Added to what is read off members: a pressure about which others are computed.
    offset: f64,
    /// Elements between a and b, with the sign of their orientation.
    elements: Vec<(usize, f64)>,
}

/// Motion of the base nodes at one sample.
pub(crate) struct BaseMotion<'a> {
    pub(crate) displacement: &'a [f64],
    pub(crate) velocity: &'a [f64],
    pub(crate) acceleration: &'a [f64],
}

/// Value at node a minus value at node b.
pub(crate) fn across([a, b]: [Node; 2], dofs: &[f64], bases: &[f64]) -> f64 {
    a.of(dofs, bases) - b.of(dofs, bases)
}

/// Acceleration of a base node of eight sets at a sample.
fn base_acceleration(ready: &[&Prepared; LANES], sample: usize, node: usize) -> Pack {
    Pack::of(|l| {
        let drive = &ready[l].drive;
        let at = sample * drive.base_count + node;
        drive.base_acceleration.get(at).copied().unwrap_or(0.0)
    })
}

impl OutputPlan {
    /// Whether two outputs are read off alike, from members of other values.
    pub(crate) fn is_alike(&self, other: &OutputPlan) -> bool {
        (self.read, self.a, self.b) == (other.read, other.a, other.b)
            && self.elements == other.elements
            && self.offset == other.offset
    }

    /// As [`OutputPlan::read`] for eight sets at the k-th of some samples; their members have these stiffnesses and dampings.
    #[inline(always)]
    pub(crate) fn read_lanes(
        &self,
        (samples, k): (&LaneSamples<'_>, usize),
        ready: &[&Prepared; LANES],
        [stiffness, damping]: &[Pack; 2],
    ) -> Pack {
        match self.read {
            Read::Displacement => self.displacement(samples, k),
            Read::Velocity => self.velocity(samples, k),
            Read::Acceleration => self.across_lanes(samples.acceleration(k), |i| {
                base_acceleration(ready, samples.first + k, i)
            }),
            Read::Sum => {
                let (x, v) = (self.displacement(samples, k), self.velocity(samples, k));
                let mut on_top = Pack([-0.0; LANES]);
                for &(i, sign) in &self.elements {
                    let force = &samples.element_force(k)[i];
                    on_top = Pack::of(|l| on_top.0[l] + sign * force.0[l]);
                }
                let offset = self.offset;
                Pack::of(|l| stiffness.0[l] * x.0[l] + damping.0[l] * v.0[l] + on_top.0[l] + offset)
            }
        }
    }

    #[inline(always)]
    fn displacement(&self, samples: &LaneSamples<'_>, k: usize) -> Pack {
        self.across_lanes(samples.displacement(k), |i| samples.base_displacement(k)[i])
    }

    #[inline(always)]
    fn velocity(&self, samples: &LaneSamples<'_>, k: usize) -> Pack {
        self.across_lanes(samples.velocity(k), |i| samples.base_velocity(k)[i])
    }

    /// Difference between the two nodes.
    #[inline(always)]
    fn across_lanes(&self, dofs: &[Pack], of_base: impl Fn(usize) -> Pack) -> Pack {
        let a = value_in_lanes(self.a, dofs, &of_base);
        if self.b == Node::Ground {
            return a;
        }
        let b = value_in_lanes(self.b, dofs, &of_base);
        Pack::of(|l| a.0[l] - b.0[l])
    }

    /// Whether the displacement of a coordinate is read; a sum reads it where it has a stiffness.
    pub(crate) fn reads_displacement(&self, coordinate: usize, has_stiffness: bool) -> bool {
        let reads = match self.read {
            Read::Displacement => true,
            Read::Velocity | Read::Acceleration => false,
            Read::Sum => has_stiffness,
        };
        reads && self.is_of(coordinate)
    }

    /// Whether the acceleration of a coordinate is read.
    pub(crate) fn reads_acceleration(&self, coordinate: usize) -> bool {
        self.needs_acceleration() && self.is_of(coordinate)
    }

    /// Whether a coordinate moves one of the two nodes.
    fn is_of(&self, coordinate: usize) -> bool {
        let mut terms = self.a.terms().chain(self.b.terms());
        terms.any(|(i, _)| i == coordinate)
    }

    pub(crate) fn needs_acceleration(&self) -> bool {
        self.read == Read::Acceleration
    }

    /// Whether what elements carry is read; an acceleration needs it beside that.
    pub(crate) fn reads_forces(&self) -> bool {
        !self.elements.is_empty()
    }

    pub(crate) fn read(
        &self,
        at: &Snapshot<'_>,
        acceleration: &[f64],
        base: &BaseMotion<'_>,
    ) -> f64 {
        let across = |dofs: &[f64], bases: &[f64]| across([self.a, self.b], dofs, bases);
        match self.read {
            Read::Displacement => across(at.displacement, base.displacement),
            Read::Velocity => across(at.velocity, base.velocity),
            Read::Acceleration => across(acceleration, base.acceleration),
            Read::Sum => {
                let members = self.stiffness * across(at.displacement, base.displacement)
                    + self.damping * across(at.velocity, base.velocity);
                let on_top: f64 = self
                    .elements
                    .iter()
                    .map(|&(i, sign)| sign * at.element_force[i])
                    .sum();
                members + on_top + self.offset
            }
        }
    }
}

/// Value at a node. Not a closure: one that is called twice is not inlined, and its value goes through memory.
#[inline(always)]
fn value_in_lanes(node: Node, dofs: &[Pack], of_base: impl Fn(usize) -> Pack) -> Pack {
    match node {
        Node::Ground | Node::Port(_) => Pack::ZERO,
        Node::Dof(i) => dofs[i],
        Node::Base(i) => of_base(i),
        Node::Point(point) => {
            let (heave, roll) = (&dofs[point.heave], &dofs[point.roll]);
            Pack::of(|l| heave.0[l] + point.arm_m() * roll.0[l])
        }
    }
}

/// `carried` says of each element whether it is a member between its nodes.
pub(crate) fn output_plans(
    model: &Model,
    elements: &[Element],
    carried: &[bool],
) -> Result<Vec<OutputPlan>, ModelError> {
    let plan = |output| {
        let Reading { nodes, form } = model.reading(output)?;
        let plain = |read: Read| OutputPlan {
            read,
            a: nodes[0],
            b: nodes[1],
            stiffness: 0.0,
            damping: 0.0,
            offset: 0.0,
            elements: vec![],
        };
        Ok(match form {
            // The simulator answers; see `external`.
            Form::Signal | Form::Displacement => plain(Read::Displacement),
            Form::Velocity => plain(Read::Velocity),
            Form::Acceleration => plain(Read::Acceleration),
            Form::Members { stiffness, damping } => OutputPlan {
                stiffness,
                damping,
                elements: joined(elements, carried, nodes),
                ..plain(Read::Sum)
            },
            Form::Rate { scale, offset } => OutputPlan {
                damping: scale,
                offset,
                ..plain(Read::Sum)
            },
            Form::Orifice { gain, chamber } => OutputPlan {
                stiffness: gain,
                elements: of_orifice(elements, nodes[0], chamber),
                ..plain(Read::Sum)
            },
        })
    };
    model.outputs.iter().map(plan).collect()
}

/// The members among the elements between two nodes. A force is positive when a is displaced from b in the positive
/// direction, and so is the force of a member whichever way round it is written.
fn joined(elements: &[Element], carried: &[bool], [a, b]: [Node; 2]) -> Vec<(usize, f64)> {
    let members = elements.iter().enumerate().filter(|(i, _)| carried[*i]);
    let joined = members.filter_map(|(i, element)| {
        if element.port.force == [a, b] {
            Some((i, 1.0))
        } else if element.port.force == [b, a] {
            Some((i, -1.0))
        } else {
            None
        }
    });
    joined.collect()
}

/// What the orifice of a valve adds to the flow into a chamber that is proportional to the spool.
fn of_orifice(elements: &[Element], spool: Node, chamber: Node) -> Vec<(usize, f64)> {
    let is_own = |element: &Element| {
        element.port.displacement[0] == spool && element.port.force[0] == chamber
    };
    let own = elements.iter().position(is_own);
    let own = own.map(|i| (i, -1.0 / PRESSURE_UNIT_PA));
    own.into_iter().collect()
}
