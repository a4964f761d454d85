//! Reading models and records.

use std::path::Path;

use simgap_model::Model;
use simgap_record::{Record, read_csv_channels};

use crate::error::CliError;

/// Reads a model file.
pub(crate) fn model(path: &Path) -> Result<Model, CliError> {
    let text = std::fs::read_to_string(path).map_err(|error| CliError::ModelFile {
        path: path.into(),
        found: error.to_string(),
    })?;
    Model::from_toml(&text).map_err(|error| CliError::Model {
        path: path.into(),
        error,
    })
}

/// Reads of a record what the model names; other columns may hold anything.
pub(crate) fn record(path: &Path, model: &Model) -> Result<Record, CliError> {
    let inputs = model.inputs.iter().map(|input| input.channel.as_str());
    let outputs = model.outputs.iter().map(|output| output.channel.as_str());
    let names: Vec<&str> = inputs.chain(outputs).collect();
    Ok(read_csv_channels(path, &names)?)
}
