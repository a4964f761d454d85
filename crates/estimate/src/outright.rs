//! Effects at many values each, scored by the whole of what they do.
//!
//! The linear score sees an effect while it is small. Friction that holds, a stop that is hit and a
//! mode that rings are not small effects grown large: which of their values to start a fit from, only a
//! simulation with these values tells. The change of the prediction by the effect as it stands takes
//! the place of the column C in (1) of [`score`](crate::score()), and all sizes of the effect are taken
//! in proportion at what the data ask for.

use crate::base::{Base, InCommon, Regressor, Trial};
use crate::score::{Score, score_each, sized};
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
    let alone = (candidate, None);
    score_each(base, alone, points, whole, |values, in_common, own| {
        base.score_resized(candidate, values, in_common, own.start)
    })
}

/// The effect with all of its values, the same in every record.
fn whole(values: &[f64]) -> Vec<Trial> {
    vec![(values.to_vec(), 1.0)]
}

impl Base<'_> {
    /// With all sizes of the effect in proportion.
    fn score_resized(
        &self,
        candidate: &Candidate,
        values: &[f64],
        in_common: &InCommon,
        trial: usize,
    ) -> Option<Score> {
        let column = Regressor { trial, run: None };
        let (amplitude, explained) = self.amplitudes(in_common, &[column])?;
        let mut values = sized(candidate.effect, values, None, amplitude[0]);
        candidate.effect.make_physical(&mut values);
        let is_seen = amplitude[0] > 0.0 && explained.is_finite();
        is_seen.then(|| self.scored(candidate, values, explained))
    }
}
