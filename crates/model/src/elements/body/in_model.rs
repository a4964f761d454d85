//! What bodies add to the model.

use super::Body;
use crate::element::Element;
use crate::node::BodyPoint;
use crate::refuse::{finite, item, node_name};
use crate::{CoordinateKind, Drawing, Mass, Model, ModelError, Node};

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
        self.elements.bodies.push(body);
    }

    /// The names of all points of bodies.
    pub(crate) fn point_names(&self) -> impl Iterator<Item = String> + '_ {
        let bodies = self.elements.bodies.iter();
        bodies.flat_map(|body| body.points.iter().map(|point| body.node_name(point)))
    }

    /// The node of a point of a body.
    pub(crate) fn body_point(&self, name: &str) -> Option<Node> {
        let (of, own) = name.rsplit_once('.')?;
        let body = self.elements.bodies.iter().find(|body| body.name == of)?;
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
        self.elements.bodies.iter().find(|body| {
            let mut points = body.points.iter();
            body.name == node
                || body.roll() == node
                || points.any(|point| body.node_name(point) == node)
        })
    }
}

impl Element for Body {
    fn table(&self) -> &'static str {
        "body"
    }

    fn name(&self) -> &str {
        &self.name
    }

    fn coordinates(&self) -> Vec<(String, CoordinateKind)> {
        vec![
            (self.name.clone(), CoordinateKind::Place),
            (self.roll(), CoordinateKind::Roll),
        ]
    }

    fn check(&self, _: &Model) -> Result<(), ModelError> {
        for point in &self.points {
            let place = item("point", &self.node_name(point));
            node_name(&place, &point.name)?;
            finite(&place, "offset", point.offset_m)?;
        }
        Ok(())
    }

    fn joined(&self, _: &Model) -> Vec<[String; 2]> {
        let points = self.points.iter().map(|point| self.node_name(point));
        let nodes = points.chain([self.roll()]);
        nodes.map(|node| [self.name.clone(), node]).collect()
    }

    fn drawing(&self, _: &Model) -> Drawing {
        let points = self.points.iter().map(|point| self.node_name(point));
        Drawing::Rigid(points.map(|node| [self.name.clone(), node]).collect())
    }
}
