//! The values of a model file that the linear part of the plant depends on.

use crate::Model;

/// A value of the model file that the linear part of the plant depends on, by its place in the list.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, serde::Serialize, serde::Deserialize,
)]
#[serde(rename_all = "lowercase")]
pub enum Parameter {
    /// `value` of a mass.
    Mass(usize),
    /// `stiffness` of a spring.
    Spring(usize),
    /// `damping` of a damper.
    Damper(usize),
    /// `value` of a pendulum.
    Pendulum(usize),
    /// A value of an element, by the place of the element among all ([`Model::elements`], kind by kind) and that of the value
    /// among its own.
    Element([usize; 2]),
}

impl Model {
    /// The parameters that M, C and K depend on, in the order of the file.
    #[must_use]
    pub fn parameters(&self) -> Vec<Parameter> {
        let masses = self.masses.iter().enumerate();
        let masses = masses
            .filter(|(_, mass)| self.has_stated_inertia(&mass.name))
            .map(|(i, _)| Parameter::Mass(i));
        let springs = self.springs.iter().enumerate();
        let springs = springs
            .filter(|(_, spring)| !self.is_of_element(spring))
            .map(|(i, _)| Parameter::Spring(i));
        let elements = self.element_values().into_iter().map(Parameter::Element);
        let dampers = (0..self.dampers.len()).map(Parameter::Damper);
        let pendulums = (0..self.pendulums.len()).map(Parameter::Pendulum);
        masses
            .chain(springs)
            .chain(dampers)
            .chain(pendulums)
            .chain(elements)
            .collect()
    }

    /// The value of a parameter; `None` where the model has no such part.
    #[must_use]
    pub fn parameter_value(&self, parameter: Parameter) -> Option<f64> {
        match parameter {
            Parameter::Mass(i) => self.masses.get(i).map(|mass| mass.value),
            Parameter::Spring(i) => self.springs.get(i).map(|spring| spring.stiffness),
            Parameter::Damper(i) => self.dampers.get(i).map(|damper| damper.damping),
            Parameter::Pendulum(i) => self.pendulums.get(i).map(|pendulum| pendulum.value),
            Parameter::Element(place) => self.element_value(place).map(|(_, value)| value),
        }
    }

    /// Table and item of a parameter, such as `spring "cylinder"`.
    #[must_use]
    pub fn parameter_name(&self, parameter: Parameter) -> String {
        let named = |table: &str, name: Option<&String>| {
            format!("{table} \"{}\"", name.map_or("", String::as_str))
        };
        match parameter {
            Parameter::Mass(i) => {
                let name = self.masses.get(i).map(|part| &part.name);
                let is_roll = name.is_some_and(|name| self.is_roll(name));
                named(if is_roll { "inertia" } else { "mass" }, name)
            }
            Parameter::Spring(i) => named("spring", self.springs.get(i).map(|part| &part.name)),
            Parameter::Damper(i) => named("damper", self.dampers.get(i).map(|part| &part.name)),
            Parameter::Pendulum(i) => named("pendulum", self.pendulums.get(i).map(|part| &part.at)),
            Parameter::Element(place) => self.element_value_name(place),
        }
    }
}
