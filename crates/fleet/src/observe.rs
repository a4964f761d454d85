//! What the table says, as observations: one for each unit.

use std::collections::BTreeMap;

use simgap_effects::{Family, find};
use simgap_estimate::NORMAL_95;

use crate::FleetError;
use crate::pattern::Fields;
use crate::row::{Role, Row};
use crate::table::Table;
use crate::unit::Unit;

/// A nominal parameter of which the data say less than this share of what its prior says has no value of its own.
const LEAST_INFORMATION: f64 = 0.25;

/// A kind at a place.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Cause {
    /// Catalogue name.
    pub kind: String,
    /// Where it acts, in words.
    pub place: String,
}

impl std::fmt::Display for Cause {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} {}", self.kind, self.place)
    }
}

/// An estimate with its standard error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// Value.
    pub value: f64,
    /// Standard error, above zero.
    pub std: f64,
}

/// A parameter of a cause.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Quantity {
    /// The cause.
    pub cause: Cause,
    /// Name of the parameter.
    pub parameter: String,
}

/// One diagnosis.
#[derive(Debug, Clone)]
pub struct Observation {
    /// The machine.
    pub machine: String,
    /// The date.
    pub date: String,
    /// Further conditions.
    pub conditions: Fields,
    /// Its model file.
    pub model: String,
    /// Status, or `failed`.
    pub status: String,
    /// Why it failed.
    pub failed: Option<String>,
    /// Whether what is left is no more than noise.
    pub complete: bool,
    /// Gap of the model as given, and of the corrected one.
    pub gap: Option<[f64; 2]>,
    /// Named causes with their probability.
    pub named: BTreeMap<Cause, f64>,
    /// Values of named effects, and of nominal parameters as the data alone have them.
    pub values: BTreeMap<Quantity, Estimate>,
}

/// The observations of all units that the table has an answer for, in the order of the units.
///
/// # Errors
/// [`FleetError::Table`] when a file is damaged.
pub fn observations(units: &[Unit], table: &Table) -> Result<Vec<Observation>, FleetError> {
    let mut found = Vec::new();
    for unit in units {
        let rows = table.rows(unit)?;
        if let Some(first) = rows.first() {
            found.push(observation(unit, first, &rows));
        }
    }
    Ok(found)
}

fn observation(unit: &Unit, first: &Row, rows: &[Row]) -> Observation {
    let mut named = BTreeMap::new();
    let mut values = BTreeMap::new();
    for row in rows {
        let (Some(kind), Some(place)) = (&row.kind, &row.place) else {
            continue;
        };
        let cause = Cause {
            kind: kind.clone(),
            place: place.clone(),
        };
        let estimate = match row.role {
            Role::Named => {
                named.insert(cause.clone(), row.probability.unwrap_or(1.0));
                estimate(row)
            }
            Role::Nominal => estimate(row).and_then(|e| without_prior(e, row.prior_std?)),
            Role::Leading | Role::Nothing | Role::Failed => None,
        };
        if let (Some(estimate), Some(parameter)) = (estimate, &row.parameter) {
            let parameter = parameter.clone();
            values.insert(Quantity { cause, parameter }, estimate);
        }
    }
    Observation {
        machine: unit.machine.clone(),
        date: unit.date.clone(),
        conditions: unit.conditions.clone(),
        model: unit.model.clone(),
        status: first.status.clone(),
        failed: first.reason.clone(),
        complete: first.complete.unwrap_or(false),
        gap: first
            .gap_nominal
            .zip(first.gap_corrected)
            .map(|(a, b)| [a, b]),
        named,
        values,
    }
}

/// Value and standard error of a row; none where an end of the interval is not finite.
fn estimate(row: &Row) -> Option<Estimate> {
    let (value, low, high) = (row.value?, row.low?, row.high?);
    // An interval that a bound cuts off tells by its other half.
    let half = (value - low).max(high - value);
    let std = half / NORMAL_95;
    (value.is_finite() && std.is_finite() && std > 0.0).then_some(Estimate { value, std })
}

/// What the data alone say of a nominal parameter, whose posterior and prior are normal about it and about 1:
///
/// ```text
/// 1/s² = 1/r² + 1/p²,   v/s² = x/r² + 1/p²                                                (1)
/// ```
///
/// with x ± r of the data, the prior 1 ± p and the posterior v ± s.
fn without_prior(posterior: Estimate, prior_std: f64) -> Option<Estimate> {
    let prior = prior_std.powi(-2);
    let together = posterior.std.powi(-2);
    let data = together - prior;
    (data > LEAST_INFORMATION * prior).then(|| Estimate {
        value: (posterior.value * together - prior) / data,
        std: data.powf(-0.5),
    })
}

/// Whether a cause is a wrong value of the model file, of which every diagnosis has an estimate.
pub(crate) fn is_nominal(kind: &str) -> bool {
    find(kind).is_some_and(|effect| effect.family() == Family::NominalParameter)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Data 1.2 ± 0.03 and the prior 1 ± 0.02 give 1.06154 ± 0.01664; what is taken apart again is what was put together.
    #[test]
    fn verify_the_prior_is_taken_out() {
        let (x, r, p): (f64, f64, f64) = (1.2, 0.03, 0.02);
        let together = r.powi(-2) + p.powi(-2);
        let posterior = Estimate {
            value: (x * r.powi(-2) + p.powi(-2)) / together,
            std: together.powf(-0.5),
        };
        let found = without_prior(posterior, p);
        assert!(found.is_some_and(|e| (e.value - x).abs() < 1e-12 && (e.std - r).abs() < 1e-12));
        // A posterior as wide as the prior says nothing.
        let wide = Estimate {
            value: 1.0,
            std: 0.0199,
        };
        assert_eq!(without_prior(wide, p), None);
    }
}
