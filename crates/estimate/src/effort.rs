//! How much work has been done.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use simgap_simulate::{Run, Simulator};

/// Cost of a run in nanoseconds of one core, in lanes and with all that belongs to a fit: of its matrices, of each sample, of each step of
/// the integration within it, and in each step of each force that is solved for and, in quarters, of each pair of coordinates. By least
/// squares over the simulations of six machines of one to ten coordinates, with and without hydraulics.
const OF_RUN: u64 = 2000;
const OF_SAMPLE: u64 = 45;
const OF_STEP: u64 = 10;
const OF_FORCE: u64 = 32;
const QUARTERS_OF_PAIR: u64 = 7;
/// Cost of ten multiplications of sensitivities.
const OF_TEN_PRODUCTS: u64 = 9;

/// How much has been done on a problem: samples that were simulated, by the steps and the forces that each took, and sensitivities that were
/// multiplied, each with about what it costs. Clones share one count. It is the same for the same work, whatever the machine and the number of
/// threads: a limit on it ends a search at the same place everywhere, which a limit on seconds does not. A unit is about a nanosecond of
/// one core.
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

    /// Counts a run of a simulator.
    pub(crate) fn add_run(&self, run: &Run, simulator: &Simulator) {
        let [steps, forces, coordinates] = [
            simulator.steps_per_sample(),
            simulator.force_count(),
            simulator.coordinate_count(),
        ]
        .map(|count| count as u64);
        let step = OF_STEP + OF_FORCE * forces + QUARTERS_OF_PAIR * coordinates.pow(2) / 4;
        self.add(OF_RUN + run.len as u64 * (OF_SAMPLE + steps * step));
    }

    /// Counts products of so many pairs of signals of a length.
    pub(crate) fn add_products(&self, pairs: usize, len: usize) {
        self.add(pairs as u64 * len as u64 * OF_TEN_PRODUCTS / 10);
    }
}
