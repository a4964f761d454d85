//! Columns as Python takes them.

use numpy::{PyArray1, PyReadonlyArray1, PyReadonlyArrayDyn, PyUntypedArrayMethods as _};
use pyo3::prelude::*;

use crate::error::refused;

/// Headers and arrays, one for each column.
pub(crate) type Frame<'py> = Vec<(String, Bound<'py, PyArray1<f64>>)>;

/// Columns as arrays of NumPy.
pub(crate) fn frame<'py>(
    py: Python<'py>,
    headers: Vec<String>,
    columns: &[impl AsRef<[f64]>],
) -> Frame<'py> {
    let arrays = columns
        .iter()
        .map(|column| PyArray1::from_slice(py, column.as_ref()));
    headers.into_iter().zip(arrays).collect()
}

/// The values of an array of `float64`, copied once: as a block where they are contiguous, one by one where they are not.
pub(crate) fn values(record: &str, column: &str, array: &Bound<'_, PyAny>) -> PyResult<Vec<f64>> {
    if let Ok(array) = array.extract::<PyReadonlyArray1<'_, f64>>() {
        return Ok(match array.as_slice() {
            Ok(slice) => slice.to_vec(),
            Err(_) => array.as_array().to_vec(),
        });
    }
    let found = match array.extract::<PyReadonlyArrayDyn<'_, f64>>() {
        Ok(array) => format!("an array of shape {:?}", array.shape()),
        Err(_) => format!("{}", array.get_type()),
    };
    Err(refused(&format!(
        "{record}: column '{column}' is {found}, needed is an array of one dimension of float64"
    )))
}
