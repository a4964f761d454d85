//! How much work has been done.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use simgap_simulate::Run;

/// A run costs as much as so many samples before its first one: its matrices, its memory.
const BEFORE_THE_FIRST: u64 = 200;
/// Cost of a sample of a run, and of each step of the integration within it, in units of seven multiplications of sensitivities: in lanes
/// and with all that belongs to a fit, about 38 and 16 ns beside 0.9 ns. The number of coordinates hardly tells.
const OF_SAMPLE: u64 = 6;
const OF_STEP: u64 = 2;
const MULTIPLICATIONS: u64 = 7;

/// How much has been done on a problem: samples that were simulated, by the steps that each took, and sensitivities that were multiplied,
/// each with about what it costs. Clones share one count. It is the same for the same work, whatever the machine and the number of
/// threads: a limit on it ends a search at the same place everywhere, which a limit on seconds does not. A unit is about six nanoseconds
/// of one core.
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

    fn add(&self, spent: u64) {
        self.0.fetch_add(spent, Ordering::Relaxed);
    }

    /// Counts a run that takes so many steps for each sample.
    pub(crate) fn add_run(&self, run: &Run, steps: usize) {
        let samples = run.len as u64 + BEFORE_THE_FIRST;
        self.add(samples * (OF_SAMPLE + OF_STEP * steps as u64));
    }

    /// Counts products of so many pairs of signals of a length.
    pub(crate) fn add_products(&self, pairs: usize, len: usize) {
        self.add(pairs as u64 * len as u64 / MULTIPLICATIONS);
    }
}
