//! Simulations, modes, the catalogue.

use std::sync::Arc;

use pyo3::prelude::*;
use simgap_app::effects::{Catalogue, kinds, known};
use simgap_app::{AppError, json, modes as app_modes, simulation};

use crate::error::raised;
use crate::frame::{Frame, frame};
use crate::model::NativeModel;
use crate::plant::attended_with;
use crate::record::NativeRecord;

/// Columns and notes of the prediction of a model.
#[pyfunction]
#[pyo3(signature = (model, record, from_rest, simulator=None))]
pub(crate) fn simulate<'py>(
    py: Python<'py>,
    model: &Bound<'py, NativeModel>,
    record: &Bound<'py, NativeRecord>,
    from_rest: bool,
    simulator: Option<Py<PyAny>>,
) -> PyResult<(Frame<'py>, Vec<String>)> {
    let model = Arc::clone(&model.get().model);
    let input = record.get().input.clone();
    let found = attended_with(py, None, simulator, move |_, plant| {
        let input = input.of_inputs(&model)?;
        simulation::simulate_with(&model, &input, from_rest, plant)
    })?;
    let found = found.map_err(|error: AppError| raised(error))?;
    Ok((frame(py, found.headers, &found.columns), found.notes))
}

/// The text of `simgap modes --format json`.
#[pyfunction]
pub(crate) fn modes(model: &Bound<'_, NativeModel>) -> PyResult<String> {
    let native = model.get();
    let found = app_modes::modes(&native.model, native.label()).map_err(raised)?;
    json(&found).map_err(raised)
}

/// The text of `simgap effects --format json`, of one kind or of all.
#[pyfunction]
#[pyo3(signature = (kind, model))]
pub(crate) fn effects(
    kind: Option<&str>,
    model: Option<&Bound<'_, NativeModel>>,
) -> PyResult<String> {
    let model = model.map(|model| &*model.get().model);
    let found = match kind {
        None => Catalogue::of(&kinds(model)),
        Some(kind) => Catalogue::of(&[known("", kind, model).map_err(raised)?]),
    };
    json(&found).map_err(raised)
}
