//! What cylinders add to the model.

use super::Cylinder;
use crate::hydraulics::PRESSURE_UNIT_PA;
use crate::refuse::item;
use crate::{Mass, Model, ModelError, Node, StructuralMatrices};

impl Model {
    /// Adds a cylinder: its pressures become coordinates at the end of [`Model::masses`].
    ///
    /// # Errors
    /// [`ModelError::Value`] for a value out of range.
    pub fn add_cylinder(&mut self, cylinder: Cylinder) -> Result<(), ModelError> {
        cylinder.check()?;
        for name in cylinder.chambers() {
            self.push_coordinate(name);
        }
        self.cylinders.push(cylinder);
        Ok(())
    }

    /// A coordinate whose inertia follows from its element.
    pub(crate) fn push_coordinate(&mut self, name: String) {
        self.masses.push(Mass {
            name,
            value: 1.0,
            uncertainty: None,
        });
    }

    /// The chamber that a coordinate is the pressure of: cylinder and chamber, 0 or 1.
    #[must_use]
    pub fn chamber(&self, coordinate: &str) -> Option<(&Cylinder, usize)> {
        self.cylinders.iter().find_map(|cylinder| {
            let mut names = cylinder.chambers().into_iter();
            let chamber = names.position(|name| name == coordinate)?;
            Some((cylinder, chamber))
        })
    }

    /// The coordinates of the two pressures.
    pub(crate) fn chamber_dofs(&self, cylinder: &Cylinder) -> Option<[usize; 2]> {
        let [p1, p2] = cylinder.chambers().map(|name| self.dof(&name));
        Some([p1?, p2?])
    }

    /// Adds (1) to (3).
    pub(crate) fn add_cylinder_matrices(
        &self,
        cylinder: &Cylinder,
        matrices: &mut StructuralMatrices,
    ) -> Result<(), ModelError> {
        let place = || item("cylinder", &cylinder.name);
        let [a, b] = self.resolve_pair(&cylinder.between, place)?;
        let Some(pressures) = self.chamber_dofs(cylinder) else {
            return Ok(());
        };
        let unit = PRESSURE_UNIT_PA;
        let volumes = cylinder.volumes_m3();
        let damping = &mut matrices.damping_matrix;
        for (chamber, sign) in [(0, 1.0), (1, -1.0)] {
            let p = pressures[chamber];
            matrices.mass_matrix[(p, p)] = unit * unit * volumes[chamber] / cylinder.bulk_modulus;
            let area = sign * unit * cylinder.areas[chamber];
            let of_b = b.terms().map(|(i, weight)| (i, -weight));
            for (i, weight) in a.terms().chain(of_b) {
                damping[(p, i)] += area * weight;
                damping[(i, p)] -= area * weight;
            }
            damping[(p, p)] += unit * unit * (cylinder.leakage + cylinder.external_leakage);
            damping[(p, pressures[1 - chamber])] -= unit * unit * cylinder.leakage;
        }
        Ok(())
    }

    /// Adds the forces and flows of the pressures p₀, about which pressures are computed.
    pub(crate) fn add_cylinder_loads(&self, cylinder: &Cylinder, loads: &mut [f64]) {
        let [p1, p2] = cylinder.pressures;
        let force = cylinder.areas[0] * p1 - cylinder.areas[1] * p2;
        let ends = cylinder.between.each_ref().map(|name| self.node(name));
        for (node, sign) in ends.into_iter().zip([1.0, -1.0]) {
            node.unwrap_or(Node::Ground).push(sign * force, loads);
        }
        let past = cylinder.leakage * (p1 - p2);
        let out = cylinder.pressures.map(|p| cylinder.external_leakage * p);
        if let Some([q1, q2]) = self.chamber_dofs(cylinder) {
            loads[q1] -= PRESSURE_UNIT_PA * (past + out[0]);
            loads[q2] += PRESSURE_UNIT_PA * (past - out[1]);
        }
    }
}
