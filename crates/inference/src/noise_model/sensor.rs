//! Noise of the sensors in what a set leaves.
//!
//! ```text
//! r_n = a r_{n−1} + w_n − b w_{n−1},   0 ≤ b ≤ a < 1,   w white              (1)
//! c_{k+1} = a c_k for k ≥ 1,   b / (1 + b²) = (a c_0 − c_1) / ((1 + a²) c_0 − 2 a c_1)     (2)
//! ```
//!
//! Where a discrepancy is (1), all of it is noise: of a sensor and its filter or amplifier (b = 0), with white noise of the converter
//! behind it, which b stands for. (2) is what the autocovariances c_k of (1) say of a and b. So it is where it is noise of a finite memory,
//!
//! ```text
//! r_n = Σ_{k=0…q} b_k w_{n−k},   c_k = 0 for k > q                           (3)
//! ```
//!
//! as what is filtered or averaged over a few samples leaves, and what is a difference of displacements, of neighbours or central. Where a
//! discrepancy is neither, the white part of it is noise, which differences of neighbouring samples tell.
//!
//! Reference: \[Ljung1999\], chapter 4.

use simgap_effects::{Action, Placed};
use simgap_estimate::{Problem, Whitening};
use simgap_model::Location;
use simgap_signal::correlation::{autocorrelation, effective_sample_count};
use simgap_signal::noise::white_noise_std;

use super::NOISE_KNOWN;

/// Share of independent samples from which w of (1) is white.
const WHITE: f64 = 0.8;
/// Lags beyond q that are looked at, and q with them, as a multiple of it.
const BEYOND: usize = 3;
/// Mean size of w over its rms, at least: 0.80 for normal noise, small for a few jumps among many small steps.
const EVEN: f64 = 0.7;
/// Lags of (2), and q of (3).
const LAGS: usize = 10;
/// Largest a of (1): a discrepancy that is correlated over more than ten samples is a motion.
const MOST_COLOUR: f64 = 0.92;

/// The step in which effects store each channel.
fn steps(problem: &Problem, effects: &[Placed]) -> Vec<Option<f64>> {
    let of = |channel: &str| {
        effects.iter().find_map(|placed| match placed.action() {
            Action::Sampling(map) if placed.at == Location::Channel(channel.into()) => map.step(),
            _ => None,
        })
    };
    let outputs = problem.model.outputs.iter();
    outputs.map(|output| of(&output.channel)).collect()
}

/// Which channels effects store in steps.
#[must_use]
pub fn stepped(problem: &Problem, effects: &[Placed]) -> Vec<bool> {
    let steps = steps(problem, effects).into_iter();
    steps.map(|step| step.is_some()).collect()
}

/// Variance of what effects round off in each channel, q²/12 for a step q: within it, values that are rounded right say
/// nothing.
#[must_use]
pub fn rounding_variance(problem: &Problem, effects: &[Placed]) -> Vec<f64> {
    let steps = steps(problem, effects).into_iter();
    steps.map(variance_of_step).collect()
}

/// The same of the steps in which each channel is stored, whatever stores it so.
#[must_use]
pub fn stored_rounding_variance(problem: &Problem) -> Vec<f64> {
    let channels = 0..problem.model.outputs.len();
    let steps = channels.map(|channel| problem.lattice_of(channel).map(|(step, _)| step));
    steps.map(variance_of_step).collect()
}

fn variance_of_step(step: Option<f64>) -> f64 {
    step.unwrap_or(0.0).powi(2) / 12.0
}

/// Whether a discrepancy is noise of a sensor and nothing else, (1) or (3).
fn is_sensor_noise(discrepancy: &[f64]) -> bool {
    is_filtered_noise(discrepancy) || has_short_memory(discrepancy)
}

