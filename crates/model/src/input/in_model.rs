//! What an input does to the model.

use super::{Input, InputKind};
use crate::refuse::{is_one_of, item, node_name};
use crate::{BetweenSamples, Model, ModelError, Node};

impl Model {
    /// Checks that an input has something to drive.
    pub(crate) fn check_input(&self, input: &Input) -> Result<(), ModelError> {
        let place = item("input", &input.channel);
        match input.kind {
            InputKind::Force => self.check_mass(&input.at, &place),
            InputKind::Displacement => node_name(&place, &input.at),
            InputKind::Signal => node_name(&place, &input.at),
            InputKind::Command => {
                let names = self.elements.valves.iter().map(|valve| &valve.name);
                is_one_of(&place, &input.at, names, "the name of a [[valve]]")
            }
            InputKind::SetPoint => {
                let names = self.elements.blocks.iter().map(|block| &block.name);
                is_one_of(&place, &input.at, names, "the name of a [[block]]")
            }
        }
    }

    /// What an input does to the coordinates: coordinate and weight. Empty for the displacement of a base and for what a
    /// simulator takes.
    ///
    /// # Errors
    /// [`ModelError::UnknownNode`] and [`ModelError::Shape`] for blocks that are joined to nothing.
    pub fn input_terms(&self, input: usize) -> Result<Vec<(usize, f64)>, ModelError> {
        let Some(own) = self.inputs.get(input) else {
            return Ok(vec![]);
        };
        let at = |node: Option<Node>| node.into_iter().flat_map(Node::terms).collect();
        Ok(match own.kind {
            InputKind::Force => at(self.node(&own.at)),
            InputKind::Displacement | InputKind::Signal => vec![],
            InputKind::Command => {
                let valve = self
                    .elements
                    .valves
                    .iter()
                    .find(|valve| valve.name == own.at);
                at(valve.and_then(|valve| self.node(&valve.spool())))
            }
            InputKind::SetPoint => self.set_point_terms(input)?,
        })
    }
}

impl Input {
    /// Refuses jumps of what may not jump.
    pub(crate) fn check_between_samples(&self) -> Result<(), ModelError> {
        let stated = self.between_samples();
        if self.may_jump() || stated == BetweenSamples::Smooth {
            return Ok(());
        }
        Err(ModelError::Shape {
            place: item("input", &self.channel),
            found: format!("between_samples = \"{}\"", stated.name()),
            needed: "\"smooth\" for a displacement: a node that jumps has no velocity".into(),
        })
    }
}
