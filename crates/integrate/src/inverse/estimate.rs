//! What the filter knows of a state.

use super::matrix3::{Matrix, Vector};

/// Mean and covariance of the state at one sample.
pub(super) type Estimate = (Vector, Matrix);
