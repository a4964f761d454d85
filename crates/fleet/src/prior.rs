//! What a fleet says of the next machine: a model file whose values and uncertainties are those of the fleet.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use serde::Serialize;
use simgap_app::{AppError, input};
use simgap_effects::{Action, Placed, SiteKind, find, sites};
use simgap_model::Model;

use crate::FleetError;
use crate::findings::{Finding, Series, is_of_the_model};
use crate::observe::{Estimate, Observation, Quantity};
use crate::population::{Population, mean, population};
use crate::scope::Scope;

/// The least relative standard deviation that is written: a fleet is no proof of the last digits of the next machine.
const LEAST_UNCERTAINTY: f64 = 1e-3;
/// The largest, as a model file may state.
const LARGEST_UNCERTAINTY: f64 = 10.0;

/// A nominal value over the machines of a model.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct NominalOfFleet {
    /// Catalogue name of its error, such as `stiffness_error`.
    pub kind: String,
    /// Where it is, in words.
    pub place: String,
    /// Name of the parameter: a factor on the value of the model file.
    pub parameter: String,
    /// Machines that count.
    pub machines: usize,
    /// Machines that are left out: outlying, or changing over time.
    pub left_out: Vec<String>,
    /// Mean factor.
    pub mean: f64,
    /// Scatter between machines.
    pub between: f64,
    /// Relative standard deviation for the next machine.
    pub uncertainty: f64,
}

/// A model with the values of its fleet.
pub(crate) struct FleetModel {
    /// The model file it is from.
    pub file: String,
    /// The text of the new one.
    pub text: String,
    /// What was written.
    pub values: Vec<NominalOfFleet>,
}

/// One model for each model file of the fleet of which at least three machines tell something. Machines that are named by a
/// finding about a value are left out of it: they are not like the next one.
///
/// # Errors
/// [`FleetError::App`] when a model file cannot be read or written as text.
pub(crate) fn fleet_models(
    observations: &[Observation],
    series: &BTreeMap<Quantity, Vec<Series>>,
    findings: &[Finding],
) -> Result<Vec<FleetModel>, FleetError> {
    let of: BTreeMap<&str, &str> = observations
        .iter()
        .map(|o| (o.machine.as_str(), o.model.as_str()))
        .collect();
    let files: BTreeSet<&str> = of.values().copied().collect();
    let mut models = Vec::new();
    for file in files {
        let values: Vec<NominalOfFleet> = series
            .iter()
            .filter(|(quantity, _)| is_of_the_model(quantity))
            .filter_map(|(quantity, all)| {
                let own = all
                    .iter()
                    .filter(|one| of.get(one.machine.as_str()) == Some(&file));
                of_fleet(quantity, own, findings)
            })
            .collect();
        if values.is_empty() {
            continue;
        }
        let path = Path::new(file);
        // A model that cannot be read has failed diagnoses, whose rows say why.
        let Ok(model) = input::model(path) else {
            continue;
        };
        let (model, values) = with_values(&model, values);
        let text = model.to_toml().map_err(|error| AppError::Model {
            path: path.into(),
            error,
        })?;
        models.push(FleetModel {
            file: file.to_owned(),
            text,
            values,
        });
    }
    Ok(models)
}

fn of_fleet<'a>(
    quantity: &Quantity,
    series: impl Iterator<Item = &'a Series>,
    findings: &[Finding],
) -> Option<NominalOfFleet> {
    let blamed = |machine: &String| {
        findings.iter().any(|finding| {
            let same = finding.kind == quantity.cause.kind && finding.place == quantity.cause.place;
            let machines = finding.levels.get("machine");
            let own = matches!(finding.scope, Scope::Machine | Scope::Undecided);
            same && own && machines.is_some_and(|machines| machines.contains(machine))
        })
    };
    let (left_out, counted): (Vec<&Series>, Vec<&Series>) =
        series.partition(|one| blamed(&one.machine));
    let means: Vec<Estimate> = counted
        .iter()
        .filter_map(|one| mean(&one.estimates))
        .collect();
    let Population {
        machines,
        mean,
        between,
        next,
        ..
    } = population(&means)?;
    if mean <= 0.0 {
        return None;
    }
    Some(NominalOfFleet {
        kind: quantity.cause.kind.clone(),
        place: quantity.cause.place.clone(),
        parameter: quantity.parameter.clone(),
        machines,
        left_out: left_out.iter().map(|one| one.machine.clone()).collect(),
        mean,
        between,
        uncertainty: (next / mean).clamp(LEAST_UNCERTAINTY, LARGEST_UNCERTAINTY),
    })
}

/// The model with the values that it has a place for.
fn with_values(model: &Model, values: Vec<NominalOfFleet>) -> (Model, Vec<NominalOfFleet>) {
    let mut changed = model.clone();
    let mut written = Vec::new();
    for value in values {
        let Some(effect) = find(&value.kind) else {
            continue;
        };
        let kinds = [SiteKind::Member, effect.site()];
        let all = kinds.into_iter().flat_map(|kind| sites(model, kind));
        let Some(at) = all.into_iter().find(|at| at.to_string() == value.place) else {
            continue;
        };
        let placed = Placed::new(
            effect,
            at.clone(),
            vec![value.mean; effect.parameters().len()],
        );
        let Action::Model(change) = placed.action() else {
            continue;
        };
        let is_stated = effect
            .nominal_quantity()
            .is_some_and(|quantity| changed.state_uncertainty(quantity, &at, value.uncertainty));
        if is_stated {
            change(&mut changed, &at);
            written.push(value);
        }
    }
    (changed, written)
}
