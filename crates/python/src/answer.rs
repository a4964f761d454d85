//! Diagnoses.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

use pyo3::prelude::*;
use simgap_app::AppError;
use simgap_app::diagnosis::{
    Answer, Question, distinct_stems, known_kinds, prediction_columns, stem_of,
};
use simgap_app::input::{Input, RecordOptions};
use simgap_diagnose::Limit;
use simgap_report::summary::{Styles, summary_text};
use simgap_simulate::ExternalPlant;

use crate::error::raised;
use crate::frame::{Frame, frame};
use crate::model::NativeModel;
use crate::plant::attended_with;
use crate::record::{NativeRecord, options};
use crate::work::Link;

/// The answer of a diagnosis.
#[pyclass(frozen, name = "Answer", module = "simgap._simgap")]
pub(crate) struct NativeAnswer {
    answer: Answer,
}

#[pymethods]
impl NativeAnswer {
    /// The text of `diagnosis.json`.
    fn json(&self) -> PyResult<String> {
        self.answer.json().map_err(raised)
    }

    /// The text of `corrected.toml`.
    fn corrected(&self) -> PyResult<String> {
        let path = Path::new("corrected.toml");
        self.answer.corrected(path).map_err(raised)
    }

    /// The text of `report.html`.
    fn page(&self, py: Python<'_>) -> PyResult<String> {
        let report = py.detach(|| self.answer.report());
        Ok(report.map_err(raised)?.html)
    }

    /// What the command prints, without colours.
    fn summary(&self) -> String {
        summary_text(&self.answer.outcome.diagnosis, Styles::plain())
    }

    /// Names of the records that the answer is judged by, as the files of predictions are called.
    fn judged(&self) -> Vec<String> {
        self.answer.outcome.series.iter().map(stem_of).collect()
    }

    /// The columns of `predictions/NAME.csv`, by the place of the record.
    fn predictions<'py>(&self, py: Python<'py>, index: usize) -> PyResult<Frame<'py>> {
        let series = self.answer.outcome.series.get(index);
        let series = series
            .ok_or_else(|| pyo3::exceptions::PyIndexError::new_err("no record of that place"))?;
        let (headers, columns) = prediction_columns(series);
        Ok(frame(py, headers, &columns))
    }

    /// Writes the folder of the command.
    fn save(&self, py: Python<'_>, out: PathBuf, sets: bool) -> PyResult<()> {
        let written = py.detach(|| self.answer.write(&out, sets));
        written.map(drop).map_err(raised)
    }
}

/// Everything a diagnosis needs, owned, for a thread of its own.
struct Asked {
    model: Arc<simgap_model::Model>,
    model_file: Option<PathBuf>,
    train: Vec<Input>,
    check: Vec<Input>,
    records: RecordOptions,
    withheld: Vec<String>,
    budget_s: Option<f64>,
}

impl Asked {
    fn answer(
        &self,
        link: &Link<Result<Answer, AppError>>,
        plant: Option<Arc<ExternalPlant>>,
    ) -> Result<Answer, AppError> {
        let judged = match self.check.is_empty() {
            true => &self.train,
            false => &self.check,
        };
        distinct_stems(judged.iter().map(|input| &input.path))?;
        known_kinds(&self.withheld, Some(&self.model))?;
        let of_model = |inputs: &[Input]| {
            let inputs = inputs.iter().map(|input| input.of_model(&self.model));
            inputs.collect::<Result<Vec<_>, _>>()
        };
        let (train, check) = (of_model(&self.train)?, of_model(&self.check)?);
        let begun = Instant::now();
        let is_over = self
            .budget_s
            .map(|budget| move || begun.elapsed().as_secs_f64() > budget);
        let question = Question {
            model: &self.model,
            model_file: self.model_file.as_deref(),
            train: &train,
            check: &check,
            records: &self.records,
            withheld: &self.withheld,
            seed: 0,
            limit: is_over
                .as_ref()
                .map_or_else(Limit::default, |is_over| Limit::Asked(is_over)),
            plant,
            cancel: link.cancel.clone(),
        };
        question.refuse_repeats()?;
        question.answer(&|step| link.step(step))
    }
}

/// Diagnoses the gap between a model and records.
#[pyfunction]
#[pyo3(signature = (model, train, check, withhold, budget_s, map, columns, mend, on_step, simulator))]
#[allow(clippy::too_many_arguments)]
pub(crate) fn diagnose(
    py: Python<'_>,
    model: &Bound<'_, NativeModel>,
    train: Vec<Bound<'_, NativeRecord>>,
    check: Vec<Bound<'_, NativeRecord>>,
    withhold: Vec<String>,
    budget_s: Option<f64>,
    map: Vec<String>,
    columns: Option<String>,
    mend: bool,
    on_step: Option<Bound<'_, PyAny>>,
    simulator: Option<Py<PyAny>>,
) -> PyResult<NativeAnswer> {
    let inputs = |records: &[Bound<'_, NativeRecord>]| {
        let records = records.iter();
        records.map(|record| record.get().input.clone()).collect()
    };
    let asked = Asked {
        model: Arc::clone(&model.get().model),
        model_file: model.get().file.clone(),
        train: inputs(&train),
        check: inputs(&check),
        records: options(map, columns, mend),
        withheld: withhold,
        budget_s,
    };
    let answer = attended_with(py, on_step.as_ref(), simulator, move |link, plant| {
        asked.answer(link, plant)
    })?;
    Ok(NativeAnswer {
        answer: answer.map_err(raised)?,
    })
}