/// (3): what is more than q samples apart is not correlated, and the w, by the autoregression of the same memory, are no few jumps.
/// What samples are correlated by chance counts against it: a short record does not tell.
fn has_short_memory(discrepancy: &[f64]) -> bool {
    let Ok(rho) = autocorrelation(discrepancy, BEYOND * LAGS) else {
        return false;
    };
    let told_ahead: f64 = rho.iter().skip(LAGS + 1).map(|rho| rho * rho).sum();
    told_ahead < NOISE_KNOWN - 1.0 && {
        let filter = Whitening::of_noise(&[vec![discrepancy]], &[0.0], LAGS);
        let mut new = discrepancy.to_vec();
        filter.apply(0, &mut new);
        is_even(&new)
    }
}

/// Whether a discrepancy is (1).
fn is_filtered_noise(discrepancy: &[f64]) -> bool {
    let Ok(correlation) = autocorrelation(discrepancy, LAGS.min(discrepancy.len() / 2)) else {
        return false;
    };
    let colour = correlation.get(1).copied().unwrap_or(1.0).max(0.0);
    let mut processes = [[colour, 0.0], filtered_and_white(&correlation)].into_iter();
    processes.any(|[colour, white]| {
        colour < MOST_COLOUR && is_white(&innovations(discrepancy, [colour, white]))
    })
}

/// a and b by (2), a from all lags by least squares.
fn filtered_and_white(correlation: &[f64]) -> [f64; 2] {
    let pairs = || correlation.windows(2).skip(1);
    let product: f64 = pairs().map(|pair| pair[0] * pair[1]).sum();
    let square: f64 = pairs().map(|pair| pair[0] * pair[0]).sum();
    let colour = (product / square).clamp(0.0, 1.0);
    let first = correlation.get(1).copied().unwrap_or(0.0);
    let share = (colour - first) / (1.0 + colour * colour - 2.0 * colour * first);
    // The root within 0 to 1; at half there is no other.
    let share = share.clamp(0.0, 0.5);
    let white = 2.0 * share / (1.0 + (1.0 - 4.0 * share * share).sqrt());
    [colour, white.min(colour)]
}

/// w of (1) for a and b.
fn innovations(discrepancy: &[f64], [colour, white]: [f64; 2]) -> Vec<f64> {
    let mut last = 0.0;
    let pairs = discrepancy.windows(2);
    let next = pairs.map(|pair| {
        last = pair[1] - colour * pair[0] + white * last;
        last
    });
    next.collect()
}

/// Whether values are white and [even](is_even): neither is their mean known by fewer samples, nor are they told ahead by
/// the last few, of which the share Σ ρ_k² of their variance is told. Correlations of what rings add up to nothing.
fn is_white(values: &[f64]) -> bool {
    let count = values.len() as f64;
    let independent = effective_sample_count(values).unwrap_or(0.0);
    let told_ahead = autocorrelation(values, LAGS.min(values.len() / 2)).map_or(1.0, |rho| {
        // By chance as many parts of the count as there are lags.
        rho.iter().skip(1).map(|rho| rho * rho - 1.0 / count).sum()
    });
    let is_new = told_ahead < NOISE_KNOWN - 1.0;
    independent > WHITE * count && is_new && is_even(values)
}

/// Whether values are not a few jumps among small steps.
fn is_even(values: &[f64]) -> bool {
    let count = values.len() as f64;
    let mean = values.iter().map(|w| w.abs()).sum::<f64>() / count;
    let square = values.iter().map(|w| w * w).sum::<f64>() / count;
    mean > EVEN * square.sqrt()
}

