//! Beams between two nodes, condensed from finite elements to their ends and a few modes.

mod unit;

use serde::{Deserialize, Serialize};

use crate::check::{finite_positive, item, node_name};
use crate::{Mass, Model, ModelError, Node, Spring, StructuralMatrices};
use unit::UnitBeam;

/// Most finite elements of a beam: rounding grows with their fourth power.
const MOST_ELEMENTS: usize = 200;

/// An Euler-Bernoulli beam of rectangular section between two nodes, which bends across its thickness.
///
/// ```text
/// E I w⁗ + ρ b h ẅ = 0,    I = b h³/12                                                              (1)
/// w(s) = ψ_a(s) u_a + ψ_b(s) u_b + Σ φ_i(s) q_i                                                     (2)
/// ```
///
/// Finite elements of equal length with cubic shapes, condensed by Craig and Bampton: u are the displacements of the
/// two nodes, ψ the static shapes between them, φ_i the modes with both ends held, scaled to a largest displacement of 1.
/// At its ends the slope of the beam is held at zero. A node that is named after the beam itself, `name.end`, is an end
/// that is free to move and to turn: a coordinate of its own, on which members, inputs and outputs may sit.
///
/// The static stiffness, 12 E I/L³ (3 E I/L³ with a free end), is a spring of the beam's name among
/// [`Model::springs`]: whatever changes it changes Young's modulus, and the stiffness of the modes with it. The modes
/// are coordinates `name.mode1`, `name.mode2`, ... among [`Model::masses`].
///
/// Valid for h ≪ L (no shear, no rotary inertia) and small deflections. Reference: `craig-bampton1968`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Beam {
    /// Unique among beams and springs.
    pub name: String,
    /// The two nodes.
    pub between: [String; 2],
    /// L, m.
    pub length: f64,
    /// b, m.
    pub width: f64,
    /// h, m.
    pub thickness: f64,
    /// E, Pa.
    pub youngs_modulus: f64,
    /// ρ, kg/m³.
    pub density: f64,
    /// Number of finite elements, 2 to 200.
    #[serde(default = "usual_elements")]
    pub elements: usize,
    /// Modes kept, lowest first.
    #[serde(default = "usual_modes")]
    pub modes: usize,
    /// Damping ratio of the modes with both ends held.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub damping_ratio: f64,
    /// How well Young's modulus is known: relative standard deviation.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub uncertainty: Option<f64>,
    /// The beam with L = E I = ρ b h = 1.
    #[serde(skip)]
    unit: UnitBeam,
}

fn usual_elements() -> usize {
    20
}

fn usual_modes() -> usize {
    1
}

#[allow(clippy::trivially_copy_pass_by_ref)]
fn is_zero(value: &f64) -> bool {
    *value == 0.0
}

/// A value of a beam that its matrices depend on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum BeamValue {
    /// L.
    Length,
    /// h.
    Thickness,
    /// E.
    YoungsModulus,
    /// ρ.
    Density,
}

impl BeamValue {
    /// All of them.
    pub const ALL: [BeamValue; 4] = [
        BeamValue::Length,
        BeamValue::Thickness,
        BeamValue::YoungsModulus,
        BeamValue::Density,
    ];

    /// As the model file calls it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            BeamValue::Length => "length",
            BeamValue::Thickness => "thickness",
            BeamValue::YoungsModulus => "youngs_modulus",
            BeamValue::Density => "density",
        }
    }

    /// Powers of the value in the mass, damping and stiffness of the beam: ρ b h L, √(k m) and E b h³/L³.
    pub(crate) fn powers(self) -> [f64; 3] {
        match self {
            BeamValue::Length => [1.0, -1.0, -3.0],
            BeamValue::Thickness => [1.0, 2.0, 3.0],
            BeamValue::YoungsModulus => [0.0, 0.5, 1.0],
            BeamValue::Density => [1.0, 0.5, 0.0],
        }
    }
}

impl Beam {
    /// Whether a node is a free end of this beam, named after it.
    fn is_own(&self, node: &str) -> bool {
        let own = node.strip_prefix(self.name.as_str());
        own.is_some_and(|rest| rest.starts_with('.'))
    }

    /// Name of the coordinate of a mode, from 1.
    fn mode_name(&self, mode: usize) -> String {
        format!("{}.mode{mode}", self.name)
    }

    /// Whether a coordinate is one of the modes.
    pub(crate) fn is_mode(&self, coordinate: &str) -> bool {
        (1..=self.modes).any(|mode| self.mode_name(mode) == coordinate)
    }

    /// ρ b h L, kg.
    #[must_use]
    pub fn mass_kg(&self) -> f64 {
        self.density * self.width * self.thickness * self.length
    }

    /// b h³/(12 L³), m: stiffness over Young's modulus, of a unit beam of stiffness 1.
    fn slenderness(&self) -> f64 {
        self.width * (self.thickness / self.length).powi(3) / 12.0
    }

    fn checked(mut self) -> Result<Beam, ModelError> {
        let place = item("beam", &self.name);
        node_name(&place, &self.name)?;
        let sizes = [
            ("length", self.length),
            ("width", self.width),
            ("thickness", self.thickness),
            ("youngs_modulus", self.youngs_modulus),
            ("density", self.density),
        ];
        for (quantity, value) in sizes {
            finite_positive(&place, quantity, value)?;
        }
        let refused = |quantity: &str, found: f64, needed| ModelError::Value {
            place: place.clone(),
            quantity: quantity.into(),
            found,
            needed,
        };
        if !(0.0..1.0).contains(&self.damping_ratio) {
            let needed = "0 or more and below 1";
            return Err(refused("damping_ratio", self.damping_ratio, needed));
        }
        if !(2..=MOST_ELEMENTS).contains(&self.elements) {
            return Err(refused("elements", self.elements as f64, "2 to 200"));
        }
        if self.modes > 2 * self.elements - 2 {
            let needed = "not above twice the elements less two";
            return Err(refused("modes", self.modes as f64, needed));
        }
        let free = [0, 1].map(|end| self.is_own(&self.between[end]));
        if free == [true, true] || self.between[0] == self.between[1] {
            return Err(ModelError::Shape {
                place,
                found: format!("between = {:?}", self.between),
                needed: "two different nodes, one end free at most".into(),
            });
        }
        self.unit = UnitBeam::new(self.elements, self.modes, free)?;
        Ok(self)
    }
}

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
