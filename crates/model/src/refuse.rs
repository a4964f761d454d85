//! Names and values that no model has, refused with their place.

use std::collections::BTreeSet;

use crate::parts::LARGEST_UNCERTAINTY;
use crate::{GROUND, ModelError};

/// How an error names an item: `[[table]] "name"`.
pub(crate) fn item(table: &str, name: &str) -> String {
    format!("[[{table}]] \"{name}\"")
}

pub(crate) fn is_one_of<'a>(
    place: &str,
    found: &str,
    mut names: impl Iterator<Item = &'a String>,
    needed: &str,
) -> Result<(), ModelError> {
    if names.any(|name| name == found) {
        return Ok(());
    }
    Err(ModelError::Shape {
        place: place.into(),
        found: format!("at = \"{found}\""),
        needed: needed.into(),
    })
}

pub(crate) fn unique<'a>(
    table: &str,
    names: impl Iterator<Item = &'a str>,
) -> Result<(), ModelError> {
    let mut seen = BTreeSet::new();
    for name in names {
        if !seen.insert(name) {
            return Err(ModelError::DuplicateName {
                place: item(table, name),
            });
        }
    }
    Ok(())
}

pub(crate) fn node_name(place: &str, name: &str) -> Result<(), ModelError> {
    if name == GROUND || name.trim().is_empty() {
        return Err(ModelError::BadName {
            place: place.into(),
            found: name.into(),
            needed: "\"ground\" is the node that never moves, and a name is not empty",
        });
    }
    Ok(())
}

pub(crate) fn finite(place: &str, quantity: &str, value: f64) -> Result<(), ModelError> {
    if value.is_finite() {
        return Ok(());
    }
    Err(ModelError::Value {
        place: place.into(),
        quantity: quantity.into(),
        found: value,
        needed: "a finite number",
    })
}

pub(crate) fn finite_positive(place: &str, quantity: &str, value: f64) -> Result<(), ModelError> {
    if value.is_finite() && value > 0.0 {
        return Ok(());
    }
    Err(ModelError::Value {
        place: place.into(),
        quantity: quantity.into(),
        found: value,
        needed: "a positive number",
    })
}

pub(crate) fn check_gain(place: &str, gain: Option<f64>) -> Result<(), ModelError> {
    match gain {
        Some(value) if !value.is_finite() || value == 0.0 => Err(ModelError::Value {
            place: place.into(),
            quantity: "gain".into(),
            found: value,
            needed: "a finite number that is not zero",
        }),
        _ => Ok(()),
    }
}

pub(crate) fn check_uncertainty(place: &str, uncertainty: Option<f64>) -> Result<(), ModelError> {
    match uncertainty {
        Some(value) if !(value > 0.0 && value <= LARGEST_UNCERTAINTY) => Err(ModelError::Value {
            place: place.into(),
            quantity: "uncertainty".into(),
            found: value,
            needed: "a relative standard deviation above 0, up to 10",
        }),
        _ => Ok(()),
    }
}
