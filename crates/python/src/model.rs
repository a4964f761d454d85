//! Models.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use pyo3::prelude::*;
use simgap_app::input;
use simgap_app::modes::{chart, modes};
use simgap_model::Model;
use simgap_report::schematic::schematic_svg;

use crate::error::raised;

/// A checked model.
#[pyclass(frozen, name = "Model", module = "simgap._simgap")]
pub(crate) struct NativeModel {
    pub(crate) model: Arc<Model>,
    /// The file it is from.
    pub(crate) file: Option<PathBuf>,
    /// How messages call it.
    label: PathBuf,
}

impl NativeModel {
    /// How messages call it.
    pub(crate) fn label(&self) -> &Path {
        &self.label
    }
}

#[pymethods]
impl NativeModel {
    /// Reads a model file.
    #[staticmethod]
    fn from_file(path: PathBuf) -> PyResult<NativeModel> {
        let model = input::model(&path).map_err(raised)?;
        Ok(NativeModel {
            model: Arc::new(model),
            label: path.clone(),
            file: Some(path),
        })
    }

    /// A model from the text of a model file; `label` stands before messages.
    #[staticmethod]
    fn from_text(text: &str, label: PathBuf) -> PyResult<NativeModel> {
        let model = input::model_of(text, &label).map_err(raised)?;
        Ok(NativeModel {
            model: Arc::new(model),
            label,
            file: None,
        })
    }

    /// Name of the model.
    #[getter]
    fn name(&self) -> &str {
        &self.model.name
    }

    /// Whether the model stands for a simulator.
    #[getter]
    fn is_simulator(&self) -> bool {
        self.model.is_external()
    }

    /// Channels of the record that the model names: inputs, then outputs.
    #[getter]
    fn channels(&self) -> (Vec<String>, Vec<String>) {
        let inputs = self.model.inputs.iter().map(|input| input.channel.clone());
        let outputs = self.model.outputs.iter();
        let outputs = outputs.map(|output| output.channel.clone());
        (inputs.collect(), outputs.collect())
    }

    /// The text of the model file.
    fn to_toml(&self) -> PyResult<String> {
        let text = self.model.to_toml();
        text.map_err(|error| {
            raised(simgap_app::AppError::Model {
                path: self.label.clone(),
                error,
            })
        })
    }

    /// The machine as SVG: nodes, members, inputs, outputs.
    fn picture(&self) -> String {
        schematic_svg(&self.model)
    }

    /// The frequency responses as SVG.
    fn responses_svg(&self) -> PyResult<String> {
        let found = modes(&self.model, &self.label).map_err(raised)?;
        chart(&found)
            .to_svg()
            .map_err(|error| raised(simgap_app::AppError::from(error)))
    }
}
