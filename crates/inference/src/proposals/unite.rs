//! Pairs of effects that the best candidates beside a single effect do not lead to.
//!
//! What a second effect does is scored by its first order about a start of its own. That says little of one with a shape, and
//! nothing of one that the first leaves too small a trace of: such pairs are tried from many values, and from the values
//! that both were fitted with alone.

use simgap_effects::Placed;
use simgap_estimate::{Candidate, EstimateError, Start, linearise_at};

use crate::candidate_model::{CandidateModel, add};
use crate::search::Search;

/// Single effects that are tried with a second one from afar.
const FAR: usize = 2;
/// Single effects that are tried with each other.
const UNITED: usize = 6;

impl Search<'_> {
    /// The best of some sets, with one more effect from afar.
    pub(crate) fn extend_from_many_values(
        &self,
        sets: &[&CandidateModel],
    ) -> Result<Vec<CandidateModel>, EstimateError> {
        let mut found = Vec::new();
        for set in sets.iter().take(FAR) {
            let linear = linearise_at(self.problem, &set.fit, &self.options)?;
            found.extend(self.multistart(set, &linear)?);
        }
        Ok(found)
    }

    /// The best single effects of a pool in pairs, from the values that they were fitted with alone.
    pub(crate) fn unite(&self, pool: &[CandidateModel]) -> Result<Vec<CandidateModel>, EstimateError> {
        let singles = pool.iter().filter(|set| set.effects().len() == 1);
        let singles: Vec<&CandidateModel> = singles.take(UNITED).collect();
        let mut found = Vec::new();
        for (i, one) in singles.iter().enumerate() {
            let others = singles[i + 1..].iter();
            let starts: Vec<Start> = others.filter_map(|other| united(one, other)).collect();
            if starts.is_empty() {
                continue;
            }
            let linear = linearise_at(self.problem, &one.fit, &self.options)?;
            found.extend(self.fit_all(&starts, &linear));
        }
        Ok(found)
    }
}

/// A set with the effect of another; `None` where it makes no sense beside its own.
fn united(one: &CandidateModel, other: &CandidateModel) -> Option<Start> {
    let Placed { effect, at, .. } = other.effects().first()?;
    let candidate = Candidate {
        effect: *effect,
        at: at.clone(),
    };
    let makes_sense = !one.rules_out(&candidate);
    makes_sense.then(|| add(&one.fit.estimate, other.effects()[0].clone()))
}
