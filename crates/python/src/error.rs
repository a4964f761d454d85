//! One exception for everything that is wrong with an input.

use pyo3::PyErr;
use pyo3::exceptions::PyValueError;
use simgap_app::AppError;
use simgap_app::text::shown;

pyo3::create_exception!(
    simgap,
    SimgapError,
    PyValueError,
    "What is wrong with an input: one line that says where, what was found and what is needed.\n\n\
     It is the line that the command `simgap` prints for the same input."
);

/// The exception for an error, with the line that the command prints.
pub(crate) fn raised(error: impl Into<AppError>) -> PyErr {
    refused(&error.into().to_string())
}

/// The exception with a line of its own.
pub(crate) fn refused(line: &str) -> PyErr {
    SimgapError::new_err(shown(line))
}