/// Variance of the sensor's noise in each channel of discrepancies, over all runs.
///
/// Where values are stored in steps, noise moves some of them by a step and most not at all: there
/// the robust estimate would be zero. Samples that are clipped, lost or struck hold no noise and say nothing of that of
/// the others.
#[must_use]
pub fn noise_variance(discrepancy: &[Vec<Vec<f64>>], stepped: &[bool]) -> Vec<f64> {
    (0..stepped.len())
        .map(|c| {
            let (mut square, mut count) = (0.0, 0.0);
            for run in discrepancy {
                count += run[c].len() as f64;
                let noisy = match stepped[c] {
                    true => run[c].clone(),
                    false => holding_noise(&run[c]),
                };
                let sum: f64 = noisy.iter().map(|r| r * r).sum();
                if is_sensor_noise(&noisy) {
                    square += sum;
                    continue;
                }
                let sigma = match white_noise_std(&noisy) {
                    Ok(noise) if !stepped[c] => noise.std,
                    _ => short_noise(&noisy),
                };
                square += (sigma * sigma * noisy.len() as f64).min(sum);
            }
            square / f64::max(count, 1.0)
        })
        .collect()
}

/// The discrepancies that hold noise: those of clipped, lost or struck samples are zero, or repeat themselves.
fn holding_noise(discrepancy: &[f64]) -> Vec<f64> {
    let repeats = |n: usize, other: Option<usize>| {
        other.is_some_and(|other| discrepancy.get(other) == Some(&discrepancy[n]))
    };
    let holds_noise = |&n: &usize| {
        discrepancy[n] != 0.0 && !repeats(n, n.checked_sub(1)) && !repeats(n, Some(n + 1))
    };
    let held = (0..discrepancy.len()).filter(holds_noise);
    held.map(|n| discrepancy[n]).collect()
}

