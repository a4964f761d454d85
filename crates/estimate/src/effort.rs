//! How much work has been done.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use simgap_simulate::Run;

/// A run costs as much as so many samples before its first one: its matrices, its memory.
const BEFORE_THE_FIRST: u64 = 200;

/// How much has been simulated of a problem: samples times coordinates, each run counted with what it costs to begin it. Clones
/// share one count. It is the same for the same work, whatever the machine and the number of threads: a limit on it ends a
/// search at the same place everywhere, which a limit on seconds does not.
///
/// ```
/// assert_eq!(simgap_estimate::Effort::default().spent(), 0);
/// ```
#[derive(Debug, Clone, Default)]
pub struct Effort(Arc<AtomicU64>);

impl Effort {
    /// What has been spent.
    #[must_use]
    pub fn spent(&self) -> u64 {
        self.0.load(Ordering::Relaxed)
    }

    /// Counts a run of a plant of so many coordinates.
    pub(crate) fn add(&self, run: &Run, coordinates: usize) {
        let samples = run.len as u64 + BEFORE_THE_FIRST;
        let spent = samples * coordinates.max(1) as u64;
        self.0.fetch_add(spent, Ordering::Relaxed);
    }
}
