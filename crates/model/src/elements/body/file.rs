//! Bodies and their points as the model file has them.

use serde::{Deserialize, Serialize};

use super::{Body, Point};
use crate::element::Table;
use crate::refuse::item;
use crate::{Model, ModelError};

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
    name: String,
    body: String,
    offset: f64,
}

impl Table for BodyFile {
    /// Adds the body without its points.
    fn add_to(self, model: &mut Model) -> Result<(), ModelError> {
        let body = Body {
            name: self.name,
            points: vec![],
        };
        model.add_body(body, self.mass, self.inertia);
        let stated = [self.inertia_uncertainty, self.uncertainty];
        for (mass, uncertainty) in model.masses.iter_mut().rev().zip(stated) {
            mass.uncertainty = uncertainty;
        }
        Ok(())
    }

    /// The bodies of a model with the values of their coordinates.
    fn all_of(model: &Model) -> Vec<BodyFile> {
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
        model.elements.bodies.iter().filter_map(file).collect()
    }
}

impl Table for PointFile {
    fn add_to(self, model: &mut Model) -> Result<(), ModelError> {
        let mut bodies = model.elements.bodies.iter_mut();
        let body = bodies.find(|body| body.name == self.body);
        let body = body.ok_or_else(|| ModelError::Shape {
            place: item("point", &self.name),
            found: format!("body = \"{}\"", self.body),
            needed: "the name of a [[body]]".into(),
        })?;
        body.points.push(Point {
            name: self.name,
            offset_m: self.offset,
        });
        Ok(())
    }

    /// The points of a model.
    fn all_of(model: &Model) -> Vec<PointFile> {
        let of = |body: &Body, point: &Point| PointFile {
            name: point.name.clone(),
            body: body.name.clone(),
            offset: point.offset_m,
        };
        let bodies = model.elements.bodies.iter();
        bodies
            .flat_map(|body| body.points.iter().map(move |point| of(body, point)))
            .collect()
    }
}