/// Noise of a run too short for the robust estimates, from its second differences, whose variance is
/// 6 σ² for white noise. What moves from sample to sample counts as noise here.
fn short_noise(values: &[f64]) -> f64 {
    let squares: Vec<f64> = values
        .windows(3)
        .map(|w| (w[0] - 2.0 * w[1] + w[2]).powi(2) / 6.0)
        .collect();
    (squares.iter().sum::<f64>() / squares.len().max(1) as f64).sqrt()
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    #[test]
    fn verify_clipped_samples_hold_no_noise() {
        let mut word = 7_u64;
        let mut unit = || {
            word = word
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (word >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
        };
        let noise: Vec<f64> = (0..8000).map(|_| 12_f64.sqrt() * unit()).collect();
        // Two thirds of the samples clipped, at a level that is not quite known.
        let clipped = (0..8000).map(|n| if n % 60 < 40 { 1e-3 } else { noise[n] });
        let run = vec![clipped.collect::<Vec<f64>>()];
        let of = |stepped: bool| noise_variance(std::slice::from_ref(&run), &[stepped])[0];
        assert!((3.0 * of(false) - 1.0).abs() < 0.2, "{}", of(false));
        assert!(of(true) > 0.0);
    }

    pub(in crate::noise_model) fn white(count: usize) -> Vec<f64> {
        let mut word = 11_u64;
        let mut unit = || {
            word = word
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (word >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
        };
        (0..count).map(|_| 12_f64.sqrt() * unit()).collect()
    }

    #[test]
    fn verify_coloured_noise_of_a_sensor_counts_in_full() {
        for colour in [0.0, 0.3, 0.65, 0.9] {
            let mut noise = white(6000);
            for n in 1..noise.len() {
                noise[n] += colour * noise[n - 1];
            }
            assert!(is_sensor_noise(&noise), "{colour}");
            let own = noise.iter().map(|r| r * r).sum::<f64>() / 6000.0;
            let found = noise_variance(&[vec![noise]], &[false])[0];
            assert!((found / own - 1.0).abs() < 1e-12, "{colour}");
        }
    }

    #[test]
    fn verify_white_noise_beside_that_of_a_filter_counts_in_full() {
        for colour in [0.4, 0.65, 0.85] {
            let all = white(12_000);
            let (slow, fast) = all.split_at(6000);
            let mut noise = slow.to_vec();
            for n in 1..noise.len() {
                noise[n] += colour * noise[n - 1];
            }
            // As much of the one as of the other.
            let size = (1.0 - colour * colour).sqrt();
            let both = noise
                .iter()
                .zip(fast)
                .map(|(slow, fast)| size * slow + fast);
            let both: Vec<f64> = both.collect();
            let correlation = autocorrelation(&both, LAGS).unwrap();
            let [found, _] = filtered_and_white(&correlation);
            assert!((found - colour).abs() < 0.1, "{found} for {colour}");
            assert!(is_sensor_noise(&both), "{colour}");
        }
    }

    /// Share of a discrepancy that is noise, mean square.
    fn noise_share(left: Vec<f64>) -> f64 {
        let own = left.iter().map(|r| r * r).sum::<f64>() / left.len() as f64;
        noise_variance(&[vec![left]], &[false])[0] / own
    }

    /// Differences of neighbours, central, of five points, of these differences once more, averages.
    const FILTERS: [&[f64]; 7] = [
        &[1.0, -1.0],
        &[1.0, 0.0, -1.0],
        &[-1.0, 8.0, 0.0, -8.0, 1.0],
        &[1.0, -2.0, 1.0],
        &[1.0, 0.0, -2.0, 0.0, 1.0],
        &[1.0, 1.0, 1.0, 1.0, 1.0],
        &[3.0, 2.0, 1.0, 0.0, -1.0, -2.0, -3.0],
    ];

    #[test]
    fn verify_noise_of_differences_and_averages_counts_in_full() {
        let all = white(12_020);
        let (noise, converter) = all.split_at(6020);
        for filter in FILTERS {
            let size = filter.iter().map(|b| b * b).sum::<f64>().sqrt();
            let filtered = noise.windows(filter.len()).map(|window| {
                let terms = window.iter().zip(filter);
                terms.map(|(w, b)| w * b / size).sum::<f64>()
            });
            let filtered: Vec<f64> = filtered.collect();
            for white in [0.0, 0.4] {
                let beside = filtered.iter().zip(converter);
                let left = beside.map(|(left, noise)| left + white * noise);
                let share = noise_share(left.collect());
                assert!((share - 1.0).abs() < 1e-12, "{filter:?} {white}: {share}");
            }
            // A motion as large beside it is none, whatever its frequency.
            for step in [0.05, 0.3, 0.8, 1.2] {
                let moved = filtered.iter().enumerate();
                let left = moved.map(|(n, v)| v + 2_f64.sqrt() * (step * n as f64).sin());
                let share = noise_share(left.collect());
                assert!(share < 0.9, "{filter:?} {step}: {share}");
            }
        }
    }

    /// What a resonator leaves that a broadband force moves, beside as much white noise.
    #[test]
    fn a_resonance_is_no_noise() {
        for samples in [8.0, 20.0, 60.0] {
            let all = white(12_000);
            let (force, noise) = all.split_at(6000);
            let (angle, decay) = (std::f64::consts::TAU / samples, 0.97_f64);
            let mut motion = force.to_vec();
            for n in 2..motion.len() {
                motion[n] +=
                    2.0 * decay * angle.cos() * motion[n - 1] - decay * decay * motion[n - 2];
            }
            let own = motion.iter().map(|x| x * x).sum::<f64>() / 6000.0;
            let left = motion.iter().zip(noise).map(|(x, w)| x / own.sqrt() + w);
            assert!(!is_sensor_noise(&left.collect::<Vec<f64>>()), "{samples}");
        }
    }

    #[test]
    fn a_motion_is_no_noise() {
        let noise = white(6000);
        let motion = |n: usize| 2.0 * (0.2 * n as f64).sin();
        let left: Vec<f64> = (0..6000).map(|n| motion(n) + noise[n]).collect();
        assert!(!is_sensor_noise(&left));
        let found = noise_variance(&[vec![left]], &[false])[0];
        assert!((found - 1.0).abs() < 0.15, "{found}");
    }
}
