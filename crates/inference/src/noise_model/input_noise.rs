//! What noise on the inputs does to the outputs.
//!
//! The machine is driven by the input as it was, a model by the input as it was measured. With white noise w of the
//! standard deviation found on each input, even the true model leaves
//!
//! ```text
//! r = G(u + w) − G(u) past initial states                                                        (1)
//! ε_c² = mean r_c² − min(white noise seen on r_c, white noise seen on what a set leaves)²        (2)
//! ```
//!
//! in channel c, G the plant from rest. r has the colour of the plant, so an estimate of white noise on the discrepancy
//! sees the part of it that the plant passes straight on, and no more; a set that smooths the input leaves less of that
//! part than there is. Of many draws of w the largest r counts in (2): on a plant without a spring it is a random
//! walk, one walk is not like another, and that of the machine goes further than all of n draws in one of n + 1 records.

use rayon::prelude::*;
use simgap_effects::Placed;
use simgap_estimate::{EstimateError, FitOptions, Problem, fit_initial_states};
use simgap_signal::noise::{fall_of_spectrum, white_noise_std};
use simgap_simulate::{Job, Run, SimulateError, predict_all};

use crate::is_nominal;

/// Largest noise of an input, over its standard deviation: what is more is broadband excitation.
const MOST: f64 = 0.05;
/// Noise below this share of an input is rounding.
const LEAST: f64 = 1e-5;
/// Largest fall of the spectrum towards half the sample rate, from an octave and from half an octave below it: noise is
/// flat, filtered excitation falls.
const FALL: [f64; 2] = [2.0, 1.5];
/// Draws of w for each run.
const DRAWS: u64 = 24;

/// What the noise of the inputs does to a channel, in its unit squared.
#[derive(Debug, Clone, Copy, Default)]
pub struct InputNoise {
    /// Mean of r².
    variance: f64,
    /// The same of the largest r drawn.
    most: f64,
    /// The part of it that looks white, and that an estimate of white noise on the discrepancy holds too.
    white: f64,
}

impl InputNoise {
    /// Root mean square of r.
    #[must_use]
    pub fn rms(&self) -> f64 {
        self.variance.sqrt()
    }

    /// ε² by (2) beside white noise of a variance that was found on what a set leaves.
    #[must_use]
    pub fn beyond(&self, found: f64) -> f64 {
        (self.most - self.white.min(found)).max(0.0)
    }
}

/// r of each channel by (1) for a model that is driven by the runs of a problem, with the nominal parameters among
/// `placed` as they were estimated beside the rest of it: a set without the cause bends them. Where excitation hides
/// the noise of an input, it has the least that is seen in another run, of the problem or of `others`.
///
/// # Errors
/// [`EstimateError`] when the model cannot be propagated.
pub fn input_noise(
    problem: &Problem,
    placed: &[Placed],
    weights: &FitOptions,
    others: &[Run],
) -> Result<Vec<InputNoise>, EstimateError> {
    let nothing = vec![0.0; problem.model.outputs.len()];
    let mut all = vec![InputNoise::default(); nothing.len()];
    let count: usize = problem.runs.iter().map(|run| run.len).sum();
    for drawn in draws(problem, placed, weights, others)? {
        for (c, (sum, white)) in all.iter_mut().zip(&drawn.white).enumerate() {
            let squares = drawn.left.iter().map(|draw| square_sum(&draw[c]));
            let mean = squares.clone().sum::<f64>() / DRAWS as f64;
            sum.variance += mean;
            sum.most += squares.fold(0.0, f64::max);
            let len = drawn.left.first().map_or(0, |draw| draw[c].len());
            sum.white += (white * len as f64).min(mean);
        }
    }
    let mean = |sum: InputNoise| {
        let all = [sum.variance, sum.most, sum.white];
        // A plant that runs away says nothing.
        if all.iter().any(|square| !square.is_finite()) {
            return InputNoise::default();
        }
        let [variance, most, white] = all.map(|square| square / count.max(1) as f64);
        InputNoise {
            variance,
            most,
            white,
        }
    };
    Ok(all.into_iter().map(mean).collect())
}

/// What draws of noise on the inputs do to the outputs of a run.
pub(super) struct Drawn {
    /// r of (1), by draw and channel.
    pub(super) left: Vec<Vec<Vec<f64>>>,
    /// Variance of the white noise that is seen in each channel.
    white: Vec<f64>,
}

