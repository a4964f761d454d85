//! Plants that take turns: whatever else the machine does meets all of them, and the shortest time of each counts.

use std::f64::consts::TAU;
use std::time::{Duration, Instant};

use simgap_simulate::{Job, Mended, Run, Simulator, predict_all};

pub(crate) const SAMPLES: usize = 60_000;
const STEP_S: f64 = 1e-3;

/// Rounds of a comparison, in each of which every plant is simulated once.
const ROUNDS: usize = 15;

/// 60 s at 1 kHz of two sines.
pub(crate) fn run(amplitude: f64) -> Run {
    let wave = |k: usize| {
        let t = STEP_S * k as f64;
        amplitude * ((TAU * 1.3 * t).sin() + 0.5 * (TAU * 4.1 * t).sin())
    };
    Run {
        name: "made here".into(),
        start_s: 0.0,
        time_step_s: STEP_S,
        len: SAMPLES,
        first_index: 0,
        inputs: vec![(0..SAMPLES).map(wave).collect()],
        measured: vec![None],
        mended: Mended::default(),
    }
}

/// Every set over the same run, from rest.
pub(crate) fn jobs<'a>(sets: &'a [Simulator], run: &'a Run) -> Vec<Job<'a>> {
    let job = |simulator| Job {
        simulator,
        run,
        initial: &[],
        smooth: false,
    };
    sets.iter().map(job).collect()
}

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
