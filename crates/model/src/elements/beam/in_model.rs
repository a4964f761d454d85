//! What beams add to the model.

use super::Beam;
use crate::element::{Element, Table};
use crate::refuse::item;
use crate::{
    CoordinateKind, Drawing, Elements, Glyph, Mass, Model, ModelError, Node, Spring,
    StructuralMatrices,
};

impl Model {
    /// Adds a beam: its static spring, a free end and its modes go to the ends of [`Model::springs`] and
    /// [`Model::masses`].
    ///
    /// # Errors
    /// [`ModelError::Value`] for a value out of range, [`ModelError::Shape`] for two free ends.
    pub fn add_beam(&mut self, beam: Beam) -> Result<(), ModelError> {
        let beam = beam.checked()?;
        let mut coordinate = |name: String, value: f64| {
            self.masses.push(Mass {
                name,
                value: beam.mass_kg() * value,
                uncertainty: None,
            });
        };
        for (end, node) in beam.between.iter().enumerate() {
            if beam.is_own(node) {
                coordinate(node.clone(), beam.unit.end_mass[end][end]);
            }
        }
        for (mode, unit) in beam.unit.modes.iter().enumerate() {
            coordinate(beam.mode_name(mode + 1), unit.mass);
        }
        self.springs.push(Spring {
            name: beam.name.clone(),
            between: beam.between.clone(),
            stiffness: beam.unit.stiffness * beam.youngs_modulus * beam.slenderness(),
            uncertainty: beam.uncertainty,
        });
        self.elements.beams.push(beam);
        Ok(())
    }

    /// Young's modulus of a beam, Pa: from the spring, where effects change it.
    #[must_use]
    pub fn youngs_modulus(&self, beam: &Beam) -> f64 {
        let spring = self
            .beam_spring(beam)
            .map_or(0.0, |spring| spring.stiffness);
        spring / (beam.unit.stiffness * beam.slenderness())
    }

    /// The static spring of a beam.
    fn beam_spring(&self, beam: &Beam) -> Option<&Spring> {
        self.springs.iter().find(|spring| spring.name == beam.name)
    }

    /// The matrices of one beam alone, its spring and its own coordinates included.
    fn beam_alone(&self, beam: &Beam) -> Option<StructuralMatrices> {
        let mut part = Model {
            masses: self.masses.clone(),
            elements: Elements {
                bodies: self.elements.bodies.clone(),
                beams: vec![beam.clone()],
                ..Elements::default()
            },
            inputs: self.inputs.clone(),
            springs: vec![self.beam_spring(beam)?.clone()],
            ..Model::default()
        };
        for mass in &mut part.masses {
            let is_own = beam.is_own(&mass.name);
            mass.value = if is_own { mass.value } else { 0.0 };
        }
        part.matrices().ok()
    }
}

impl Table for Beam {
    fn add_to(self, model: &mut Model) -> Result<(), ModelError> {
        model.add_beam(self)
    }

    fn all_of(model: &Model) -> Vec<Beam> {
        let stated = |beam: &Beam| Beam {
            youngs_modulus: model.youngs_modulus(beam),
            ..beam.clone()
        };
        model.elements.beams.iter().map(stated).collect()
    }
}

