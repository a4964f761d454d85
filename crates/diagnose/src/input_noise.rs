//! What noise on the inputs does to the outputs.
//!
//! The machine is driven by the input as it was, a model by the input as it was measured. With white noise w of the
//! standard deviation found on each input, even the true model leaves
//!
//! ```text
//! ε_c = rms(G_c w past initial states)                                   (1)
//! ```
//!
//! in channel c, G the plant. It has the colour of the plant, so no estimate of white noise on the discrepancy sees it.

use simgap_effects::Placed;
use simgap_estimate::{EstimateError, Problem, Weights, fit_initial_states};
use simgap_signal::noise::white_noise_std;
use simgap_simulate::Run;

/// Largest noise of an input, over its standard deviation: what is more is broadband excitation.
const MOST: f64 = 0.05;
/// Noise below this share of an input is rounding.
const LEAST: f64 = 1e-5;
/// Draws of w for each run.
const DRAWS: u64 = 4;

/// ε of each channel by (1), in its unit, for a model with effects that is driven by the runs of a problem.
pub(crate) fn input_noise(
    problem: &Problem,
    effects: &[Placed],
    weights: &Weights,
) -> Result<Vec<f64>, EstimateError> {
    let nothing = vec![0.0; problem.model.outputs.len()];
    let mut squares = nothing.clone();
    let mut count = 0.0;
    for (index, run) in problem.runs.iter().enumerate() {
        count += run.len as f64;
        let sizes: Vec<f64> = run.inputs.iter().map(|input| noise_std(input)).collect();
        if sizes.iter().all(|size| *size == 0.0) {
            continue;
        }
        let simulator = problem.simulator(effects, index)?;
        let rest = vec![0.0; simulator.state_len()];
        let drawn = (0..DRAWS).map(|draw| {
            let mut noise = run.clone();
            for (k, (input, size)) in noise.inputs.iter_mut().zip(&sizes).enumerate() {
                white(input, *size, [index as u64, draw, k as u64]);
            }
            let response = simulator.predict(&noise, &rest)?;
            noise.inputs.iter_mut().for_each(|input| input.fill(0.0));
            noise.measured = response.into_iter().map(Some).collect();
            Ok(noise)
        });
        let drawn = problem.with_runs(drawn.collect::<Result<Vec<Run>, EstimateError>>()?);
        let left = fit_initial_states(&drawn, effects, weights)?;
        for (square, variance) in squares.iter_mut().zip(&left.variance) {
            *square += variance * run.len as f64;
        }
    }
    let rms = |square: f64| (square / f64::max(count, 1.0)).sqrt();
    let all: Vec<f64> = squares.into_iter().map(rms).collect();
    // A plant that runs away says nothing.
    let is_known = all.iter().all(|rms| rms.is_finite());
    Ok(if is_known { all } else { nothing })
}

/// Standard deviation of the white noise on an input; zero where there is none to be seen.
fn noise_std(input: &[f64]) -> f64 {
    let mean = input.iter().sum::<f64>() / input.len().max(1) as f64;
    let square: f64 = input.iter().map(|u| (u - mean).powi(2)).sum();
    let std = (square / input.len().max(1) as f64).sqrt();
    let found = white_noise_std(input).map_or(0.0, |noise| noise.std);
    if found < LEAST * std {
        0.0
    } else {
        found.min(MOST * std)
    }
}

/// Fills a signal with white noise, the same for the same key.
fn white(signal: &mut [f64], std: f64, key: [u64; 3]) {
    // Uniform noise of unit variance lies within √3 of zero. The words are those of splitmix64.
    let mut word = key.into_iter().fold(0_u64, |seed, part| mixed(seed ^ part));
    for value in signal {
        word = word.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let unit = (mixed(word) >> 11) as f64 / (1_u64 << 53) as f64;
        *value = std * 3.0_f64.sqrt() * (2.0 * unit - 1.0);
    }
}

fn mixed(word: u64) -> u64 {
    let word = (word ^ (word >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let word = (word ^ (word >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    word ^ (word >> 31)
}
