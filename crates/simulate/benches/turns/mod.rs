//! Plants that take turns: whatever else the machine does meets all of them, and the shortest time of each counts.

pub(crate) mod sets;

use std::time::{Duration, Instant};

use simgap_simulate::{Run, Simulator, predict_all};

use sets::{SAMPLES, jobs};

/// Rounds of a comparison, in each of which every plant is simulated once.
const ROUNDS: usize = 15;

/// What each plant costs, ns per sample and set: its sets over its run.
pub(crate) fn nanoseconds<const N: usize>(plants: [(&[Simulator], &Run); N]) -> [f64; N] {
    let mut least = [Duration::MAX; N];
    for _ in 0..ROUNDS {
        for ((sets, run), least) in plants.iter().zip(&mut least) {
            let jobs = jobs(sets, run);
            let begun = Instant::now();
            divan::black_box(predict_all(&jobs));
            *least = (*least).min(begun.elapsed());
        }
    }
    std::array::from_fn(|k| least[k].as_secs_f64() * 1e9 / (SAMPLES * plants[k].0.len()) as f64)
}
