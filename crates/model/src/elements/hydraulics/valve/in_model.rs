//! What valves add to the model.

use std::f64::consts::TAU;

use super::Valve;
use crate::element::{Element, Table};
use crate::elements::block::Signal;
use crate::elements::hydraulics::PRESSURE_UNIT_PA;
use crate::refuse::item;
use crate::{CoordinateKind, Cylinder, Drawing, Model, ModelError, StructuralMatrices};

impl Model {
    /// Adds a valve to a cylinder that the model has: its spool becomes a coordinate at the end of [`Model::masses`].
    ///
    /// # Errors
    /// [`ModelError::Value`] for a value out of range, [`ModelError::Shape`] for an unknown cylinder.
    pub fn add_valve(&mut self, valve: Valve) -> Result<(), ModelError> {
        valve.check()?;
        if valve.fed(self).is_none() {
            return Err(ModelError::Shape {
                place: item("valve", &valve.name),
                found: format!("cylinder = \"{}\"", valve.cylinder),
                needed: "the name of a [[cylinder]]".into(),
            });
        }
        self.push_coordinate(valve.spool());
        self.elements.valves.push(valve);
        Ok(())
    }
}

impl Valve {
    /// The cylinder that it feeds.
    fn fed<'a>(&self, model: &'a Model) -> Option<&'a Cylinder> {
        let mut cylinders = model.elements.cylinders.iter();
        cylinders.find(|cylinder| cylinder.name == self.cylinder)
    }
}

impl Table for Valve {
    fn add_to(self, model: &mut Model) -> Result<(), ModelError> {
        model.add_valve(self)
    }

    fn all_of(model: &Model) -> Vec<Valve> {
        model.elements.valves.clone()
    }
}

impl Element for Valve {
    fn table(&self) -> &'static str {
        "valve"
    }

    fn name(&self) -> &str {
        &self.name
    }

    fn coordinates(&self) -> Vec<(String, CoordinateKind)> {
        vec![(self.spool(), CoordinateKind::Signal)]
    }

    fn check(&self, model: &Model) -> Result<(), ModelError> {
        let from = self.from.as_ref();
        match from.filter(|from| model.block(from).is_none()) {
            Some(from) => Err(ModelError::Shape {
                place: item("valve", &self.name),
                found: format!("from = \"{from}\""),
                needed: "the name of a [[block]]".into(),
            }),
            None => Ok(()),
        }
    }

    /// Adds (1) and the slope of the flows over the spool at the pressures p₀.
    fn add_matrices(
        &self,
        model: &Model,
        matrices: &mut StructuralMatrices,
    ) -> Result<(), ModelError> {
        let (Some(x), Some(cylinder)) = (model.dof(&self.spool()), self.fed(model)) else {
            return Ok(());
        };
        let omega = TAU * self.natural_freq;
        matrices.mass_matrix[(x, x)] = 1.0 / (omega * omega);
        matrices.damping_matrix[(x, x)] += 2.0 * self.damping_ratio / omega;
        matrices.stiffness_matrix[(x, x)] += 1.0;
        let chambers = model.chamber_dofs(cylinder).into_iter().flatten();
        for (chamber, p) in chambers.enumerate() {
            let gain = self.opening_gain(chamber, cylinder.pressures[chamber]);
            matrices.stiffness_matrix[(p, x)] -= PRESSURE_UNIT_PA * gain;
        }
        Ok(())
    }

    fn actions(&self, model: &Model) -> Result<Vec<(usize, f64, Signal)>, ModelError> {
        let from = self.from.as_ref().and_then(|name| model.block(name));
        match (from, model.dof(&self.spool())) {
            (Some(block), Some(spool)) => Ok(vec![(spool, 1.0, model.output_of(block)?)]),
            _ => Ok(vec![]),
        }
    }

    fn joined(&self, model: &Model) -> Vec<[String; 2]> {
        let own = |name: String| [self.name.clone(), name];
        let mut pairs = vec![own(self.spool())];
        let chambers = self.fed(model).map(Cylinder::chambers);
        pairs.extend(chambers.into_iter().flatten().map(own));
        pairs.extend(self.from.clone().map(|from| [from, self.name.clone()]));
        pairs
    }

    fn drawing(&self, model: &Model) -> Drawing {
        let chambers = self.fed(model).map(Cylinder::chambers);
        let measured = [self.name.clone()].into_iter();
        Drawing::Box {
            signals: self.from.iter().map(|from| ("", from.clone())).collect(),
            lines: vec![format!("feeds {}", self.cylinder)],
            measured: measured.chain(chambers.into_iter().flatten()).collect(),
            is_last: true,
        }
    }

    fn values(&self, _: &Model) -> Vec<(&'static str, f64)> {
        vec![
            ("rated_flow", self.rated_flow),
            ("natural_freq", self.natural_freq),
            ("damping_ratio", self.damping_ratio),
            ("supply", self.supply),
        ]
    }

    fn scale(&mut self, value: &str, factor: f64) {
        match value {
            "rated_flow" => self.rated_flow *= factor,
            "natural_freq" => self.natural_freq *= factor,
            "damping_ratio" => self.damping_ratio *= factor,
            "supply" => self.supply *= factor,
            _ => (),
        }
    }
}