/// The draws for every run whose inputs have noise, as told for `input_noise`.
pub(super) fn draws(
    problem: &Problem,
    placed: &[Placed],
    weights: &FitOptions,
    others: &[Run],
) -> Result<Vec<Drawn>, EstimateError> {
    let parameters: Vec<Placed> = placed.iter().filter(|p| is_nominal(p)).cloned().collect();
    let seen: Vec<Vec<Seen>> = problem.runs.iter().chain(others).map(seen).collect();
    let mut all = vec![];
    for (index, run) in problem.runs.iter().enumerate() {
        let sizes: Vec<f64> = (0..run.inputs.len())
            .map(|k| match seen[index][k] {
                Seen::Noise(std) => std,
                Seen::Hidden { most } => least_seen(&seen, k).map_or(0.0, |std| std.min(most)),
            })
            .collect();
        if sizes.iter().all(|size| *size == 0.0) {
            continue;
        }
        let simulator = problem.simulator(&parameters, index)?;
        let rest = vec![0.0; simulator.state_len()];
        let mut drawn: Vec<Run> = (0..DRAWS)
            .map(|draw| {
                let mut noisy = run.clone();
                for (k, (input, size)) in noisy.inputs.iter_mut().zip(&sizes).enumerate() {
                    add_white(input, *size, [index as u64, draw, k as u64]);
                }
                noisy
            })
            .collect();
        let job = |run| Job {
            simulator: &simulator,
            run,
            initial: &rest,
            smooth: false,
        };
        let jobs: Vec<Job<'_>> = [run].into_iter().chain(&drawn).map(job).collect();
        let mut responses = predict_all(&jobs).into_iter();
        let clean = responses.next().transpose()?.unwrap_or_default();
        let responses = responses.collect::<Result<Vec<_>, SimulateError>>()?;
        let seen = responses.par_iter().map(|response| -> Vec<f64> {
            let channels = response.iter().zip(&clean).enumerate();
            let seen = channels.map(|(c, (noisy, clean))| {
                let mut moved: Vec<f64> = noisy.iter().zip(clean).map(|(a, b)| a - b).collect();
                problem.whitening.apply(c, &mut moved);
                white_noise_std(&moved).map_or(0.0, |noise| noise.std)
            });
            seen.collect()
        });
        let mut white = vec![0.0; clean.len()];
        for seen in seen.collect::<Vec<Vec<f64>>>() {
            for (white, seen) in white.iter_mut().zip(seen) {
                *white += seen * seen / DRAWS as f64;
            }
        }
        for (noisy, response) in drawn.iter_mut().zip(responses) {
            // The model is driven by the input as it is.
            noisy.inputs.clone_from(&run.inputs);
            noisy.measured = response.into_iter().map(Some).collect();
        }
        let left = fit_initial_states(&problem.with_runs(drawn), &parameters, weights)?;
        all.push(Drawn {
            left: left.discrepancy,
            white,
        });
    }
    Ok(all)
}

/// White noise on an input.
#[derive(Debug, Clone, Copy)]
enum Seen {
    /// Its standard deviation; zero where there is nothing but rounding.
    Noise(f64),
    /// What looks like noise is excitation, and the noise is at most that; none where an input stands still, which
    /// says nothing of one that moves.
    Hidden { most: f64 },
}

fn seen(run: &Run) -> Vec<Seen> {
    run.inputs.iter().map(|input| noise_of(input)).collect()
}

fn noise_of(input: &[f64]) -> Seen {
    if input.windows(2).all(|pair| pair[0] == pair[1]) {
        return Seen::Hidden { most: 0.0 };
    }
    let mean = input.iter().sum::<f64>() / input.len().max(1) as f64;
    let square: f64 = input.iter().map(|u| (u - mean).powi(2)).sum();
    let std = (square / input.len().max(1) as f64).sqrt();
    let found = white_noise_std(input).map_or(0.0, |noise| noise.std);
    if !found.is_finite() || found < LEAST * std || found == 0.0 {
        return Seen::Noise(0.0);
    }
    let is_flat = || {
        let fall = fall_of_spectrum(input);
        fall.is_ok_and(|fall| fall.iter().zip(FALL).all(|(fall, most)| *fall < most))
    };
    if found <= MOST * std && is_flat() {
        Seen::Noise(found)
    } else {
        Seen::Hidden { most: found }
    }
}

