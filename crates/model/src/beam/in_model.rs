//! What beams add to the model.

use super::{Beam, BeamValue};
use crate::refuse::item;
use crate::{Mass, Model, ModelError, Node, Spring, StructuralMatrices};

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
        self.beams.push(beam);
        Ok(())
    }

    /// The beams as the model file has them: Young's modulus from the spring, where effects change it.
    #[must_use]
    pub fn stated_beams(&self) -> Vec<Beam> {
        let beams = self.beams.iter().zip(0..);
        beams
            .map(|(beam, i)| Beam {
                youngs_modulus: self.beam_value(i, BeamValue::YoungsModulus).unwrap_or(0.0),
                ..beam.clone()
            })
            .collect()
    }

    /// A value of a beam; `None` where the model has no such beam.
    #[must_use]
    pub fn beam_value(&self, beam: usize, value: BeamValue) -> Option<f64> {
        let beam = self.beams.get(beam)?;
        Some(match value {
            BeamValue::Length => beam.length,
            BeamValue::Thickness => beam.thickness,
            BeamValue::Density => beam.density,
            BeamValue::YoungsModulus => {
                self.beam_spring(beam)?.stiffness / (beam.unit.stiffness * beam.slenderness())
            }
        })
    }

    /// The static spring of a beam.
    fn beam_spring(&self, beam: &Beam) -> Option<&Spring> {
        self.springs.iter().find(|spring| spring.name == beam.name)
    }

    /// Whether a spring is the static stiffness of a beam.
    #[must_use]
    pub fn is_of_beam(&self, spring: &Spring) -> bool {
        self.beams.iter().any(|beam| beam.name == spring.name)
    }

    /// Whether a coordinate is a free end of a beam.
    fn is_beam_end(&self, coordinate: &str) -> bool {
        let mut beams = self.beams.iter();
        beams.any(|beam| beam.is_own(coordinate) && beam.between.iter().any(|n| n == coordinate))
    }

    /// Whether a coordinate is a mode of a beam: a shape, not a place.
    #[must_use]
    pub fn is_beam_mode(&self, coordinate: &str) -> bool {
        let mut beams = self.beams.iter();
        beams.any(|beam| beam.is_mode(coordinate))
    }

    /// Whether a coordinate belongs to a beam: a mode or a free end.
    #[must_use]
    pub fn is_beam_coordinate(&self, coordinate: &str) -> bool {
        self.is_beam_mode(coordinate) || self.is_beam_end(coordinate)
    }

    /// Adds to the matrices what the masses and the springs of the list do not hold of a beam, (2) of [`UnitBeam`]:
    /// the inertia of its ends and of its modes with them, stiffness and damping of the modes.
    pub(crate) fn add_beam_matrices(
        &self,
        beam: &Beam,
        matrices: &mut StructuralMatrices,
    ) -> Result<(), ModelError> {
        let ends = self.resolve_pair(&beam.between, || item("beam", &beam.name))?;
        let mass = beam.mass_kg();
        let spring = self.beam_spring(beam).map_or(0.0, |s| s.stiffness);
        let mut inertia = |a: Node, b: Node, value: f64| {
            for (i, of_a) in a.terms() {
                for (j, of_b) in b.terms() {
                    matrices.mass_matrix[(i, j)] += of_a * of_b * value;
                }
            }
        };
        for (a, name) in beam.between.iter().enumerate() {
            for b in 0..2 {
                // The inertia of an own end is in the list of masses.
                if !(a == b && beam.is_own(name)) {
                    inertia(ends[a], ends[b], mass * beam.unit.end_mass[a][b]);
                }
            }
        }
        for (mode, unit) in beam.unit.modes.iter().enumerate() {
            let Some(Node::Dof(q)) = self.node(&beam.mode_name(mode + 1)) else {
                continue;
            };
            for (end, coupling) in ends.into_iter().zip(unit.coupling) {
                inertia(end, Node::Dof(q), mass * coupling);
                inertia(Node::Dof(q), end, mass * coupling);
            }
            let stiffness = spring / beam.unit.stiffness * unit.stiffness;
            matrices.stiffness_matrix[(q, q)] += stiffness;
            matrices.damping_matrix[(q, q)] +=
                2.0 * beam.damping_ratio * (stiffness * mass * unit.mass).abs().sqrt();
        }
        Ok(())
    }

    /// The matrices of one beam alone, its spring and its own coordinates included.
    pub(crate) fn beam_alone(&self, beam: usize) -> Option<StructuralMatrices> {
        let beam = self.beams.get(beam)?;
        let mut part = Model {
            masses: self.masses.clone(),
            bodies: self.bodies.clone(),
            inputs: self.inputs.clone(),
            springs: vec![self.beam_spring(beam)?.clone()],
            beams: vec![beam.clone()],
            ..Model::default()
        };
        for mass in &mut part.masses {
            let is_own = part.beams[0].is_own(&mass.name);
            mass.value = if is_own { mass.value } else { 0.0 };
        }
        part.matrices().ok()
    }

    /// Mass that couples each coordinate to the acceleration of each moving base through the beams, kg: coordinate, base,
    /// value.
    #[must_use]
    pub fn base_inertia(&self) -> Vec<(usize, usize, f64)> {
        let mut found = vec![];
        for beam in &self.beams {
            let ends = beam.between.each_ref().map(|name| self.node(name));
            let [Some(a), Some(b)] = ends else {
                continue;
            };
            for (base, other, [i, j]) in [(a, b, [0, 1]), (b, a, [1, 0])] {
                let Node::Base(base) = base else {
                    continue;
                };
                let mut couple = |node: Node, value: f64| {
                    found.extend(node.terms().map(|(dof, w)| (dof, base, w * value)));
                };
                couple(other, beam.mass_kg() * beam.unit.end_mass[i][j]);
                for (mode, unit) in beam.unit.modes.iter().enumerate() {
                    if let Some(q) = self.node(&beam.mode_name(mode + 1)) {
                        couple(q, beam.mass_kg() * unit.coupling[i]);
                    }
                }
            }
        }
        found
    }
}
