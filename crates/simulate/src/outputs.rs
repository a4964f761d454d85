//! From the state of the plant to the outputs of the model.

use simgap_integrate::exact::{Element, Snapshot};
use simgap_model::{Model, ModelError, Node, OutputKind, same_pair};

/// How one output is read off a sample.
pub(crate) struct OutputPlan {
    kind: OutputKind,
    a: Node,
    b: Node,
    stiffness: f64,
    damping: f64,
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
    let value = |node| match node {
        Node::Ground => 0.0,
        Node::Dof(i) => dofs[i],
        Node::Base(i) => bases[i],
    };
    value(a) - value(b)
}

impl OutputPlan {
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
            OutputKind::Displacement => across(at.displacement, base.displacement),
            OutputKind::Velocity => across(at.velocity, base.velocity),
            OutputKind::Acceleration => across(acceleration, base.acceleration),
            OutputKind::Force => {
                let members = self.stiffness * across(at.displacement, base.displacement)
                    + self.damping * across(at.velocity, base.velocity);
                let on_top: f64 = self
                    .elements
                    .iter()
                    .map(|&(i, sign)| sign * at.element_force[i])
                    .sum();
                members + on_top
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
        let place = || format!("[[output]] \"{}\"", output.channel);
        let ground = simgap_model::GROUND.to_string();
        let pair = match (&output.at, &output.between) {
            (Some(at), _) => [at.clone(), ground],
            (None, Some(pair)) => pair.clone(),
            (None, None) => [ground.clone(), ground],
        };
        let [a, b] = model.resolve_pair(&pair, place)?;
        // A force is positive when a is displaced from b in the positive direction, and so is the
        // force of a member whichever way round it is written.
        let springs = model
            .springs
            .iter()
            .filter(|s| same_pair(&s.between, &pair));
        let dampers = model
            .dampers
            .iter()
            .filter(|d| same_pair(&d.between, &pair));
        let joined = elements.iter().enumerate().filter_map(|(i, element)| {
            if !carried[i] {
                None
            } else if (element.a, element.b) == (a, b) {
                Some((i, 1.0))
            } else if (element.a, element.b) == (b, a) {
                Some((i, -1.0))
            } else {
                None
            }
        });
        plans.push(OutputPlan {
            kind: output.kind,
            a,
            b,
            stiffness: springs.map(|s| s.stiffness).sum(),
            damping: dampers.map(|d| d.damping).sum(),
            elements: joined.collect(),
        });
    }
    Ok(plans)
}
