//! How far a simulation may be off because inputs are known at the samples only.
//!
//! ```text
//! δ_c = rms(y_c − y'_c) / 3                                              (1)
//! ```
//!
//! y' is simulated from inputs of which every other sample is the mean of its neighbours. What straight lines
//! between samples miss grows with the square of their distance: y' is off by 4 δ, y by δ. Inputs that are noisy,
//! or end in steps, show in (1) alike.

use rayon::prelude::*;
use simgap_estimate::{EstimateError, Fit, Problem};
use simgap_simulate::Run;

/// Bounds of δ over the standard deviation of a channel: there is more to a simulation than its inputs, and a
/// coarse input is no leave to overlook everything.
const BOUNDS: [f64; 2] = [2e-4, 1.5e-3];

/// δ_c of each channel, in its unit, for the model of a fit; within [`BOUNDS`] of the standard deviations.
pub(crate) fn accuracy(problem: &Problem, fit: &Fit) -> Result<Vec<f64>, EstimateError> {
    let moved = problem
        .runs
        .par_iter()
        .enumerate()
        .map(|(r, run)| {
            let simulator = problem.simulator(&fit.estimate.nominal, r)?;
            let initial = &fit.estimate.initial[r];
            let fine = simulator.predict(run, initial)?;
            let coarse = simulator.predict(&thinned(run), initial)?;
            let squares = fine.iter().zip(&coarse).map(|(fine, coarse)| {
                let apart = fine.iter().zip(coarse).map(|(a, b)| (a - b).powi(2));
                apart.sum::<f64>()
            });
            Ok(squares.collect())
        })
        .collect::<Result<Vec<Vec<f64>>, EstimateError>>()?;
    let count: usize = problem.runs.iter().map(|run| run.len).sum();
    let of_channel = |(c, std): (usize, f64)| {
        let square: f64 = moved.iter().map(|run| run[c]).sum();
        let delta = (square / count.max(1) as f64).sqrt() / 3.0;
        let [least, most] = BOUNDS.map(|bound| bound * std);
        // A channel that does not move has no bounds to keep; NaN is off by as much as may be.
        if delta < most { delta.max(least) } else { most }
    };
    Ok(problem
        .output_std()
        .into_iter()
        .enumerate()
        .map(of_channel)
        .collect())
}

/// The run with the mean of its neighbours at every other sample of the inputs.
fn thinned(run: &Run) -> Run {
    let mut thin = run.clone();
    for input in &mut thin.inputs {
        for k in (1..input.len().saturating_sub(1)).step_by(2) {
            input[k] = 0.5 * (input[k - 1] + input[k + 1]);
        }
    }
    thin
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_other_sample_is_the_mean_of_its_neighbours() {
        let run = Run {
            name: "a".into(),
            start_s: 0.0,
            time_step_s: 0.1,
            len: 6,
            first_index: 0,
            inputs: vec![vec![0.0, 5.0, 2.0, 2.0, 4.0, 9.0]],
            measured: vec![None],
        };
        assert_eq!(thinned(&run).inputs, [[0.0, 1.0, 2.0, 3.0, 4.0, 9.0]]);
    }
}
