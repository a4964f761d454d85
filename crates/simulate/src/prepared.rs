//! A simulation ready to be marched.

use std::sync::Arc;

use simgap_integrate::exact::ExactPropagator;

use crate::drive::Drive;

/// A simulation ready to be marched.
pub(crate) struct Prepared {
    pub(crate) propagator: Arc<ExactPropagator>,
    pub(crate) drive: Arc<Drive>,
    pub(crate) displacement: Vec<f64>,
    pub(crate) velocity: Vec<f64>,
}
