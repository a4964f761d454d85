//! How far predictions of the check records may be off because the parameters are known no better.
//!
//! ```text
//! σ_c² = Σ_k mean((y_k − ŷ)²)                                             (1)
//! ```
//!
//! y_k is predicted with everything one standard deviation away along the k-th independent direction of what was
//! fitted, from an initial state of its own. A lightly damped machine that was trained beside a resonance and is checked at it is
//! predicted worse by a true set than noise lets expect, and as much worse as (1) says.

use rayon::prelude::*;
use simgap_effects::Placed;
use simgap_estimate::{EstimateError, Fit, FitOptions, Problem, deviations};

use crate::gap::{Prediction, predict, total};

/// Largest spread of a channel by which a set is judged, over its standard deviation: a set whose parameters say nothing is
/// no explanation.
const MOST: f64 = 0.02;

/// σ_c of (1) over the motion of the check records, of all channels together. Directions along which the model cannot be
/// simulated are left out.
pub(crate) fn spread_of_check(
    check: &Problem,
    (train, estimate, weights): (&Problem, &Fit, &FitOptions),
    corrected: &Prediction,
) -> Result<f64, EstimateError> {
    let deviations = deviations(train, estimate, weights)?;
    let plain = FitOptions::white(check.model.outputs.len());
    let squares = deviations.par_iter().map(|placed: &Vec<Placed>| {
        let moved = predict(check, placed, &plain).ok()?;
        Some(mean_squares(&moved, corrected))
    });
    let squares: Vec<Option<Vec<f64>>> = squares.collect();
    let std = check.output_std().into_iter().enumerate();
    let shares: Vec<f64> = std
        .map(|(c, std)| {
            let square: f64 = squares
                .iter()
                .flatten()
                .map(|of_channel| of_channel[c])
                .sum();
            let share = square.sqrt() / std;
            if share < MOST { share } else { MOST }
        })
        .collect();
    Ok(total(&shares))
}

/// Mean square distance of two predictions, channel by channel.
fn mean_squares(one: &Prediction, other: &Prediction) -> Vec<f64> {
    let channels = one.nrmse.len();
    let of_channel = |c: usize| {
        let (mut square, mut count) = (0.0, 0);
        for (one, other) in one.discrepancy.iter().zip(&other.discrepancy) {
            let apart = one[c].iter().zip(&other[c]).map(|(a, b)| (a - b).powi(2));
            square += apart.sum::<f64>();
            count += one[c].len();
        }
        square / count.max(1) as f64
    };
    (0..channels).map(of_channel).collect()
}
