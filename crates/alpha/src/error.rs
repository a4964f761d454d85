//! What can go wrong with the unknown force and its fits.

use simgap_integrate::IntegrateError;
use simgap_model::ModelError;
use simgap_record::RecordError;
use thiserror::Error;

/// Why an unknown force or a fit could not be computed.
#[derive(Debug, Error)]
pub enum AlphaError {
    /// A channel of the record.
    #[error(transparent)]
    Record(#[from] RecordError),
    /// A differentiation formula.
    #[error(transparent)]
    Integrate(#[from] IntegrateError),
    /// The lumped model.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// Eq. (3) holds for one degree of freedom.
    #[error("model \"{name}\" has {found} degrees of freedom, needed is 1")]
    DegreesOfFreedom {
        /// Name of the model.
        name: String,
        /// Degrees of freedom found.
        found: usize,
    },
    /// Two series that belong together differ in length.
    #[error("{what}: found {found} values, needed are {needed}")]
    Length {
        /// Which series.
        what: &'static str,
        /// Values found.
        found: usize,
        /// Values needed.
        needed: usize,
    },
    /// A value outside its range.
    #[error("{name} is {found}, needed is {needed}")]
    Parameter {
        /// Which value.
        name: &'static str,
        /// The value found.
        found: f64,
        /// Its valid range.
        needed: String,
    },
    /// The data do not determine the coefficients.
    #[error("{what}: the data do not determine all {coefficients} coefficients")]
    Undetermined {
        /// Which fit.
        what: &'static str,
        /// Number of coefficients.
        coefficients: usize,
    },
    /// The iteration did not settle.
    #[error("{what}: no convergence in {iterations} iterations from the given start")]
    NoConvergence {
        /// Which fit.
        what: &'static str,
        /// Iterations made.
        iterations: usize,
    },
}

/// The value, if it is finite and above zero.
pub(crate) fn positive(name: &'static str, value: f64) -> Result<f64, AlphaError> {
    if value.is_finite() && value > 0.0 {
        Ok(value)
    } else {
        Err(AlphaError::Parameter {
            name,
            found: value,
            needed: "finite and above zero".to_owned(),
        })
    }
}

/// The values, if each is finite.
pub(crate) fn all_finite<'a>(
    name: &'static str,
    values: &'a [f64],
) -> Result<&'a [f64], AlphaError> {
    match values.iter().find(|value| !value.is_finite()) {
        None => Ok(values),
        Some(found) => Err(AlphaError::Parameter {
            name,
            found: *found,
            needed: "finite".to_owned(),
        }),
    }
}
