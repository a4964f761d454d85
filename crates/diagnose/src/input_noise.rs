//! What noise on the inputs does to the outputs.
//!
//! The machine is driven by the input as it was, a model by the input as it was measured. With white noise w of the
//! standard deviation found on each input, even the true model leaves
//!
//! ```text
//! r = G(u + w) − G(u) past initial states,   ε_c² = mean r_c² − (white noise seen on r_c)²      (1)
//! ```
//!
//! in channel c, G the plant from rest. r has the colour of the plant, so an estimate of white noise on the discrepancy
//! sees the part of it that the plant passes straight on, and no more.

use simgap_effects::Placed;
use simgap_estimate::{EstimateError, Problem, Weights, fit_initial_states};
use simgap_signal::noise::{fall_of_spectrum, white_noise_std};
use simgap_simulate::Run;

/// Largest noise of an input, over its standard deviation: what is more is broadband excitation.
const MOST: f64 = 0.05;
/// Noise below this share of an input is rounding.
const LEAST: f64 = 1e-5;
/// Largest fall of the spectrum towards half the sample rate, from an octave and from half an octave below it: noise is
/// flat, filtered excitation falls.
const FALL: [f64; 2] = [2.0, 1.5];
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
        let clean = simulator.predict(run, &rest)?;
        let mut white_part = nothing.clone();
        let drawn = (0..DRAWS).map(|draw| {
            let mut noisy = run.clone();
            for (k, (input, size)) in noisy.inputs.iter_mut().zip(&sizes).enumerate() {
                add_white(input, *size, [index as u64, draw, k as u64]);
            }
            let response = simulator.predict(&noisy, &rest)?;
            for ((white, noisy), clean) in white_part.iter_mut().zip(&response).zip(&clean) {
                let moved: Vec<f64> = noisy.iter().zip(clean).map(|(a, b)| a - b).collect();
                let seen = white_noise_std(&moved).map_or(0.0, |noise| noise.std);
                *white += seen * seen / DRAWS as f64;
            }
            // The model is driven by the input as it is.
            noisy.inputs.clone_from(&run.inputs);
            noisy.measured = response.into_iter().map(Some).collect();
            Ok(noisy)
        });
        let drawn = drawn.collect::<Result<Vec<Run>, EstimateError>>()?;
        let left = fit_initial_states(&problem.with_runs(drawn), effects, weights)?;
        for ((square, variance), white) in squares.iter_mut().zip(&left.variance).zip(&white_part) {
            *square += (variance - white).max(0.0) * run.len as f64;
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
    let is_noise = || {
        let fall = fall_of_spectrum(input);
        fall.is_ok_and(|fall| fall.iter().zip(FALL).all(|(fall, most)| *fall < most))
    };
    if (LEAST * std..=MOST * std).contains(&found) && is_noise() {
        found
    } else {
        0.0
    }
}

/// Adds white noise to a signal, the same for the same key.
fn add_white(signal: &mut [f64], std: f64, key: [u64; 3]) {
    // Uniform noise of unit variance lies within √3 of zero. The words are those of splitmix64.
    let mut word = key.into_iter().fold(0_u64, |seed, part| mixed(seed ^ part));
    for value in signal {
        word = word.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let unit = (mixed(word) >> 11) as f64 / (1_u64 << 53) as f64;
        *value += std * 3.0_f64.sqrt() * (2.0 * unit - 1.0);
    }
}

fn mixed(word: u64) -> u64 {
    let word = (word ^ (word >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let word = (word ^ (word >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    word ^ (word >> 31)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use simgap_model::Model;

    use super::*;

    const TEXT: &str = "schema = \"simgap-model/1\"\nname = \"table\"\n\
        [[mass]]\nname = \"table\"\nvalue = 2.0\n\
        [[spring]]\nname = \"k\"\nbetween = [\"table\", \"ground\"]\nstiffness = 1974.0\n\
        [[damper]]\nname = \"c\"\nbetween = [\"table\", \"ground\"]\ndamping = 12.57\n\
        [[input]]\nchannel = \"u\"\nkind = \"force\"\nat = \"table\"\n\
        [[output]]\nchannel = \"y\"\nkind = \"displacement\"\nat = \"table\"\n";
    const STEP_S: f64 = 1e-3;
    const ROWS: usize = 20_000;

    /// ε of the table for its input.
    fn found(input: Vec<f64>) -> f64 {
        let model = Model::from_toml(TEXT).unwrap();
        let run = Run {
            name: "a".into(),
            start_s: 0.0,
            time_step_s: STEP_S,
            len: input.len(),
            first_index: 0,
            measured: vec![Some(vec![0.0; input.len()])],
            inputs: vec![input],
        };
        let problem = Problem::new(&model, vec![run]).unwrap();
        let found = input_noise(&problem, &[], &Weights::independent(1)).unwrap();
        found[0]
    }

    fn slow(n: usize) -> f64 {
        10.0 * (TAU * 1.0 * n as f64 * STEP_S).sin()
    }

    /// White noise of the standard deviation s, sampled every h, has the intensity s² h below the band of the plant:
    /// the displacement has the variance s² h / (2 c k).
    #[test]
    fn verify_noise_of_a_force_moves_an_oscillator_by_the_closed_form() {
        let std = 0.3;
        let mut noise = vec![0.0; ROWS];
        add_white(&mut noise, std, [7, 7, 7]);
        let input = noise.iter().enumerate().map(|(n, w)| slow(n) + w);
        let needed = (std * std * STEP_S / (2.0 * 12.57 * 1974.0)).sqrt();
        let found = found(input.collect());
        // Four draws of sixty decay times each.
        assert!(
            (found / needed - 1.0).abs() < 0.15,
            "{found:e} instead of {needed:e}"
        );
    }

    #[test]
    fn a_clean_input_does_nothing_and_an_excitation_is_no_noise() {
        assert_eq!(found((0..ROWS).map(slow).collect()), 0.0);
        assert_eq!(found(vec![3.0; ROWS]), 0.0);
        assert_eq!(found(vec![1.0, 2.0]), 0.0);
        let mut excitation = vec![0.0; ROWS];
        add_white(&mut excitation, 10.0, [7, 7, 7]);
        assert_eq!(found(excitation.clone()), 0.0);
        // The same through a filter of the first order, a slow one: what is left of it at half the sample rate.
        let mut last = 0.0;
        for value in &mut excitation {
            last = 0.97 * last + 0.03 * *value;
            *value = last;
        }
        assert_eq!(found(excitation), 0.0);
    }
}
