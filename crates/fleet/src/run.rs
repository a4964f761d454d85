//! All units on one machine: one thread for each core, resumed where an earlier run ended.

use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use simgap_diagnose::Cancel;

use crate::FleetError;
use crate::answer::{Answered, answer};
use crate::table::Table;
use crate::unit::Unit;

/// Stack of a thread that diagnoses, bytes: as large as that of a main thread.
const STACK_BYTES: usize = 8 << 20;

/// What became of one unit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Done {
    /// Diagnosed now.
    Diagnosed,
    /// Its diagnosis failed; the table holds the reason.
    Failed,
    /// The table had the answer to the same inputs.
    Known,
}

/// How many units became what.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Counts {
    /// Diagnosed now.
    pub diagnosed: usize,
    /// Failed now.
    pub failed: usize,
    /// Known before.
    pub known: usize,
}

impl Counts {
    /// Counts one more.
    pub fn add(&mut self, done: Done) {
        match done {
            Done::Diagnosed => self.diagnosed += 1,
            Done::Failed => self.failed += 1,
            Done::Known => self.known += 1,
        }
    }
}

/// Answers every unit that the table in `out` does not answer yet, on `jobs` threads, and puts each answer in the table as
/// soon as it is there. A run that is killed loses the diagnoses under way; the next one goes on, and the table becomes
/// that of a run that was not killed. Memory holds the records of one unit for each thread.
///
/// # Errors
/// [`FleetError`] when the table cannot be written to, or the work is cancelled.
pub fn run(
    units: &[Unit],
    out: &Path,
    jobs: usize,
    cancel: &Cancel,
    tell: &(dyn Fn(&Unit, Done) + Sync),
) -> Result<Counts, FleetError> {
    let table = Table::of(out);
    let order = longest_first(units);
    let next = AtomicUsize::new(0);
    let counts = Mutex::new(Counts::default());
    let refused: Mutex<Option<FleetError>> = Mutex::new(None);
    let work = || {
        while let Some(unit) = order.get(next.fetch_add(1, Ordering::Relaxed)) {
            if cancel.is_cancelled() {
                return;
            }
            match one(&table, unit, cancel) {
                Ok(done) => {
                    if let Ok(mut counts) = counts.lock() {
                        counts.add(done);
                    }
                    tell(unit, done);
                }
                Err(error) => {
                    // The first refusal tells; the others follow from it.
                    if let Ok(mut refused) = refused.lock() {
                        refused.get_or_insert(error);
                    }
                    cancel.cancel();
                    return;
                }
            }
        }
    };
    let threads = jobs.clamp(1, units.len().max(1));
    let pools: Vec<rayon::ThreadPool> = (0..threads).map(|_| pool()).collect::<Result<_, _>>()?;
    std::thread::scope(|scope| {
        for pool in &pools {
            scope.spawn(|| pool.install(work));
        }
    });
    match refused.into_inner() {
        Ok(Some(error)) => Err(error),
        _ if cancel.is_cancelled() => Err(FleetError::Cancelled),
        _ => Ok(counts.into_inner().unwrap_or_default()),
    }
}

/// The units with the longest records first, since a long one that begins last keeps one worker alone at the end; equally long ones
/// in their order. Records that this machine does not reach have no length.
#[must_use]
pub fn longest_first(units: &[Unit]) -> Vec<&Unit> {
    let bytes = |unit: &Unit| -> u64 {
        let records = unit.train.iter().chain(&unit.check);
        let each = records.filter_map(|path| std::fs::metadata(path).ok());
        each.map(|file| file.len()).sum()
    };
    let mut order: Vec<&Unit> = units.iter().collect();
    order.sort_by_cached_key(|unit| std::cmp::Reverse(bytes(unit)));
    order
}

/// A pool of one thread: a diagnosis spreads over the pool that it runs in, so that this keeps units apart.
fn pool() -> Result<rayon::ThreadPool, FleetError> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1);
    let pool = pool.stack_size(STACK_BYTES).build();
    pool.map_err(|error| FleetError::Threads {
        found: error.to_string(),
    })
}

/// Answers a unit on one thread, for engines that run as many workers as there are cores.
///
/// # Errors
/// As [`answer`], and [`FleetError::Threads`].
pub fn answer_alone(unit: &Unit, cancel: &Cancel) -> Result<Answered, FleetError> {
    pool()?.install(|| answer(unit, cancel))
}

/// The units with the digest of what the table in `out` answers already. What killed runs left beside its files is removed.
#[must_use]
pub fn resumed(units: &[Unit], out: &Path) -> Vec<Unit> {
    let table = Table::of(out);
    units.iter().map(|unit| taken_up(&table, unit)).collect()
}

fn taken_up(table: &Table, unit: &Unit) -> Unit {
    table.clear(unit);
    Unit {
        known: table.known(unit),
        ..unit.clone()
    }
}

fn one(table: &Table, unit: &Unit, cancel: &Cancel) -> Result<Done, FleetError> {
    let unit = taken_up(table, unit);
    let answered = answer(&unit, cancel)?;
    let Some(bytes) = answered.bytes else {
        return Ok(Done::Known);
    };
    table.put(&unit, &bytes)?;
    Ok(match answered.failed {
        Some(_) => Done::Failed,
        None => Done::Diagnosed,
    })
}
