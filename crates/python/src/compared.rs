//! Comparisons of two traces.

use std::path::PathBuf;

use pyo3::prelude::*;
use simgap_app::comparison::{Question, page, trace_columns, write};
use simgap_app::json;
use simgap_diagnose::compare::Compared;

use crate::error::raised;
use crate::frame::{Frame, frame};
use crate::record::NativeRecord;
use crate::work::attended;

/// The answer of a comparison.
#[pyclass(frozen, name = "Compared", module = "simgap._simgap")]
pub(crate) struct NativeCompared {
    compared: Compared,
}

#[pymethods]
impl NativeCompared {
    /// The text of `comparison.json`.
    fn json(&self) -> PyResult<String> {
        json(&self.compared.comparison).map_err(raised)
    }

    /// The text of `comparison.html`.
    fn page(&self, py: Python<'_>) -> PyResult<String> {
        py.detach(|| page(&self.compared)).map_err(raised)
    }

    /// The columns of `compared.csv`.
    fn traces<'py>(&self, py: Python<'py>) -> Frame<'py> {
        let (headers, columns) = trace_columns(&self.compared);
        frame(py, headers, &columns)
    }

    /// Writes the folder of the command.
    fn save(&self, py: Python<'_>, out: PathBuf) -> PyResult<()> {
        let written = py.detach(|| write(&self.compared, &out));
        written.map(drop).map_err(raised)
    }
}

/// Compares a measured trace with one of a simulator.
#[pyfunction]
#[pyo3(signature = (measured, simulated, pairs, inputs, align_start, on_step))]
pub(crate) fn compare(
    py: Python<'_>,
    measured: &Bound<'_, NativeRecord>,
    simulated: &Bound<'_, NativeRecord>,
    pairs: Vec<(String, String)>,
    inputs: Vec<String>,
    align_start: bool,
    on_step: Option<Bound<'_, PyAny>>,
) -> PyResult<NativeCompared> {
    let measured = measured.get().input.clone();
    let simulated = simulated.get().input.clone();
    let compared = attended(py, on_step.as_ref(), move |link| {
        let question = Question {
            measured: &measured,
            simulated: &simulated,
            pairs: &pairs,
            inputs: &inputs,
            align_start,
        };
        question.answer(&|step| link.step(step))
    })?;
    Ok(NativeCompared {
        compared: compared.map_err(raised)?,
    })
}
