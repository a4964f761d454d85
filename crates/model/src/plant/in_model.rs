//! What a simulator of the user's is to the model.

use super::{PlantParameter, PlantPort};
use crate::refuse::{check_uncertainty, finite, item, node_name, unique};
use crate::{InputKind, Model, ModelError, Output, OutputKind};

impl Model {
    /// Whether the plant is a simulator of the user's: the model names signals of it, parameters or ports.
    #[must_use]
    pub fn is_external(&self) -> bool {
        let reads = |kind| kind == OutputKind::Signal;
        let takes = |kind| kind == InputKind::Signal;
        !self.ports.is_empty()
            || !self.plant_parameters.is_empty()
            || self.outputs.iter().any(|output| reads(output.kind))
            || self.inputs.iter().any(|input| takes(input.kind))
    }

    /// The place of a port of a name.
    #[must_use]
    pub fn port(&self, name: &str) -> Option<usize> {
        self.ports.iter().position(|port| port.name == name)
    }

    /// The outputs of the simulator that are needed, each once: those that are compared, then those that tell the motion of the
    /// ports.
    #[must_use]
    pub fn plant_outputs(&self) -> Vec<&str> {
        let ports = self.ports.iter();
        let motion = ports.flat_map(|port| [port.displacement.as_str(), port.velocity.as_str()]);
        let mut names: Vec<&str> = Vec::new();
        for name in self.outputs.iter().map(Output::signal).chain(motion) {
            if !names.contains(&name) {
                names.push(name);
            }
        }
        names
    }

    /// Refuses what a simulator and a model of masses cannot have together.
    pub(crate) fn check_plant(&self) -> Result<(), ModelError> {
        if !self.is_external() {
            return Ok(());
        }
        unique(
            "parameter",
            self.plant_parameters.iter().map(|p| p.name.as_str()),
        )?;
        self.plant_parameters
            .iter()
            .try_for_each(PlantParameter::check)?;
        self.ports.iter().try_for_each(PlantPort::check)?;
        let other = |table: &str, name: &str| {
            Err(ModelError::Shape {
                place: item(table, name),
                found: "a part of another kind beside a simulator".into(),
                needed: "a model whose inputs and outputs are all of the kind \"signal\", with ports and parameters but no masses"
                    .into(),
            })
        };
        if let Some(mass) = self.masses.first() {
            return other("mass", &mass.name);
        }
        let mut inputs = self.inputs.iter();
        if let Some(input) = inputs.find(|input| input.kind != InputKind::Signal) {
            return other("input", &input.channel);
        }
        let mut outputs = self.outputs.iter();
        if let Some(output) = outputs.find(|output| output.kind != OutputKind::Signal) {
            return other("output", &output.channel);
        }
        unique("input", self.inputs.iter().map(|input| input.at.as_str()))
    }
}

impl Output {
    /// The output of the simulator that a `signal` is: `at`, or the name of the channel.
    #[must_use]
    pub fn signal(&self) -> &str {
        self.at.as_deref().unwrap_or(&self.channel)
    }
}

impl PlantParameter {
    fn check(&self) -> Result<(), ModelError> {
        let place = item("parameter", &self.name);
        node_name(&place, &self.name)?;
        finite(&place, "value", self.value)?;
        check_uncertainty(&place, self.uncertainty)
    }
}

impl PlantPort {
    fn check(&self) -> Result<(), ModelError> {
        let place = item("port", &self.name);
        [&self.name, &self.displacement, &self.velocity]
            .into_iter()
            .try_for_each(|name| node_name(&place, name))
    }
}
