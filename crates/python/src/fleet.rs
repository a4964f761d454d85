//! Fleets: units of work as text, their answers as bytes. Whoever runs them is on the Python side.

use std::path::PathBuf;

use pyo3::prelude::*;
use pyo3::types::PyBytes;
use simgap_fleet::{
    FleetError, Plan, Table, Unit, answer_alone, is_remote, longest_first, report, resumed, units,
};

use crate::error::refused;
use crate::work::attended;

fn raised(error: FleetError) -> PyErr {
    refused(&error.to_string())
}

/// Patterns of places that only other programs reach, with `*` for every field.
#[pyfunction]
pub(crate) fn fleet_places(plan: PathBuf) -> PyResult<Vec<String>> {
    let plan = Plan::read(&plan).map_err(raised)?;
    let remote = plan
        .records
        .iter()
        .filter(|pattern| is_remote(&pattern.text));
    Ok(remote.map(|pattern| pattern.glob()).collect())
}

/// The units of a plan as JSON, the longest first, with what the table in `out` knows already.
#[pyfunction]
#[pyo3(signature = (plan, listed, out))]
pub(crate) fn fleet_units(
    py: Python<'_>,
    plan: PathBuf,
    listed: Vec<String>,
    out: PathBuf,
) -> PyResult<Vec<String>> {
    py.detach(|| {
        let plan = Plan::read(&plan)?;
        let units = resumed(&units(&plan, Some(&listed))?, &out);
        let order = longest_first(&units).into_iter();
        order
            .map(Unit::to_json)
            .collect::<Result<Vec<String>, FleetError>>()
    })
    .map_err(raised)
}

/// The file of the table of a unit, none where the table has it, and why the diagnosis failed.
#[pyfunction]
pub(crate) fn fleet_answer<'py>(
    py: Python<'py>,
    unit: &str,
) -> PyResult<(Option<Bound<'py, PyBytes>>, Option<String>)> {
    let unit = Unit::from_json(unit).map_err(raised)?;
    let answered = attended(py, None, move |link| answer_alone(&unit, &link.cancel))?;
    let answered = answered.map_err(raised)?;
    let bytes = answered.bytes.map(|bytes| PyBytes::new(py, &bytes));
    Ok((bytes, answered.failed))
}

/// Puts the file of a unit in its place.
#[pyfunction]
pub(crate) fn fleet_put(py: Python<'_>, out: PathBuf, unit: &str, bytes: &[u8]) -> PyResult<()> {
    let unit = Unit::from_json(unit).map_err(raised)?;
    let put = py.detach(|| Table::of(&out).put(&unit, bytes));
    put.map_err(raised)
}

/// Writes the report; gives the text of `fleet.json`.
#[pyfunction]
pub(crate) fn fleet_report(
    py: Python<'_>,
    plan: PathBuf,
    listed: Vec<String>,
    out: PathBuf,
) -> PyResult<String> {
    py.detach(|| {
        let plan = Plan::read(&plan)?;
        let units = units(&plan, Some(&listed))?;
        report(&plan, &units, &out)?.json()
    })
    .map_err(raised)
}
