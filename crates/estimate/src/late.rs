//! By how much signals come late.
//!
//! ```text
//! u²(k) = Σ (yₙ₊ₖ − ŷₙ)² / (σ² N_k),   the k that leaves least              (1)
//! ```
//!
//! y is what was measured, ŷ what a fit predicts, σ the spread of the channel; the sum is over the N_k samples of all records and channels
//! that k leaves. A long delay shows itself so where sensitivities to a short one lead nowhere: the objective of a fit has a valley at
//! every swing of the signal.

use simgap_model::Location;
use simgap_signal::correlation::cross_correlation;

use crate::{Fit, Problem};

/// Share of a record that may be late.
const MOST: f64 = 0.25;

impl Problem {
    /// By how much a channel, at an input all channels together, come later than a fit predicts, s, by (1), to a sample. Zero at every other
    /// place. Of records of several rates those of the rate of the longest tell.
    #[must_use]
    pub fn late(&self, fit: &Fit, at: &Location) -> f64 {
        let channels: Vec<usize> = match at {
            Location::Input(_) => (0..self.model.outputs.len()).collect(),
            Location::Channel(name) => self.model.output_index(name).into_iter().collect(),
            _ => vec![],
        };
        let longest = self.runs.iter().max_by_key(|run| run.len);
        let Some(step) = longest.map(|run| run.time_step_s) else {
            return 0.0;
        };
        let alike = |run: usize| self.runs[run].time_step_s == step;
        let runs: Vec<usize> = (0..self.runs.len()).filter(|run| alike(*run)).collect();
        let shortest = runs.iter().map(|run| self.runs[*run].len).min();
        let most = (MOST * shortest.unwrap_or(0) as f64) as usize;
        let std = self.output_std();
        let (mut left, mut counts) = (vec![0.0; most + 1], vec![0.0; most + 1]);
        for &run in &runs {
            let len = self.runs[run].len;
            let recorded = &self.runs[run].measured;
            let signals = recorded.iter().map(Option::as_ref);
            let mut measured: Vec<Vec<f64>> = signals
                .map(|signal| signal.map_or_else(|| vec![0.0; len], Clone::clone))
                .collect();
            self.whiten(run, &mut measured);
            let seen = channels.iter().filter(|c| recorded[**c].is_some());
            for &c in seen.filter(|c| std[**c] > 0.0) {
                let predicted = measured[c].iter().zip(&fit.discrepancy[run][c]);
                let predicted: Vec<f64> = predicted.map(|(y, e)| y - e).collect();
                let Some(squares) = squares_left(&measured[c], &predicted, most) else {
                    continue;
                };
                let each = left.iter_mut().zip(&mut counts).zip(squares).enumerate();
                for (k, ((left, count), square)) in each {
                    *left += square / std[c].powi(2);
                    *count += (len - k) as f64;
                }
            }
        }
        let mean = |k: usize| left[k] / f64::max(counts[k], 1.0);
        let least = (0..=most).min_by(|a, b| mean(*a).total_cmp(&mean(*b)));
        least.unwrap_or(0) as f64 * step
    }
}

/// Σ (yₙ₊ₖ − ŷₙ)² for every k up to the most; `None` where a signal is not finite or too short.
fn squares_left(measured: &[f64], predicted: &[f64], most: usize) -> Option<Vec<f64>> {
    let products = cross_correlation(measured, predicted, most).ok()?;
    let (late, early) = (sums_of_squares(measured), sums_of_squares(predicted));
    let len = measured.len();
    let of_lag = |(k, product): (usize, f64)| {
        // Squares of the last N − k of what was measured, and of the first of what is predicted.
        let own = (late[len] - late[k]) + early[len - k];
        f64::max(own - 2.0 * product, 0.0)
    };
    Some(products.into_iter().enumerate().map(of_lag).collect())
}

/// Of the first n values, for every n.
fn sums_of_squares(values: &[f64]) -> Vec<f64> {
    let mut sums = vec![0.0];
    let mut sum = 0.0;
    for value in values {
        sum += value * value;
        sums.push(sum);
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verify_squares_left_are_those_of_the_shifted_signals() {
        let predicted: Vec<f64> = (0..200).map(|n| f64::from(n * n * 7919 % 1009)).collect();
        let measured: Vec<f64> = (0..200).map(|n| predicted[(n + 163) % 200]).collect();
        let left = squares_left(&measured, &predicted, 50).unwrap();
        for (k, left) in left.iter().enumerate() {
            let pairs = measured[k..].iter().zip(&predicted);
            let exact: f64 = pairs.map(|(y, p)| (y - p).powi(2)).sum();
            assert!(
                (left - exact).abs() < 1e-6 * (exact + 1e6),
                "{left} for {exact}"
            );
        }
        let least = (0..=50).min_by(|a, b| left[*a].total_cmp(&left[*b]));
        assert_eq!(least, Some(37));
    }
}
