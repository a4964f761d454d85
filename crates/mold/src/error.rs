//! What can go wrong with the mold oscillator.

use simgap_integrate::IntegrateError;
use simgap_model::ModelError;
use simgap_record::RecordError;
use simgap_tables::TableError;
use thiserror::Error;

/// Why a mold model or record could not be made.
#[derive(Debug, Error)]
pub enum MoldError {
    /// A fixture of the paper.
    #[error(transparent)]
    Table(#[from] TableError),
    /// The lumped model.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// The record.
    #[error(transparent)]
    Record(#[from] RecordError),
    /// A differentiation formula.
    #[error(transparent)]
    Integrate(#[from] IntegrateError),
    /// A value outside its range.
    #[error("{name} is {found}, needed is {needed}")]
    Parameter {
        /// Which value.
        name: &'static str,
        /// The value found.
        found: f64,
        /// Its valid range.
        needed: &'static str,
    },
    /// The paper has no row for this excitation.
    #[error("{table} has no row for {found} Hz, it has {has}")]
    NoRow {
        /// Which table.
        table: &'static str,
        /// Excitation asked for, Hz.
        found: f64,
        /// Rows it has.
        has: &'static str,
    },
    /// No pair of positive stiffnesses gives the modes asked for.
    #[error(
        "no positive k_leaf and k2 give modes at {lower_hz} and {upper_hz} Hz with these masses and k1"
    )]
    NoStiffness {
        /// Lower mode asked for, Hz.
        lower_hz: f64,
        /// Upper mode asked for, Hz.
        upper_hz: f64,
    },
}

/// The value, if it is finite and above zero.
pub(crate) fn positive(name: &'static str, value: f64) -> Result<f64, MoldError> {
    if value.is_finite() && value > 0.0 {
        Ok(value)
    } else {
        Err(MoldError::Parameter {
            name,
            found: value,
            needed: "finite and above zero",
        })
    }
}

/// The value, if it is finite and not negative.
pub(crate) fn not_negative(name: &'static str, value: f64) -> Result<f64, MoldError> {
    if value.is_finite() && value >= 0.0 {
        Ok(value)
    } else {
        Err(MoldError::Parameter {
            name,
            found: value,
            needed: "finite and not negative",
        })
    }
}

/// The value, if it is finite.
pub(crate) fn finite(name: &'static str, value: f64) -> Result<f64, MoldError> {
    if value.is_finite() {
        Ok(value)
    } else {
        Err(MoldError::Parameter {
            name,
            found: value,
            needed: "finite",
        })
    }
}
