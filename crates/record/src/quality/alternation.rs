//! A component that changes sign at every sample.

use std::f64::consts::PI;

use super::finding::Defect;
use super::lattice::Lattice;

/// Parts of the record whose estimates are compared.
const PARTS: usize = 16;
/// Shorter parts leak: 16 parts of 16 rows.
const LEAST_ROWS: usize = 256;
/// Standard errors; with 16 parts, Gaussian noise gets there once in a million channels.
const SIGNIFICANCE: f64 = 8.0;
/// Least amplitude over the standard deviation of the channel: what leaks through the taper from
/// a component below a third of the sample rate is less.
const LEAST_SHARE: f64 = 1e-3;

/// Second differences of more than this many third quartiles are left out: jumps of a square wave
/// or of dry friction, which have a line at half the sample rate of their own. The quartile, not
/// the median: of a sine of six samples a period a third of them is far above the others.
const LEFT_OUT: f64 = 5.0;
/// Least amplitude in steps of a lattice: rounding moves no sample further, and may alternate.
const LEAST_STEPS: f64 = 0.5;

/// The defect, if any.
///
/// ```text
/// cₙ = yₙ₋₁ - 2 yₙ + yₙ₊₁            of a (-1)ⁿ: -4 a (-1)ⁿ          (1)
/// aₚ = -¼ Σ wₙ (-1)ⁿ cₙ / Σ wₙ       over part p, w a Hann taper       (2)
/// a  = mean aₚ,  s = std aₚ / √16                                       (3)
/// ```
///
/// The second difference (1) and the taper (2) keep slow motion out.
pub(super) fn alternation(values: &[f64], lattice: Option<Lattice>) -> Option<Defect> {
    if values.len() < LEAST_ROWS {
        return None;
    }
    let bends: Vec<f64> = values
        .windows(3)
        .map(|y| y[0] - 2.0 * y[1] + y[2])
        .collect(); // (1)
    // Parts of even length all start with the same sign.
    let len = bends.len() / PARTS / 2 * 2;
    let taper: Vec<f64> = (0..len)
        .map(|n| (PI * (n as f64 + 0.5) / len as f64).sin().powi(2))
        .collect();
    let estimates: Vec<f64> = bends
        .chunks_exact(len)
        .take(PARTS)
        .map(|part| amplitude_of(part, &taper))
        .collect();
    let (amplitude, spread) = mean_and_deviation(&estimates);
    let error = spread / (PARTS as f64).sqrt(); // (3)
    let (_, deviation) = mean_and_deviation(values);
    let rounding = lattice.map_or(0.0, |l| LEAST_STEPS * l.step);
    let least = (SIGNIFICANCE * error)
        .max(LEAST_SHARE * deviation)
        .max(rounding);
    let told = amplitude.abs() > least;
    told.then(|| Defect::Alternation {
        amplitude,
        significance: amplitude.abs() / error,
    })
}

/// (2) for the second differences of one part.
fn amplitude_of(part: &[f64], taper: &[f64]) -> f64 {
    let mut magnitudes: Vec<f64> = part.iter().map(|bend| bend.abs()).collect();
    let quartile = magnitudes.len() * 3 / 4;
    let most = LEFT_OUT
        * *magnitudes
            .select_nth_unstable_by(quartile, f64::total_cmp)
            .1;
    let (mut sum, mut weight) = (0.0, 0.0);
    for (n, (&bend, &w)) in part.iter().zip(taper).enumerate() {
        if bend.abs() <= most {
            // The first second difference is about row 1, where (-1)ⁿ is -1.
            sum += if n.is_multiple_of(2) {
                -w * bend
            } else {
                w * bend
            };
            weight += w;
        }
    }
    -0.25 * sum / weight
}

fn mean_and_deviation(values: &[f64]) -> (f64, f64) {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let square: f64 = values.iter().map(|v| (v - mean) * (v - mean)).sum();
    (mean, (square / (count - 1.0)).sqrt())
}
