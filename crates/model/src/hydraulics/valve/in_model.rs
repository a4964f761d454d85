//! What valves add to the model.

use std::f64::consts::TAU;

use super::Valve;
use crate::hydraulics::PRESSURE_UNIT_PA;
use crate::refuse::item;
use crate::{Model, ModelError, StructuralMatrices};

impl Model {
    /// Adds a valve to a cylinder that the model has: its spool becomes a coordinate at the end of [`Model::masses`].
    ///
    /// # Errors
    /// [`ModelError::Value`] for a value out of range, [`ModelError::Shape`] for an unknown cylinder.
    pub fn add_valve(&mut self, valve: Valve) -> Result<(), ModelError> {
        valve.check()?;
        let mut cylinders = self.cylinders.iter();
        if !cylinders.any(|cylinder| cylinder.name == valve.cylinder) {
            return Err(ModelError::Shape {
                place: item("valve", &valve.name),
                found: format!("cylinder = \"{}\"", valve.cylinder),
                needed: "the name of a [[cylinder]]".into(),
            });
        }
        self.push_coordinate(valve.spool());
        self.valves.push(valve);
        Ok(())
    }

    /// Adds (1) and the slope of the flows over the spool at the pressures p₀.
    pub(crate) fn add_valve_matrices(&self, valve: &Valve, matrices: &mut StructuralMatrices) {
        let mut cylinders = self.cylinders.iter();
        let cylinder = cylinders.find(|cylinder| cylinder.name == valve.cylinder);
        let (Some(x), Some(cylinder)) = (self.dof(&valve.spool()), cylinder) else {
            return;
        };
        let omega = TAU * valve.natural_freq;
        matrices.mass_matrix[(x, x)] = 1.0 / (omega * omega);
        matrices.damping_matrix[(x, x)] += 2.0 * valve.damping_ratio / omega;
        matrices.stiffness_matrix[(x, x)] += 1.0;
        for (chamber, p) in self
            .chamber_dofs(cylinder)
            .into_iter()
            .flatten()
            .enumerate()
        {
            let gain = valve.opening_gain(chamber, cylinder.pressures[chamber]);
            matrices.stiffness_matrix[(p, x)] -= PRESSURE_UNIT_PA * gain;
        }
    }
}
