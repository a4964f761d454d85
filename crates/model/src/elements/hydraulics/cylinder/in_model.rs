//! What cylinders add to the model.

use super::Cylinder;
use crate::element::{Element, Table};
use crate::elements::hydraulics::PRESSURE_UNIT_PA;
use crate::refuse::item;
use crate::{CoordinateKind, Drawing, Glyph, Model, ModelError, Node, StructuralMatrices};

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
        self.elements.cylinders.push(cylinder);
        Ok(())
    }

    /// The chamber that a coordinate is the pressure of: cylinder and chamber, 0 or 1.
    #[must_use]
    pub fn chamber(&self, coordinate: &str) -> Option<(&Cylinder, usize)> {
        self.elements.cylinders.iter().find_map(|cylinder| {
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
}

impl Table for Cylinder {
    fn add_to(self, model: &mut Model) -> Result<(), ModelError> {
        model.add_cylinder(self)
    }

    fn all_of(model: &Model) -> Vec<Cylinder> {
        model.elements.cylinders.clone()
    }
}

impl Element for Cylinder {
    fn table(&self) -> &'static str {
        "cylinder"
    }

    fn name(&self) -> &str {
        &self.name
    }

    fn coordinates(&self) -> Vec<(String, CoordinateKind)> {
        let rate = CoordinateKind::Rate {
            unit: PRESSURE_UNIT_PA,
        };
        self.chambers().map(|name| (name, rate)).to_vec()
    }

    fn check(&self, model: &Model) -> Result<(), ModelError> {
        model.check_pair(&self.between, &item("cylinder", &self.name))
    }

    /// Adds (1) to (3).
    fn add_matrices(
        &self,
        model: &Model,
        matrices: &mut StructuralMatrices,
    ) -> Result<(), ModelError> {
        let place = || item("cylinder", &self.name);
        let [a, b] = model.resolve_pair(&self.between, place)?;
        let Some(pressures) = model.chamber_dofs(self) else {
            return Ok(());
        };
        let unit = PRESSURE_UNIT_PA;
        let volumes = self.volumes_m3();
        let damping = &mut matrices.damping_matrix;
        for (chamber, sign) in [(0, 1.0), (1, -1.0)] {
            let p = pressures[chamber];
            matrices.mass_matrix[(p, p)] = unit * unit * volumes[chamber] / self.bulk_modulus;
            let area = sign * unit * self.areas[chamber];
            let of_b = b.terms().map(|(i, weight)| (i, -weight));
            for (i, weight) in a.terms().chain(of_b) {
                damping[(p, i)] += area * weight;
                damping[(i, p)] -= area * weight;
            }
            damping[(p, p)] += unit * unit * (self.leakage + self.external_leakage);
            damping[(p, pressures[1 - chamber])] -= unit * unit * self.leakage;
        }
        Ok(())
    }

    /// Adds the forces and flows of the pressures p₀, about which pressures are computed.
    fn add_loads(&self, model: &Model, loads: &mut [f64]) {
        let [p1, p2] = self.pressures;
        let force = self.areas[0] * p1 - self.areas[1] * p2;
        let ends = self.between.each_ref().map(|name| model.node(name));
        for (node, sign) in ends.into_iter().zip([1.0, -1.0]) {
            node.unwrap_or(Node::Ground).push(sign * force, loads);
        }
        let past = self.leakage * (p1 - p2);
        let out = self.pressures.map(|p| self.external_leakage * p);
        if let Some([q1, q2]) = model.chamber_dofs(self) {
            loads[q1] -= PRESSURE_UNIT_PA * (past + out[0]);
            loads[q2] += PRESSURE_UNIT_PA * (past - out[1]);
        }
    }

    fn joined(&self, _: &Model) -> Vec<[String; 2]> {
        let mut pairs = vec![self.between.clone()];
        for end in &self.between {
            pairs.extend(self.chambers().map(|chamber| [end.clone(), chamber]));
        }
        pairs
    }

    fn drawing(&self, _: &Model) -> Drawing {
        Drawing::Member {
            between: self.between.clone(),
            glyph: Glyph::Cylinder,
        }
    }

    fn values(&self, _: &Model) -> Vec<(&'static str, f64)> {
        vec![
            ("bulk_modulus", self.bulk_modulus),
            ("areas[0]", self.areas[0]),
            ("areas[1]", self.areas[1]),
            ("leakage", self.leakage),
        ]
    }

    fn scale(&mut self, value: &str, factor: f64) {
        match value {
            "bulk_modulus" => self.bulk_modulus *= factor,
            "areas[0]" => self.areas[0] *= factor,
            "areas[1]" => self.areas[1] *= factor,
            "leakage" => self.leakage *= factor,
            _ => (),
        }
    }
}
