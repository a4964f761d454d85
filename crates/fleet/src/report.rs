//! The files of a report: page, findings, models.

use std::path::Path;

use serde::Serialize;
use simgap_app::folder::Folder;
use simgap_app::manifest::Results;
use simgap_app::text::stem;

use crate::FleetError;
use crate::findings::{Finding, told};
use crate::observe::observations;
use crate::page::{PageInput, page};
use crate::plan::Plan;
use crate::prior::{FleetModel, NominalOfFleet, fleet_models};
use crate::table::Table;
use crate::unit::{Unit, without_records};

/// What a report tells, as `fleet.json` holds it.
#[derive(Debug, Clone, Serialize)]
pub struct Fleet {
    /// `simgap-fleet/1`.
    pub schema: &'static str,
    /// Name of the fleet.
    pub name: String,
    /// Units of the plan.
    pub units: usize,
    /// Units that the table has an answer for.
    pub answered: usize,
    /// Of these, diagnoses that failed.
    pub failed: usize,
    /// What the plan says that no record answers to.
    pub notes: Vec<String>,
    /// What the fleet says.
    pub findings: Vec<Finding>,
    /// The distribution of nominal values, by model file.
    pub models: Vec<ModelOfFleet>,
}

/// Values of one model file.
#[derive(Debug, Clone, Serialize)]
pub struct ModelOfFleet {
    /// The file that was written, in the folder of results.
    pub file: String,
    /// Its values.
    pub values: Vec<NominalOfFleet>,
}

impl Fleet {
    /// The text of `fleet.json`.
    ///
    /// # Errors
    /// [`FleetError::App`].
    pub fn json(&self) -> Result<String, FleetError> {
        Ok(simgap_app::json(self)?)
    }
}

/// Reads the table in `out` and writes `fleet.html`, `fleet.json` and `models/`.
///
/// # Errors
/// [`FleetError`] when a file of the table is damaged or the folder cannot be written to.
pub fn report(plan: &Plan, units: &[Unit], out: &Path) -> Result<Fleet, FleetError> {
    let observations = observations(units, &Table::of(out))?;
    let told = told(&observations, &plan.conditions);
    let models = fleet_models(&observations, &told.series, &told.findings)?;
    let notes = without_records(plan, units);
    let html = page(&PageInput {
        name: &plan.name,
        notes: &notes,
        observations: &observations,
        units: units.len(),
        told: &told,
        models: &models,
    })?;
    let files: Vec<String> = models
        .iter()
        .enumerate()
        .map(|(k, _)| file_of(&models, k))
        .collect();
    let values = models.iter().zip(&files).map(|(model, file)| ModelOfFleet {
        file: file.clone(),
        values: model.values.clone(),
    });
    let fleet = Fleet {
        schema: "simgap-fleet/1",
        name: plan.name.clone(),
        units: units.len(),
        answered: observations.len(),
        failed: observations.iter().filter(|o| o.failed.is_some()).count(),
        models: values.collect(),
        notes,
        findings: told.findings,
    };
    let json = fleet.json()?;
    let names = ["fleet.html", "fleet.json"].into_iter().map(str::to_owned);
    let all: Vec<_> = names
        .chain(files.clone())
        .map(|name| out.join(name))
        .collect();
    let folder = Folder::make(out, &["models"], &all)?;
    let mut results = Results::new(out, "fleet");
    for (model, file) in models.iter().zip(&files) {
        results.add(Path::new(file), &model.text)?;
    }
    results.add(Path::new("fleet.html"), &html)?;
    results.add(Path::new("fleet.json"), &json)?;
    results.finish(folder)?;
    Ok(fleet)
}

/// The file of a model: its own name, and a number where two model files have the same.
fn file_of(models: &[FleetModel], index: usize) -> String {
    let name = |model: &FleetModel| stem(Path::new(&model.file));
    let own = name(&models[index]);
    let before = models[..index]
        .iter()
        .filter(|model| name(model) == own)
        .count();
    match before {
        0 => format!("models/{own}.toml"),
        n => format!("models/{own}-{}.toml", n + 1),
    }
}
