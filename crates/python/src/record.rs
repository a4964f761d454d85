//! Records.

use std::path::PathBuf;
use std::sync::Arc;

use numpy::PyArray1;
use pyo3::prelude::*;
use simgap_app::input::{self, Input, RecordOptions};
use simgap_record::{Channel, Record};

use crate::error::raised;
use crate::frame::values;
use crate::model::NativeModel;

/// A checked record.
#[pyclass(frozen, name = "Record", module = "simgap._simgap")]
pub(crate) struct NativeRecord {
    pub(crate) input: Input,
}

#[pymethods]
impl NativeRecord {
    /// A record from arrays: its name, the time column (name, unit, stamps), the channels (name, unit, values).
    #[staticmethod]
    fn from_arrays(
        py: Python<'_>,
        name: String,
        time: (String, String, Bound<'_, PyAny>),
        channels: Vec<(String, String, Bound<'_, PyAny>)>,
    ) -> PyResult<NativeRecord> {
        let stamps = values(&name, &time.0, &time.2)?;
        let copied = |(channel, unit, array): &(String, String, Bound<'_, PyAny>)| {
            let values = values(&name, channel, array)?;
            Ok(Channel::new(channel.clone(), unit, values))
        };
        let channels = channels.iter().map(copied).collect::<PyResult<Vec<_>>>()?;
        let (time_name, time_unit) = (time.0, time.1);
        let record = py.detach(move || {
            Record::with_time_unit(name, (&time_name, &time_unit), stamps, channels)
        });
        Ok(NativeRecord {
            input: Input::made(Arc::new(record.map_err(raised)?)),
        })
    }

    /// File name, or the name it was given.
    #[getter]
    fn name(&self) -> &str {
        self.input.record.name()
    }

    /// What was guessed or changed to read it.
    #[getter]
    fn notes(&self) -> Vec<String> {
        self.input.notes.clone()
    }

    /// Names and units of the channels.
    #[getter]
    fn units(&self) -> Vec<(String, String)> {
        let channels = self.input.record.channels().iter();
        channels
            .map(|channel| (channel.name.clone(), channel.unit.symbol().to_owned()))
            .collect()
    }

    /// Samples per second.
    #[getter]
    fn sample_rate_hz(&self) -> f64 {
        self.input.record.sample_rate_hz()
    }

    fn __len__(&self) -> usize {
        self.input.record.len()
    }

    /// The stamps, s.
    fn time<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, self.input.record.time_s())
    }

    /// The values of a channel, in its unit.
    fn values<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let channel = self.input.record.require(name).map_err(raised)?;
        Ok(PyArray1::from_slice(py, &channel.values))
    }
}

/// How the columns of files are called, from the arguments of Python.
pub(crate) fn options(map: Vec<String>, columns: Option<String>, mend: bool) -> RecordOptions {
    RecordOptions { map, columns, mend }
}

/// Reads a record: what a model names, or every column that holds numbers.
#[pyfunction]
#[pyo3(signature = (path, model, inputs_only, map, columns, mend))]
pub(crate) fn read(
    py: Python<'_>,
    path: PathBuf,
    model: Option<&Bound<'_, NativeModel>>,
    inputs_only: bool,
    map: Vec<String>,
    columns: Option<String>,
    mend: bool,
) -> PyResult<NativeRecord> {
    let options = options(map, columns, mend);
    let model = model.map(|model| Arc::clone(&model.get().model));
    let input = py.detach(move || match &model {
        None => input::table(&path, &options),
        Some(model) if inputs_only => input::record_of_inputs(&path, model, &options),
        Some(model) => input::record(&path, model, &options),
    });
    Ok(NativeRecord {
        input: input.map_err(raised)?,
    })
}
