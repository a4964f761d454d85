//! A run, and sets over it.

use std::f64::consts::TAU;

use simgap_simulate::{Job, Mended, Run, Simulator};

pub(crate) const SAMPLES: usize = 60_000;
const STEP_S: f64 = 1e-3;

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
