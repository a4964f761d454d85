//! Rigid bodies with heave and roll, and the points on them.

pub(crate) mod file;
mod in_model;

/// Last part of the name of the coordinate of a body's roll.
const ROLL: &str = "roll";

/// A rigid body that heaves and rolls by small angles, and the points on it,
///
/// ```text
/// m y″ = Σ F        J θ″ = Σ r F        a point at r:  y_r = y + r θ                                      (1)
/// ```
///
/// | Symbol | Meaning | Unit |
/// |---|---|---|
/// | m, y | mass; displacement of the centre of mass: the node of the body's name | kg, m |
/// | J, θ | moment of inertia about the centre of mass; angle: the node `name.roll` | kg m², rad |
/// | r | offset of a point along the body: the node `name.point` | m |
///
/// m and J stand in [`Model::masses`](crate::Model::masses) under the names of the two nodes, where effects change them.
#[derive(Debug, Clone, PartialEq)]
pub struct Body {
    /// Name of the body.
    pub name: String,
    /// Its points.
    pub points: Vec<Point>,
}

/// A point of a body.
#[derive(Debug, Clone, PartialEq)]
pub struct Point {
    /// Name on the body; the node is `body.name`.
    pub name: String,
    /// r, m, from the centre of mass, of either sign.
    pub offset_m: f64,
}

impl Body {
    /// Name of the coordinate of the roll.
    #[must_use]
    pub fn roll(&self) -> String {
        format!("{}.{ROLL}", self.name)
    }

    /// Name of the node of a point.
    #[must_use]
    pub fn node_name(&self, point: &Point) -> String {
        format!("{}.{}", self.name, point.name)
    }
}
