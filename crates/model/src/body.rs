//! Rigid bodies with heave and roll, and the points on them.

use serde::{Deserialize, Serialize};

use crate::{Mass, Model, Node, node::BodyPoint};

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
/// m and J stand in [`Model::masses`] under the names of the two nodes, where effects change them.
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

impl Model {
    /// Adds a body: its two coordinates at the end of [`Model::masses`].
    pub fn add_body(&mut self, body: Body, mass_kg: f64, inertia_kg_m2: f64) {
        let coordinate = |name: String, value: f64| Mass {
            name,
            value,
            uncertainty: None,
        };
        self.masses.push(coordinate(body.name.clone(), mass_kg));
        self.masses.push(coordinate(body.roll(), inertia_kg_m2));
        self.bodies.push(body);
    }

    /// The names of all points of bodies.
    pub(crate) fn point_names(&self) -> impl Iterator<Item = String> + '_ {
        let bodies = self.bodies.iter();
        bodies.flat_map(|body| body.points.iter().map(|point| body.node_name(point)))
    }

    /// The node of a point of a body.
    pub(crate) fn body_point(&self, name: &str) -> Option<Node> {
        let (of, own) = name.rsplit_once('.')?;
        let body = self.bodies.iter().find(|body| body.name == of)?;
        let point = body.points.iter().find(|point| point.name == own)?;
        let place = |name: &str| self.masses.iter().position(|mass| mass.name == name);
        Some(Node::Point(BodyPoint::new(
            place(&body.name)?,
            place(&body.roll())?,
            point.offset_m,
        )))
    }

    /// The body that a node belongs to: its centre of mass, its roll or one of its points.
    #[must_use]
    pub fn body_of(&self, node: &str) -> Option<&Body> {
        self.bodies.iter().find(|body| {
            let mut points = body.points.iter();
            body.name == node
                || body.roll() == node
                || points.any(|point| body.node_name(point) == node)
        })
    }

    /// Whether a coordinate is the roll of a body, an angle where its other coordinates are displacements.
    #[must_use]
    pub fn is_roll(&self, coordinate: &str) -> bool {
        self.bodies.iter().any(|body| body.roll() == coordinate)
    }
}

/// `[[body]]` of a model file.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct BodyFile {
    name: String,
    mass: f64,
    inertia: f64,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    uncertainty: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    inertia_uncertainty: Option<f64>,
}

/// `[[point]]` of a model file.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct PointFile {
    pub(crate) name: String,
    pub(crate) body: String,
    offset: f64,
}

impl BodyFile {
    /// Adds the body without its points.
    pub(crate) fn add_to(self, model: &mut Model) {
        let body = Body {
            name: self.name,
            points: vec![],
        };
        model.add_body(body, self.mass, self.inertia);
        let stated = [self.inertia_uncertainty, self.uncertainty];
        for (mass, uncertainty) in model.masses.iter_mut().rev().zip(stated) {
            mass.uncertainty = uncertainty;
        }
    }

    /// The bodies of a model with the values of their coordinates.
    pub(crate) fn all_of(model: &Model) -> Vec<BodyFile> {
        let coordinate = |name: &str| model.masses.iter().find(|mass| mass.name == name);
        let file = |body: &Body| {
            let (heave, roll) = (coordinate(&body.name)?, coordinate(&body.roll())?);
            Some(BodyFile {
                name: body.name.clone(),
                mass: heave.value,
                inertia: roll.value,
                uncertainty: heave.uncertainty,
                inertia_uncertainty: roll.uncertainty,
            })
        };
        model.bodies.iter().filter_map(file).collect()
    }
}

impl PointFile {
    /// The point; `None` where the model has no such body.
    pub(crate) fn add_to(self, model: &mut Model) -> Option<()> {
        let mut bodies = model.bodies.iter_mut();
        let body = bodies.find(|body| body.name == self.body)?;
        body.points.push(Point {
            name: self.name,
            offset_m: self.offset,
        });
        Some(())
    }

    /// The points of a model.
    pub(crate) fn all_of(model: &Model) -> Vec<PointFile> {
        let of = |body: &Body, point: &Point| PointFile {
            name: point.name.clone(),
            body: body.name.clone(),
            offset: point.offset_m,
        };
        let bodies = model.bodies.iter();
        bodies
            .flat_map(|body| body.points.iter().map(move |point| of(body, point)))
            .collect()
    }
}
