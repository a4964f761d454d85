//! A simulator of the user's, called from the threads of a diagnosis.

use std::sync::{Arc, Mutex, PoisonError};

use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use simgap_diagnose::Cancel;
use simgap_simulate::{ExternalPlant, Plant, PlantError, PlantRun};

use crate::frame::values;
use crate::work::{Link, attended};

/// What the user's function raised, until it is raised again.
type Raised = Arc<Mutex<Option<PyErr>>>;

/// A function of parameters, inputs, forces and the names of the wanted outputs, which gives one array for each of these.
struct Called {
    function: Py<PyAny>,
    raised: Raised,
    cancel: Cancel,
}

/// As [`attended`], with a simulator of the user's. What that raises ends the work, and is raised here before what it led to.
pub(crate) fn attended_with<T: Send + 'static>(
    py: Python<'_>,
    on_step: Option<&Bound<'_, PyAny>>,
    simulator: Option<Py<PyAny>>,
    work: impl FnOnce(&Link<T>, Option<Arc<ExternalPlant>>) -> T + Send + 'static,
) -> PyResult<T> {
    let raised = Raised::default();
    let kept = Raised::clone(&raised);
    let done = attended(py, on_step, move |link| {
        let plant = simulator.map(|function| {
            ExternalPlant::new(Called {
                function,
                raised: kept,
                cancel: link.cancel.clone(),
            })
        });
        work(link, plant)
    });
    match raised.lock().unwrap_or_else(PoisonError::into_inner).take() {
        Some(error) => Err(error),
        None => done,
    }
}

impl Plant for Called {
    fn simulate(&self, run: &PlantRun<'_>) -> Result<Vec<Vec<f64>>, PlantError> {
        let ended = |reason: String| Err(PlantError::Failed { reason });
        if self.cancel.is_cancelled() {
            return ended("the work was cancelled".into());
        }
        Python::attach(|py| match self.call(py, run) {
            Ok(signals) => Ok(signals),
            Err(error) => {
                let reason = error.value(py).to_string();
                let mut raised = self.raised.lock().unwrap_or_else(PoisonError::into_inner);
                raised.get_or_insert(error);
                self.cancel.cancel();
                ended(reason)
            }
        })
    }
}

impl Called {
    fn call(&self, py: Python<'_>, run: &PlantRun<'_>) -> PyResult<Vec<Vec<f64>>> {
        let parameters = PyDict::new(py);
        for (name, value) in run.parameters {
            parameters.set_item(name, value)?;
        }
        let signals = |all: &[(String, Vec<f64>)]| -> PyResult<Bound<'_, PyDict>> {
            let signals = PyDict::new(py);
            for (name, signal) in all {
                signals.set_item(name, PyArray1::from_slice(py, signal))?;
            }
            Ok(signals)
        };
        let time: Vec<f64> = (0..run.len).map(|n| n as f64 * run.time_step_s).collect();
        let inputs = signals(run.inputs)?;
        let time = PyArray1::from_vec(py, time);
        let arguments = (
            parameters,
            inputs,
            signals(run.forces)?,
            time,
            run.outputs.to_vec(),
        );
        let arrays: Vec<Bound<'_, PyAny>> = self.function.bind(py).call1(arguments)?.extract()?;
        let each = arrays.iter().zip(run.outputs);
        each.map(|(array, name)| values("simulator", name, array))
            .collect()
    }
}
