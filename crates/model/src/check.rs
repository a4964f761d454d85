//! The checks that make a list of parts a model.

use crate::refuse::{check_gain, check_uncertainty, finite, item, node_name, unique};
use crate::{CoordinateKind, Location, Model, ModelError, Node, OutputKind};

impl Model {
    /// Checks that the parts make a model; [`Model::from_toml`] has done so.
    ///
    /// # Errors
    /// The first fault found, with its place.
    pub fn check(&self) -> Result<(), ModelError> {
        self.check_plant()?;
        self.check_masses()?;
        self.check_members()?;
        self.check_inputs()?;
        self.check_outputs()?;
        self.check_forces()?;
        for element in self.elements.each() {
            element.check(self)?;
        }
        self.check_laws()?;
        for (i, effect) in self.effects.iter().enumerate() {
            let place = format!("[[effect]] {} \"{}\"", i + 1, effect.kind);
            self.check_location(&effect.at, &place)?;
            for (name, &value) in &effect.parameters {
                finite(&place, name, value)?;
            }
        }
        Ok(())
    }

    fn check_masses(&self) -> Result<(), ModelError> {
        let points: Vec<String> = self.point_names().collect();
        let names = self.masses.iter().map(|m| m.name.as_str());
        let names = names.chain(self.base_nodes());
        let names = names.chain(self.ports.iter().map(|port| port.name.as_str()));
        unique("mass", names.chain(points.iter().map(String::as_str)))?;
        for mass in &self.masses {
            let [table, quantity, needed] = self.told_mass(&mass.name);
            let place = item(table, &mass.name);
            node_name(&place, &mass.name)?;
            if !(mass.value.is_finite() && mass.value > 0.0) {
                return Err(ModelError::Value {
                    place,
                    quantity: quantity.into(),
                    found: mass.value,
                    needed,
                });
            }
            check_uncertainty(&place, mass.uncertainty)?;
        }
        Ok(())
    }

    /// Table and key of the model file that the inertia of a coordinate stands in, and what it must be.
    fn told_mass(&self, name: &str) -> [&'static str; 3] {
        match self.coordinate_kind(name) {
            Some(CoordinateKind::Roll) => ["body", "inertia", "a positive moment of inertia"],
            Some(CoordinateKind::Place) => ["body", "mass", "a positive mass"],
            _ => ["mass", "value", "a positive mass"],
        }
    }

    fn check_members(&self) -> Result<(), ModelError> {
        unique("spring", self.springs.iter().map(|s| s.name.as_str()))?;
        unique("damper", self.dampers.iter().map(|d| d.name.as_str()))?;
        for spring in &self.springs {
            let place = item("spring", &spring.name);
            self.check_pair(&spring.between, &place)?;
            finite(&place, "stiffness", spring.stiffness)?;
            check_uncertainty(&place, spring.uncertainty)?;
        }
        for damper in &self.dampers {
            let place = item("damper", &damper.name);
            self.check_pair(&damper.between, &place)?;
            finite(&place, "damping", damper.damping)?;
            check_uncertainty(&place, damper.uncertainty)?;
        }
        Ok(())
    }

    pub(crate) fn check_pair(&self, pair: &[String; 2], place: &str) -> Result<(), ModelError> {
        self.resolve_pair(pair, || place.to_string())?;
        if pair[0] == pair[1] {
            return Err(ModelError::Shape {
                place: place.into(),
                found: format!("both ends are \"{}\"", pair[0]),
                needed: "two different nodes".into(),
            });
        }
        Ok(())
    }

    fn check_inputs(&self) -> Result<(), ModelError> {
        unique("input", self.inputs.iter().map(|i| i.channel.as_str()))?;
        for input in &self.inputs {
            let place = item("input", &input.channel);
            check_gain(&place, input.gain)?;
            check_uncertainty(&place, input.uncertainty)?;
            input.check_between_samples()?;
            self.check_input(input)?;
        }
        Ok(())
    }

    fn check_outputs(&self) -> Result<(), ModelError> {
        if self.outputs.is_empty() {
            return Err(ModelError::Shape {
                place: format!("model \"{}\"", self.name),
                found: "no [[output]]".into(),
                needed: "at least one output to compare".into(),
            });
        }
        unique("output", self.outputs.iter().map(|o| o.channel.as_str()))?;
        for output in &self.outputs {
            let place = item("output", &output.channel);
            check_gain(&place, output.gain)?;
            check_uncertainty(&place, output.uncertainty)?;
            let force = output.kind == OutputKind::Force;
            match (&output.at, &output.between) {
                (_, None) if output.kind == OutputKind::Signal => {}
                (Some(_), None) if !force => {
                    self.reading(output)?;
                }
                (None, Some(pair)) if force => self.check_pair(pair, &place)?,
                _ => {
                    return Err(ModelError::Shape {
                        place,
                        found: "a place that does not go with the kind".into(),
                        needed: "at = \"node\" for a motion, between = [\"a\", \"b\"] for a force"
                            .into(),
                    });
                }
            }
        }
        Ok(())
    }

    fn check_forces(&self) -> Result<(), ModelError> {
        for load in &self.loads {
            let place = item("load", &load.at);
            self.check_mass(&load.at, &place)?;
            finite(&place, "value", load.value)?;
            check_uncertainty(&place, load.uncertainty)?;
        }
        for pendulum in &self.pendulums {
            let place = item("pendulum", &pendulum.at);
            self.check_mass(&pendulum.at, &place)?;
            finite(&place, "value", pendulum.value)?;
            check_uncertainty(&place, pendulum.uncertainty)?;
        }
        Ok(())
    }

    pub(crate) fn check_mass(&self, name: &str, place: &str) -> Result<(), ModelError> {
        if matches!(
            self.node(name),
            Some(Node::Dof(_) | Node::Point(_) | Node::Port(_))
        ) {
            return Ok(());
        }
        Err(ModelError::UnknownNode {
            place: place.into(),
            found: name.into(),
            known: self
                .masses
                .iter()
                .map(|mass| mass.name.clone())
                .chain(self.point_names())
                .chain(self.ports.iter().map(|port| port.name.clone()))
                .collect::<Vec<_>>()
                .join(", "),
        })
    }

    /// Checks that a location names what the model has.
    ///
    /// # Errors
    /// [`ModelError::UnknownNode`] or [`ModelError::UnknownChannel`], with `place` in front.
    pub fn check_location(&self, at: &Location, place: &str) -> Result<(), ModelError> {
        let channel = |found: &String, known: Vec<&str>| {
            if known.contains(&found.as_str()) {
                return Ok(());
            }
            Err(ModelError::UnknownChannel {
                place: place.into(),
                found: found.clone(),
                known: known.join(", "),
            })
        };
        match at {
            Location::Between(pair) => self.check_pair(pair, place),
            Location::Mass(mass) => self.check_mass(mass, place),
            Location::Input(name) => channel(
                name,
                self.inputs.iter().map(|i| i.channel.as_str()).collect(),
            ),
            Location::Channel(name) => channel(
                name,
                self.outputs.iter().map(|o| o.channel.as_str()).collect(),
            ),
            Location::Parameter(name) => {
                let names = self.plant_parameters.iter();
                let known: Vec<&str> = names.map(|p| p.name.as_str()).collect();
                if known.contains(&name.as_str()) {
                    return Ok(());
                }
                Err(ModelError::Shape {
                    place: place.into(),
                    found: format!("parameter = \"{name}\""),
                    needed: format!("the name of a [[parameter]]: {}", known.join(", ")),
                })
            }
        }
    }
}
