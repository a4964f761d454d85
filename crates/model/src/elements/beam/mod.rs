//! Beams between two nodes, condensed from finite elements to their ends and a few modes.

mod in_model;
mod unit;

use serde::{Deserialize, Serialize};

use crate::ModelError;
use crate::refuse::{finite_positive, item, node_name};
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
/// [`Model::springs`](crate::Model::springs): whatever changes it changes Young's modulus, and the stiffness of the modes with it. The modes
/// are coordinates `name.mode1`, `name.mode2`, ... among [`Model::masses`](crate::Model::masses).
///
/// Valid for h ≪ L (no shear, no rotary inertia) and small deflections. Reference: `craig-bampton1968`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Beam {
    /// Unique among beams and springs.
    pub name: String,
    /// The two nodes.
    #[serde(deserialize_with = "crate::two::two")]
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
