//! From the state of the plant to the outputs of the model.

use simgap_integrate::exact::lanes::{LANES, LaneSnapshot, Pack};
use simgap_integrate::exact::{Element, Snapshot};
use simgap_model::{Cylinder, Model, ModelError, Node, OutputKind, PRESSURE_UNIT_PA};

use crate::prepared::Prepared;

/// How one output is read off a sample.
pub(crate) struct OutputPlan {
    kind: OutputKind,
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

/// Where the base nodes of eight sets are at one sample.
pub(crate) struct LaneBase<'a> {
    pub(crate) sample: usize,
    pub(crate) ready: &'a [&'a Prepared; LANES],
}

impl LaneBase<'_> {
    fn acceleration(&self, node: usize) -> Pack {
        Pack::of(|l| {
            let drive = &self.ready[l].drive;
            let at = self.sample * drive.base_count + node;
            drive.base_acceleration.get(at).copied().unwrap_or(0.0)
        })
    }
}

impl OutputPlan {
    /// Whether two outputs are read off alike, from members of other values.
    pub(crate) fn is_alike(&self, other: &OutputPlan) -> bool {
        (self.kind, self.a, self.b) == (other.kind, other.a, other.b)
            && self.elements == other.elements
            && self.offset == other.offset
    }

    /// As [`OutputPlan::read`] for eight sets, whose members have these stiffnesses and dampings.
    #[inline(always)]
    pub(crate) fn read_lanes(
        &self,
        at: &LaneSnapshot<'_>,
        base: &LaneBase<'_>,
        [stiffness, damping]: &[Pack; 2],
    ) -> Pack {
        let displacement = || self.across_lanes(at.displacement, |i| at.base_displacement[i]);
        let velocity = || self.across_lanes(at.velocity, |i| at.base_velocity[i]);
        match self.kind {
            OutputKind::Displacement | OutputKind::Roll | OutputKind::Spool => displacement(),
            OutputKind::Velocity => velocity(),
            OutputKind::Acceleration => {
                self.across_lanes(at.acceleration, |i| base.acceleration(i))
            }
            OutputKind::Force | OutputKind::Pressure | OutputKind::Flow => {
                let (x, v) = (displacement(), velocity());
                let mut on_top = Pack([-0.0; LANES]);
                for &(i, sign) in &self.elements {
                    let force = &at.element_force[i];
                    on_top = Pack::of(|l| on_top.0[l] + sign * force.0[l]);
                }
                let offset = self.offset;
                Pack::of(|l| stiffness.0[l] * x.0[l] + damping.0[l] * v.0[l] + on_top.0[l] + offset)
            }
        }
    }

    /// Difference between the two nodes.
    #[inline(always)]
    fn across_lanes(&self, dofs: &[Pack], of_base: impl Fn(usize) -> Pack) -> Pack {
        let value = |node| match node {
            Node::Ground => Pack::ZERO,
            Node::Dof(i) => dofs[i],
            Node::Base(i) => of_base(i),
            Node::Point(point) => {
                let (heave, roll) = (&dofs[point.heave], &dofs[point.roll]);
                Pack::of(|l| heave.0[l] + point.arm_m() * roll.0[l])
            }
        };
        let (a, b) = (value(self.a), value(self.b));
        Pack::of(|l| a.0[l] - b.0[l])
    }

    pub(crate) fn needs_acceleration(&self) -> bool {
        self.kind == OutputKind::Acceleration
    }

    pub(crate) fn read(
        &self,
        at: &Snapshot<'_>,
        acceleration: &[f64],
        base: &BaseMotion<'_>,
    ) -> f64 {
        let across = |dofs: &[f64], bases: &[f64]| across([self.a, self.b], dofs, bases);
        match self.kind {
            OutputKind::Displacement | OutputKind::Roll | OutputKind::Spool => {
                across(at.displacement, base.displacement)
            }
            OutputKind::Velocity => across(at.velocity, base.velocity),
            OutputKind::Acceleration => across(acceleration, base.acceleration),
            OutputKind::Force | OutputKind::Pressure | OutputKind::Flow => {
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

/// `carried` says of each element whether it is a member between its nodes.
pub(crate) fn output_plans(
    model: &Model,
    elements: &[Element],
    carried: &[bool],
) -> Result<Vec<OutputPlan>, ModelError> {
    let mut plans = Vec::with_capacity(model.outputs.len());
    for output in &model.outputs {
        let [a, b] = model.output_nodes(output)?;
        // A force is positive when a is displaced from b in the positive direction, and so is the
        // force of a member whichever way round it is written.
        let [stiffness, damping] = match &output.between {
            Some(pair) => model.stiffness_and_damping(pair),
            None => [0.0; 2],
        };
        let joined = elements.iter().enumerate().filter_map(|(i, element)| {
            if !carried[i] {
                None
            } else if element.port.force == [a, b] {
                Some((i, 1.0))
            } else if element.port.force == [b, a] {
                Some((i, -1.0))
            } else {
                None
            }
        });
        let plan = OutputPlan {
            kind: output.kind,
            a,
            b,
            stiffness,
            damping,
            offset: 0.0,
            elements: joined.collect(),
        };
        let chamber = output.at.as_ref().and_then(|at| model.chamber(at));
        plans.push(match (output.kind, chamber) {
            (OutputKind::Pressure, Some((cylinder, chamber))) => OutputPlan {
                damping: PRESSURE_UNIT_PA,
                offset: cylinder.pressures[chamber],
                ..plan
            },
            (OutputKind::Flow, Some((cylinder, chamber))) => {
                flow_plan(model, elements, plan, cylinder, chamber)
            }
            _ => plan,
        });
    }
    Ok(plans)
}

/// The flow of the valve of a cylinder into a chamber: what is proportional to its spool, and what its orifice adds.
fn flow_plan(
    model: &Model,
    elements: &[Element],
    plan: OutputPlan,
    cylinder: &Cylinder,
    chamber: usize,
) -> OutputPlan {
    let valve = model.valves.iter().find(|v| v.cylinder == cylinder.name);
    let spool = valve.and_then(|valve| Some((valve, model.node(&valve.spool())?)));
    let Some((valve, spool)) = spool else {
        return OutputPlan { b: plan.a, ..plan };
    };
    let is_own = |element: &Element| {
        element.port.displacement[0] == spool && element.port.force[0] == plan.a
    };
    let own = elements.iter().position(is_own);
    OutputPlan {
        a: spool,
        stiffness: valve.opening_gain(chamber, cylinder.pressures[chamber]),
        elements: own
            .map(|i| (i, -1.0 / PRESSURE_UNIT_PA))
            .into_iter()
            .collect(),
        ..plan
    }
}
