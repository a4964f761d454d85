//! How far a simulation may be off: because inputs are known at the samples only, and because nonlinear forces are taken in steps.
//!
//! ```text
//! a = rms(y − y₂),  b = rms(y₂ − y₄),  δ = a / (ρ − 1),  ρ = b / a within 2 to 16       (1)
//! δ_h = 4/3 rms(y_h − y_{h/2})                                                            (2)
//! ```
//!
//! y₂ is simulated from inputs of which every other sample is what the cubic through its neighbours says, y₄ from those of
//! which only every fourth is left. What a curve through samples misses falls with a power of their distance, which ρ tells:
//! sixteen times for a smooth input, by half for one with steps. Noise of inputs shows in (1) alike. y_h is simulated in the steps of the
//! problem, y_{h/2} in half of them: the march is of second order in its steps.

use rayon::prelude::*;
use simgap_effects::Placed;
use simgap_estimate::{EstimateError, Fit, Problem};
use simgap_simulate::Run;

/// Bounds of δ over the standard deviation of a channel: there is more to a simulation than its inputs, and a
/// coarse input is no leave to overlook everything.
const BOUNDS: [f64; 2] = [2e-4, 1.5e-3];
/// How many times less a curve through samples at half the distance misses, of an input with steps and of a smooth one.
const RATIOS: [f64; 2] = [2.0, 16.0];

/// δ of (1) of each channel, in its unit, for the model of a fit; within the bounds of the standard deviations.
///
/// # Errors
/// [`EstimateError`] when the model cannot be propagated.
pub fn accuracy(problem: &Problem, fit: &Fit) -> Result<Vec<f64>, EstimateError> {
    let estimate = &fit.estimate;
    let delta = between_samples(problem, &estimate.nominal, &estimate.initial)?;
    Ok(bounded(problem, delta, BOUNDS))
}

/// δ within bounds over the standard deviation of each channel. Of filtered discrepancies it is taken to be the same share.
fn bounded(problem: &Problem, delta: Vec<f64>, [least, most]: [f64; 2]) -> Vec<f64> {
    let channels = problem.output_std().into_iter().zip(problem.motion_std());
    let of_channel = |(delta, (std, motion)): (f64, (f64, f64))| {
        let delta = match problem.is_whitened() {
            true => delta * std / motion,
            false => delta,
        };
        // A channel that does not move has no bounds to keep; NaN is off by as much as may be.
        match delta < most * std {
            true => delta.max(least * std),
            false => most * std,
        }
    };
    delta.into_iter().zip(channels).map(of_channel).collect()
}

/// δ_h of (2) of each channel, in its unit, for the model and the effects of a fit; at most as much as inputs may miss. Zero where no force
/// is nonlinear: linear ones are taken exactly.
///
/// # Errors
/// [`EstimateError`] when the model cannot be propagated.
pub fn accuracy_of_steps(problem: &Problem, fit: &Fit) -> Result<Vec<f64>, EstimateError> {
    let placed: Vec<Placed> = fit.estimate.placed().cloned().collect();
    let moved = problem
        .runs
        .par_iter()
        .zip(&fit.estimate.initial)
        .enumerate();
    let moved = moved.map(|(r, (run, initial))| {
        let coarse = problem.simulator(&placed, r)?;
        let fine = problem.simulator_in_half_steps(&placed, r)?;
        if coarse.steps_per_sample() == fine.steps_per_sample() {
            return Ok(vec![0.0; problem.model.outputs.len()]);
        }
        let coarse = coarse.predict(run, initial)?;
        let fine = fine.predict(run, initial)?;
        let channels = coarse.iter().zip(&fine);
        Ok(channels.map(|(a, b)| squared_distance(a, b)).collect())
    });
    let moved = moved.collect::<Result<Vec<Vec<f64>>, EstimateError>>()?;
    let count: usize = problem.runs.iter().map(|run| run.len).sum();
    let of_channel = |c: usize| {
        let square: f64 = moved.iter().map(|run| run[c]).sum();
        4.0 / 3.0 * (square / count.max(1) as f64).sqrt()
    };
    let delta = (0..problem.model.outputs.len()).map(of_channel).collect();
    Ok(bounded(problem, delta, [0.0, BOUNDS[1]]))
}

/// δ by (1) for a model from given states.
fn between_samples(
    problem: &Problem,
    placed: &[Placed],
    initial: &[Vec<f64>],
) -> Result<Vec<f64>, EstimateError> {
    let moved = problem
        .runs
        .par_iter()
        .zip(initial)
        .enumerate()
        .map(|(r, (run, initial))| {
            let simulator = problem.simulator(placed, r)?;
            let coarse = thinned(run, 1);
            let coarser = thinned(&thinned(run, 2), 1);
            let fine = simulator.predict(run, initial)?;
            let coarse = simulator.predict(&coarse, initial)?;
            let coarser = simulator.predict(&coarser, initial)?;
            let squares = (0..fine.len()).map(|c| {
                [
                    squared_distance(&fine[c], &coarse[c]),
                    squared_distance(&coarse[c], &coarser[c]),
                ]
            });
            Ok(squares.collect())
        })
        .collect::<Result<Vec<Vec<[f64; 2]>>, EstimateError>>()?;
    let count: usize = problem.runs.iter().map(|run| run.len).sum();
    let of_channel = |c: usize| {
        let rms = |which: usize| {
            let square: f64 = moved.iter().map(|run| run[c][which]).sum();
            (square / count.max(1) as f64).sqrt()
        };
        beyond(rms(0), rms(1))
    };
    Ok((0..problem.model.outputs.len()).map(of_channel).collect())
}

