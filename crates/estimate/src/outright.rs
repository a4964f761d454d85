//! Effects at many values each, scored by the whole of what they do.
//!
//! The linear score sees an effect while it is small. Friction that holds, a stop that is hit and a
//! mode that rings are not small effects grown large: which of their values to start a fit from, only a
//! simulation with these values tells. With d the change of the prediction by the effect as it stands,
//! r, J, H and g those of the base,
//!
//! ```text
//! left = rᵀWr − 2 dᵀWr + dᵀWd − (g − JᵀWd)ᵀ H⁻¹ (g − JᵀWd)               (1)
//! gain = −½ Σ_c ρ_c N_c ln(left / rᵀWr)                                  (2)
//! ```
//!
//! (1) is the squared discrepancy after everything the fit may still adjust has taken its part. An effect
//! that grows in proportion to a size is taken at the size that the data ask for, as in
//! [`score`](crate::score).

use faer::Mat;

use crate::linearise::Signals;
use crate::normal::inner;
use crate::score::{Base, SHAPES_TOGETHER, Score, Trial};
use crate::{Candidate, EstimateError};

/// Scores one candidate at each of many values, best first. Values from which the plant runs away are
/// left out.
///
/// # Errors
/// [`EstimateError`] when the model cannot be propagated.
pub fn score_outright(
    base: &Base<'_>,
    candidate: &Candidate,
    points: &[Vec<f64>],
) -> Result<Vec<Score>, EstimateError> {
    let mut scores = Vec::with_capacity(points.len());
    for few in points.chunks(SHAPES_TOGETHER) {
        let trials: Vec<Trial> = few.iter().map(|values| (values.clone(), 1.0)).collect();
        let changes = base.columns(candidate, &trials)?;
        for (values, change) in few.iter().zip(changes) {
            let values = values.clone();
            scores.extend(if candidate.effect.grows_in_proportion() {
                base.score_resized(candidate, values, change)
            } else {
                base.score_as_given(candidate, values, &change)
            });
        }
    }
    scores.sort_by(|a, b| b.gain.total_cmp(&a.gain));
    Ok(scores)
}

impl Base<'_> {
    /// With all sizes of the effect in proportion.
    fn score_resized(
        &self,
        candidate: &Candidate,
        mut values: Vec<f64>,
        change: Vec<Signals>,
    ) -> Option<Score> {
        let (amplitude, explained) = self.amplitudes(&[change])?;
        let parameters = candidate.effect.parameters().iter();
        for (parameter, value) in parameters.zip(&mut values) {
            match parameter.neutral {
                Some(neutral) if neutral.is_finite() && !parameter.per_record => {
                    *value = neutral + amplitude[0] * (*value - neutral);
                }
                _ => {}
            }
        }
        candidate.effect.make_physical(&mut values);
        let is_seen = amplitude[0] > 0.0 && explained.is_finite();
        is_seen.then(|| self.scored(candidate, values, explained))
    }

    fn score_as_given(
        &self,
        candidate: &Candidate,
        values: Vec<f64>,
        change: &[Signals],
    ) -> Option<Score> {
        let explained = self.energy - self.left_after(change).max(0.0);
        explained
            .is_finite()
            .then(|| self.scored(candidate, values, explained))
    }

    /// (1) of a change of the prediction of every run.
    fn left_after(&self, change: &[Signals]) -> f64 {
        let mut wanted = Mat::from_fn(self.layout.len(), 1, |l, _| self.gradient[l]);
        let mut left = self.energy;
        for (run, change) in change.iter().enumerate() {
            left += inner(change, change, &self.weights)
                - 2.0 * inner(change, &self.at.discrepancy[run], &self.weights);
            for (row, nuisance) in self.layout.entries(run).zip(&self.at.columns[run]) {
                wanted[(row, 0)] -= inner(nuisance, change, &self.weights);
            }
        }
        let taken = self.past_nuisance(&wanted);
        left - (0..self.layout.len())
            .map(|l| wanted[(l, 0)] * taken[(l, 0)])
            .sum::<f64>()
    }
}