impl Element for Beam {
    fn table(&self) -> &'static str {
        "beam"
    }

    fn name(&self) -> &str {
        &self.name
    }

    fn coordinates(&self) -> Vec<(String, CoordinateKind)> {
        let ends = self.between.iter().filter(|node| self.is_own(node));
        let ends = ends.map(|node| (node.clone(), CoordinateKind::End));
        let modes = (1..=self.modes).map(|mode| (self.mode_name(mode), CoordinateKind::Shape));
        ends.chain(modes).collect()
    }

    /// Adds to the matrices what the masses and the springs of the list do not hold of a beam, (2) of [`UnitBeam`]:
    /// the inertia of its ends and of its modes with them, stiffness and damping of the modes.
    fn add_matrices(
        &self,
        model: &Model,
        matrices: &mut StructuralMatrices,
    ) -> Result<(), ModelError> {
        let ends = model.resolve_pair(&self.between, || item("beam", &self.name))?;
        let mass = self.mass_kg();
        let spring = model.beam_spring(self).map_or(0.0, |s| s.stiffness);
        let mut inertia = |a: Node, b: Node, value: f64| {
            for (i, of_a) in a.terms() {
                for (j, of_b) in b.terms() {
                    matrices.mass_matrix[(i, j)] += of_a * of_b * value;
                }
            }
        };
        for (a, name) in self.between.iter().enumerate() {
            for b in 0..2 {
                // The inertia of an own end is in the list of masses.
                if !(a == b && self.is_own(name)) {
                    inertia(ends[a], ends[b], mass * self.unit.end_mass[a][b]);
                }
            }
        }
        for (mode, unit) in self.unit.modes.iter().enumerate() {
            let Some(Node::Dof(q)) = model.node(&self.mode_name(mode + 1)) else {
                continue;
            };
            for (end, coupling) in ends.into_iter().zip(unit.coupling) {
                inertia(end, Node::Dof(q), mass * coupling);
                inertia(Node::Dof(q), end, mass * coupling);
            }
            let stiffness = spring / self.unit.stiffness * unit.stiffness;
            matrices.stiffness_matrix[(q, q)] += stiffness;
            matrices.damping_matrix[(q, q)] +=
                2.0 * self.damping_ratio * (stiffness * mass * unit.mass).abs().sqrt();
        }
        Ok(())
    }

    fn base_inertia(&self, model: &Model) -> Vec<(usize, usize, f64)> {
        let ends = self.between.each_ref().map(|name| model.node(name));
        let [Some(a), Some(b)] = ends else {
            return vec![];
        };
        let mut found = vec![];
        for (base, other, [i, j]) in [(a, b, [0, 1]), (b, a, [1, 0])] {
            let Node::Base(base) = base else {
                continue;
            };
            let mut couple = |node: Node, value: f64| {
                found.extend(node.terms().map(|(dof, w)| (dof, base, w * value)));
            };
            couple(other, self.mass_kg() * self.unit.end_mass[i][j]);
            for (mode, unit) in self.unit.modes.iter().enumerate() {
                if let Some(q) = model.node(&self.mode_name(mode + 1)) {
                    couple(q, self.mass_kg() * unit.coupling[i]);
                }
            }
        }
        found
    }

    fn spring(&self) -> Option<&str> {
        Some(&self.name)
    }

    fn joined(&self, _: &Model) -> Vec<[String; 2]> {
        let modes = (1..=self.modes).map(|mode| self.mode_name(mode));
        let ends = &self.between;
        modes
            .flat_map(|mode| ends.iter().map(move |end| [end.clone(), mode.clone()]))
            .collect()
    }

    fn drawing(&self, _: &Model) -> Drawing {
        Drawing::Member {
            between: self.between.clone(),
            glyph: Glyph::Beam,
        }
    }

    fn values(&self, model: &Model) -> Vec<(&'static str, f64)> {
        vec![
            ("length", self.length),
            ("thickness", self.thickness),
            ("youngs_modulus", model.youngs_modulus(self)),
            ("density", self.density),
        ]
    }

    /// By the powers of the value in the mass, damping and stiffness of the beam: ρ b h L, √(k m) and E b h³/L³.
    fn derivative(&self, model: &Model, value: &str) -> Option<StructuralMatrices> {
        let (at, powers) = match value {
            "length" => (self.length, [1.0, -1.0, -3.0]),
            "thickness" => (self.thickness, [1.0, 2.0, 3.0]),
            "youngs_modulus" => (model.youngs_modulus(self), [0.0, 0.5, 1.0]),
            "density" => (self.density, [1.0, 0.5, 0.0]),
            _ => return None,
        };
        let [mass, damping, stiffness] = powers.map(|power| power / at);
        let mut part = model.beam_alone(self)?;
        part.mass_matrix *= faer::Scale(mass);
        part.damping_matrix *= faer::Scale(damping);
        part.stiffness_matrix *= faer::Scale(stiffness);
        Some(part)
    }
}
