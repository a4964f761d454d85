//! The Python module of simgap: the questions of `simgap_app`, asked from Python.
//!
//! This crate is the native half, `simgap._simgap`: it takes arrays and texts and gives arrays and texts. What a
//! person sees (classes, tables, pages in a notebook) is the Python half, in `python/simgap`. Nothing numerical is here.
//!
//! - Arrays of `float64` are copied once, into the record that keeps them; arrays of other types are converted first.
//! - The interpreter is free for other threads while the work is done (module `work`).
//! - Every error is a `SimgapError` with the line that the command prints (module `error`).

mod answer;
mod compared;
mod error;
mod fleet;
mod frame;
mod model;
mod plant;
mod record;
mod tables;
mod work;

use pyo3::prelude::*;

/// The native half of simgap; use the package `simgap`.
#[pymodule]
fn _simgap(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("SimgapError", module.py().get_type::<error::SimgapError>())?;
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_class::<model::NativeModel>()?;
    module.add_class::<record::NativeRecord>()?;
    module.add_class::<answer::NativeAnswer>()?;
    module.add_class::<compared::NativeCompared>()?;
    module.add_function(wrap_pyfunction!(record::read, module)?)?;
    module.add_function(wrap_pyfunction!(answer::diagnose, module)?)?;
    module.add_function(wrap_pyfunction!(compared::compare, module)?)?;
    module.add_function(wrap_pyfunction!(tables::simulate, module)?)?;
    module.add_function(wrap_pyfunction!(tables::modes, module)?)?;
    module.add_function(wrap_pyfunction!(tables::effects, module)?)?;
    module.add_function(wrap_pyfunction!(fleet::fleet_places, module)?)?;
    module.add_function(wrap_pyfunction!(fleet::fleet_units, module)?)?;
    module.add_function(wrap_pyfunction!(fleet::fleet_answer, module)?)?;
    module.add_function(wrap_pyfunction!(fleet::fleet_put, module)?)?;
    module.add_function(wrap_pyfunction!(fleet::fleet_report, module)?)
}
