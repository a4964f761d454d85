//! How much of the gap an answer really closes: its predictions held against the truth without noise.

use crate::gap::std;
use crate::size::rms;

/// For each check record, each output, in model units.
pub type Signals = Vec<Vec<Vec<f64>>>;

/// The closed share of a gap, 1 for all of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Closing {
    /// As the answer states it.
    pub stated: f64,
    /// 1 − gap(corrected) / gap(nominal), both against the truth without noise.
    pub actual: f64,
    /// The same with the true effects and parameters in place of the corrected model; NaN where
    /// that was not asked for.
    pub best: f64,
}

/// rms(predicted − truth) / std(truth) of each output over all records, and of these the root of the
/// mean square. NaN when the shapes differ.
///
/// ```
/// let truth = vec![vec![vec![1.0, -1.0, 1.0, -1.0]]];
/// let predicted = vec![vec![vec![1.1, -0.9, 1.1, -0.9]]];
/// assert!((simgap_blind::gap_to(&truth, &predicted) - 0.1).abs() < 1e-12);
/// ```
#[must_use]
pub fn gap_to(truth: &Signals, predicted: &Signals) -> f64 {
    let shape = |signals: &Signals| -> Vec<Vec<usize>> {
        let lengths = |record: &Vec<Vec<f64>>| record.iter().map(Vec::len).collect();
        signals.iter().map(lengths).collect()
    };
    if shape(truth) != shape(predicted) {
        return f64::NAN;
    }
    let outputs = truth.first().map_or(0, Vec::len);
    let squares = (0..outputs).map(|c| {
        let of = |signals: &Signals| -> Vec<f64> {
            signals
                .iter()
                .flat_map(|record| record[c].clone())
                .collect()
        };
        let (truth, predicted) = (of(truth), of(predicted));
        let apart: Vec<f64> = truth.iter().zip(&predicted).map(|(a, b)| a - b).collect();
        (rms(&apart) / std(&truth)).powi(2)
    });
    (squares.sum::<f64>() / outputs as f64).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verify_the_gap_of_two_outputs_is_the_root_of_the_mean_square() {
        let truth = vec![vec![vec![1.0, -1.0], vec![10.0, -10.0]]];
        let predicted = vec![vec![vec![1.3, -0.7], vec![14.0, -6.0]]];
        let expected = (0.5_f64 * (0.3 * 0.3 + 0.4 * 0.4)).sqrt();
        assert!((gap_to(&truth, &predicted) - expected).abs() < 1e-12);
    }

    #[test]
    fn verify_predictions_of_another_length_have_no_gap() {
        let truth = vec![vec![vec![1.0, -1.0]]];
        assert!(gap_to(&truth, &vec![vec![vec![1.0]]]).is_nan());
        assert!(gap_to(&truth, &vec![]).is_nan());
    }
}