/// Sum of the squared differences of two signals.
fn squared_distance(one: &[f64], other: &[f64]) -> f64 {
    let apart = one.iter().zip(other).map(|(a, b)| (a - b).powi(2));
    apart.sum()
}

/// What a curve through all samples misses, where one through every other moves by `once` and one through every fourth by
/// `twice` beyond that, (1).
fn beyond(once: f64, twice: f64) -> f64 {
    let [least, most] = RATIOS;
    once / ((twice / once).min(most).max(least) - 1.0)
}

/// The run with every other multiple of `step` samples of the inputs on the cubic through the two on either side, or on
/// the line between its neighbours at the ends.
fn thinned(run: &Run, step: usize) -> Run {
    let mut thin = run.clone();
    for input in &mut thin.inputs {
        for k in (step..input.len().saturating_sub(step)).step_by(2 * step) {
            let near = input[k - step] + input[k + step];
            let far = k.checked_sub(3 * step).zip(input.get(k + 3 * step));
            input[k] = match far {
                Some((before, after)) => (9.0 * near - input[before] - after) / 16.0,
                None => 0.5 * near,
            };
        }
    }
    thin
}

#[cfg(test)]
mod tests {
    use simgap_effects::find;
    use simgap_estimate::{FitOptions, Start, fit};
    use simgap_model::{Location, Model};

    use super::*;

    fn run(input: Vec<f64>) -> Run {
        Run {
            name: "a".into(),
            start_s: 0.0,
            time_step_s: 0.1,
            len: input.len(),
            first_index: 0,
            mended: simgap_simulate::Mended::default(),
            inputs: vec![input],
            measured: vec![None],
        }
    }

    #[test]
    fn every_other_sample_lies_on_the_cubic_through_its_neighbours() {
        let cubic = |k: usize| {
            let t = k as f64;
            t * t * t - 4.0 * t * t + 2.0
        };
        let mut input: Vec<f64> = (0..13).map(cubic).collect();
        input[5] = 100.0;
        input[11] = -7.0;
        let thin = &thinned(&run(input), 1).inputs[0];
        for (k, value) in thin.iter().enumerate().take(10).skip(2) {
            assert!((value - cubic(k)).abs() < 1e-9, "{k}");
        }
        assert_eq!(thin[11], 0.5 * (cubic(10) + cubic(12)));
        let fourth = thinned(&run((0..13).map(cubic).collect()), 2);
        assert_eq!(fourth.inputs[0][6], cubic(6));
        assert_eq!(fourth.inputs[0][2], 0.5 * (cubic(0) + cubic(4)));
    }

    #[test]
    fn a_smooth_input_is_known_better_than_one_with_steps() {
        assert!((beyond(0.15, 1.6) - 0.15 / (1.6 / 0.15 - 1.0)).abs() < 1e-12);
        assert!((beyond(0.15, 30.0) - 0.01).abs() < 1e-12);
        assert!((beyond(0.15, 0.2) - 0.15).abs() < 1e-12);
        assert_eq!(beyond(0.0, 0.0), 0.0);
    }

    /// A mass on a spring, driven, with or without a cubic spring beside it.
    fn driven(effects: Vec<Placed>, substeps: usize) -> (Problem, Fit) {
        let text = r#"
            schema = "simgap-model/1"
            name = "axis"
            [[mass]]
            name = "m"
            value = 1.0
            [[spring]]
            name = "s"
            between = ["m", "ground"]
            stiffness = 400.0
            [[input]]
            channel = "u"
            kind = "force"
            at = "m"
            [[output]]
            channel = "x"
            kind = "displacement"
            at = "m"
        "#;
        let model = Model::from_toml(text).unwrap();
        let drive = (0..400).map(|k| 30.0 * (0.13 * k as f64).sin());
        let mut run = run(drive.collect());
        (run.time_step_s, run.measured) = (0.01, vec![Some(vec![0.0; 400])]);
        let mut problem = Problem::new(&model, vec![run]).unwrap();
        problem.substeps = substeps;
        let start = Start {
            effects,
            nominal: vec![],
            initial: vec![vec![0.0; 2]],
        };
        let held = FitOptions {
            most_steps: 0,
            ..FitOptions::white(1)
        };
        let fit = fit(&problem, &start, &held).unwrap();
        // As wide as the motion, for the bound.
        let moved = fit.discrepancy[0][0].clone();
        problem.runs[0].measured = vec![Some(moved)];
        (problem, fit)
    }

    #[test]
    fn verify_what_steps_miss_is_told_and_falls_with_their_square() {
        let at = || Location::Between(["m".into(), "ground".into()]);
        let cubic = || Placed::new(find("cubic_stiffness").unwrap(), at(), vec![400.0]);
        let of = |substeps: usize| {
            let (problem, fit) = driven(vec![cubic()], substeps);
            accuracy_of_steps(&problem, &fit).unwrap()[0]
        };
        let (problem, fit) = driven(vec![cubic()], 2);
        let fine = driven(vec![cubic()], 64).1;
        let missed = squared_distance(&fit.discrepancy[0][0], &fine.discrepancy[0][0]);
        let missed = (missed / problem.runs[0].len as f64).sqrt();
        assert!((of(2) / missed - 1.0).abs() < 0.05, "{} {missed}", of(2));
        assert!((of(2) / of(4) - 4.0).abs() < 0.2, "{} {}", of(2), of(4));
        let (problem, fit) = driven(vec![], 2);
        assert_eq!(accuracy_of_steps(&problem, &fit).unwrap(), [0.0]);
    }
}
