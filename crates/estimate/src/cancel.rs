//! A way to end work that nobody waits for any longer.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use simgap_simulate::SimulateError;

/// Ends estimations from another thread. Clones share one state; the default is never cancelled.
///
/// A [`Problem`](crate::Problem) that holds it makes no further simulators once it is cancelled, so that
/// fits end with [`SimulateError::Cancelled`] after the simulation under way.
///
/// ```
/// use simgap_estimate::Cancel;
///
/// let cancel = Cancel::default();
/// let elsewhere = cancel.clone();
/// elsewhere.cancel();
/// assert!(cancel.is_cancelled());
/// ```
#[derive(Debug, Clone, Default)]
pub struct Cancel(Arc<AtomicBool>);

impl Cancel {
    /// Asks all work that holds a clone to end.
    pub fn cancel(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    /// Whether the work is to end.
    #[must_use]
    pub fn is_cancelled(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }

    /// Goes on, unless the work is to end.
    ///
    /// # Errors
    /// [`SimulateError::Cancelled`] once it is cancelled.
    pub fn check(&self) -> Result<(), SimulateError> {
        match self.is_cancelled() {
            true => Err(SimulateError::Cancelled),
            false => Ok(()),
        }
    }
}
