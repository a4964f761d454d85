//! The values of hydraulic elements and blocks that the linear part of the plant depends on.

use crate::{Model, ModelError, StructuralMatrices};

/// A value of a cylinder, a valve or a block.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, serde::Serialize, serde::Deserialize,
)]
#[serde(rename_all = "snake_case")]
pub enum DriveValue {
    /// β of a cylinder.
    BulkModulus,
    /// Area of the first chamber.
    FirstArea,
    /// Area of the second chamber.
    SecondArea,
    /// Leakage past the piston.
    Leakage,
    /// Rated flow of a valve.
    RatedFlow,
    /// Natural frequency of a spool.
    NaturalFreq,
    /// Damping ratio of a spool.
    DampingRatio,
    /// Supply pressure of a valve.
    Supply,
    /// A factor on the numerator of a block.
    Gain,
}

use DriveValue as V;

/// Those of a cylinder, a valve and a block.
const CYLINDER: [DriveValue; 4] = [V::BulkModulus, V::FirstArea, V::SecondArea, V::Leakage];
const VALVE: [DriveValue; 4] = [V::RatedFlow, V::NaturalFreq, V::DampingRatio, V::Supply];
const BLOCK: [DriveValue; 1] = [V::Gain];

/// Step of the central differences over the value: what it leaves is 1e-10 of the derivative, and rounding as much.
const STEP: f64 = 1e-5;

impl DriveValue {
    /// As the model file calls it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            V::BulkModulus => "bulk_modulus",
            V::FirstArea => "areas[0]",
            V::SecondArea => "areas[1]",
            V::Leakage => "leakage",
            V::RatedFlow => "rated_flow",
            V::NaturalFreq => "natural_freq",
            V::DampingRatio => "damping_ratio",
            V::Supply => "supply",
            V::Gain => "gain",
        }
    }
}

impl Model {
    /// The values of drives that are not zero: cylinders, valves, then blocks, each with its place in its list.
    pub(crate) fn drive_values(&self) -> Vec<(usize, DriveValue)> {
        let all = |count: usize, values: &'static [DriveValue]| {
            (0..count).flat_map(move |i| values.iter().map(move |value| (i, *value)))
        };
        let values = all(self.cylinders.len(), &CYLINDER)
            .chain(all(self.valves.len(), &VALVE))
            .chain(all(self.blocks.len(), &BLOCK));
        values
            .filter(|(i, value)| self.drive_value(*i, *value).is_some_and(|v| v != 0.0))
            .collect()
    }

    /// A value of a drive; `None` where the model has no such element.
    #[must_use]
    pub fn drive_value(&self, place: usize, value: DriveValue) -> Option<f64> {
        let (cylinder, valve) = (self.cylinders.get(place), self.valves.get(place));
        match value {
            V::BulkModulus => Some(cylinder?.bulk_modulus),
            V::FirstArea => Some(cylinder?.areas[0]),
            V::SecondArea => Some(cylinder?.areas[1]),
            V::Leakage => Some(cylinder?.leakage),
            V::RatedFlow => Some(valve?.rated_flow),
            V::NaturalFreq => Some(valve?.natural_freq),
            V::DampingRatio => Some(valve?.damping_ratio),
            V::Supply => Some(valve?.supply),
            V::Gain => self.blocks.get(place).map(|_| 1.0),
        }
    }

    /// Table and item of a value of a drive.
    pub(crate) fn drive_value_name(&self, place: usize, value: DriveValue) -> String {
        let (table, name) = if CYLINDER.contains(&value) {
            ("cylinder", self.cylinders.get(place).map(|c| &c.name))
        } else if VALVE.contains(&value) {
            ("valve", self.valves.get(place).map(|v| &v.name))
        } else {
            ("block", self.blocks.get(place).map(|b| &b.name))
        };
        let name = name.map_or("", String::as_str);
        format!("{table} \"{name}\" {}", value.name())
    }

    /// The model with a value of a drive multiplied.
    #[must_use]
    pub fn with_drive_value(&self, place: usize, value: DriveValue, factor: f64) -> Model {
        let mut model = self.clone();
        let (cylinder, valve) = (model.cylinders.get_mut(place), model.valves.get_mut(place));
        let own = match value {
            V::BulkModulus => cylinder.map(|c| &mut c.bulk_modulus),
            V::FirstArea => cylinder.map(|c| &mut c.areas[0]),
            V::SecondArea => cylinder.map(|c| &mut c.areas[1]),
            V::Leakage => cylinder.map(|c| &mut c.leakage),
            V::RatedFlow => valve.map(|v| &mut v.rated_flow),
            V::NaturalFreq => valve.map(|v| &mut v.natural_freq),
            V::DampingRatio => valve.map(|v| &mut v.damping_ratio),
            V::Supply => valve.map(|v| &mut v.supply),
            V::Gain => {
                let numerator = model.blocks.get_mut(place).map(|b| &mut b.numerator);
                numerator.into_iter().flatten().for_each(|c| *c *= factor);
                None
            }
        };
        if let Some(own) = own {
            *own *= factor;
        }
        model
    }

    /// ∂M/∂p, ∂C/∂p and ∂K/∂p of a value of a drive, by central differences; the linearisation goes with it.
    pub(crate) fn drive_matrices(
        &self,
        place: usize,
        value: DriveValue,
    ) -> Result<Option<StructuralMatrices>, ModelError> {
        let Some(at) = self.drive_value(place, value).filter(|v| *v != 0.0) else {
            return Ok(None);
        };
        let of = |factor: f64| self.with_drive_value(place, value, factor).matrices();
        let (mut high, low) = (of(1.0 + STEP)?, of(1.0 - STEP)?);
        let scale = faer::Scale(0.5 / (STEP * at));
        for (high, low) in [
            (&mut high.mass_matrix, low.mass_matrix),
            (&mut high.damping_matrix, low.damping_matrix),
            (&mut high.stiffness_matrix, low.stiffness_matrix),
        ] {
            *high -= low;
            *high *= scale;
        }
        Ok(Some(high))
    }
}