/// The least noise that is seen on an input in any run.
fn least_seen(seen: &[Vec<Seen>], input: usize) -> Option<f64> {
    let stds = seen.iter().filter_map(|run| match run.get(input) {
        Some(Seen::Noise(std)) => Some(*std),
        _ => None,
    });
    stds.min_by(f64::total_cmp)
}

pub(super) fn square_sum(values: &[f64]) -> f64 {
    values.iter().map(|value| value * value).sum()
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

    /// A run of the table by its input.
    fn run(input: Vec<f64>) -> Run {
        Run {
            name: "a".into(),
            start_s: 0.0,
            time_step_s: STEP_S,
            len: input.len(),
            first_index: 0,
            mended: simgap_simulate::Mended::default(),
            measured: vec![Some(vec![0.0; input.len()])],
            inputs: vec![input],
        }
    }

    /// r of an output of the table for its input, other runs beside it.
    fn driven(output: &str, input: Vec<f64>, others: &[Run]) -> InputNoise {
        let model = Model::from_toml(&TEXT.replace("displacement", output)).unwrap();
        let problem = Problem::new(&model, vec![run(input)]).unwrap();
        let weights = FitOptions::white(1);
        input_noise(&problem, &[], &weights, others).unwrap()[0]
    }

    /// Root mean square of r in the displacement.
    fn found(input: Vec<f64>) -> f64 {
        driven("displacement", input, &[]).rms()
    }

    fn white(std: f64) -> Vec<f64> {
        let mut noise = vec![0.0; ROWS];
        add_white(&mut noise, std, [7, 7, 7]);
        noise
    }

    fn slow(n: usize) -> f64 {
        10.0 * (TAU * 1.0 * n as f64 * STEP_S).sin()
    }

    /// White noise of the standard deviation s, sampled every h, has the intensity s² h below the band of the plant:
    /// the displacement has the variance s² h / (2 c k).
    #[test]
    fn verify_noise_of_a_force_moves_an_oscillator_by_the_closed_form() {
        let std = 0.3;
        let noise = white(std);
        let input = noise.iter().enumerate().map(|(n, w)| slow(n) + w);
        let needed = (std * std * STEP_S / (2.0 * 12.57 * 1974.0)).sqrt();
        let found = found(input.collect());
        // Six draws of sixty decay times each.
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
        let mut excitation = white(10.0);
        assert_eq!(found(excitation.clone()), 0.0);
        // The same through a filter of the first order, a slow one: what is left of it at half the sample rate.
        let mut last = 0.0;
        for value in &mut excitation {
            last = 0.97 * last + 0.03 * *value;
            *value = last;
        }
        assert_eq!(found(excitation), 0.0);
    }

    #[test]
    fn noise_that_excitation_hides_is_that_of_another_run() {
        let noisy = run(white(0.3)
            .iter()
            .enumerate()
            .map(|(n, w)| slow(n) + w)
            .collect());
        let alone = driven("displacement", white(10.0), &[]);
        let beside = driven("displacement", white(10.0), std::slice::from_ref(&noisy));
        let seen = found(noisy.inputs[0].clone());
        assert_eq!(alone.rms(), 0.0);
        assert!((beside.rms() / seen - 1.0).abs() < 0.3, "{beside:?}");
        // A run that is let go, its drive at rest, does not say that the drive has no noise.
        let with_free = driven("displacement", white(10.0), &[noisy, run(vec![0.0; ROWS])]);
        assert_eq!(with_free.rms(), beside.rms());
    }

    /// The acceleration of a mass follows the force on it at once: (w/m)² of r looks white.
    #[test]
    fn verify_what_passes_straight_on_counts_once() {
        let std = 0.3;
        let input = white(std).into_iter().enumerate().map(|(n, w)| slow(n) + w);
        let noise = driven("acceleration", input.collect(), &[]);
        let straight_on = (std / 2.0_f64).powi(2);
        assert!((noise.white / straight_on - 1.0).abs() < 0.1, "{noise:?}");
        assert!(noise.beyond(2.0 * straight_on) < 0.3 * straight_on);
        // A set that leaves half of it has half of it still to come.
        let half = noise.beyond(0.5 * noise.white) - noise.beyond(noise.white);
        assert!((half / (0.5 * noise.white) - 1.0).abs() < 1e-9, "{noise:?}");
    }
}
