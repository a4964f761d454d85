//! Pairs of effects that the best candidates beside a single effect do not lead to.
//!
//! What a second effect does is scored by its first order about a start of its own. That says little of one with a shape, and
//! nothing of one that the first leaves too small a trace of: such pairs are tried from many values, and from the values
//! that both were fitted with alone.

use simgap_effects::Placed;
use simgap_estimate::{Base, Candidate, EstimateError, Start, joint_scores, linearise_at};

use crate::candidate_model::{CandidateModel, add};
use crate::search::Search;

/// Single effects that are tried with a second one from afar.
const FAR: usize = 2;
/// Sets of two and of three that are fitted by their joint score, and shapes of each candidate that are scored.
const JOINT: usize = 16;
const SHAPES: usize = 3;
/// Single effects that are tried with each other.
const UNITED: usize = 6;

impl Search<'_> {
    /// Sets of two and three beside `base` that explain most together, by their joint scores.
    pub(crate) fn fit_joint(
        &self,
        base: &CandidateModel,
        linear: &Base<'_>,
    ) -> Vec<CandidateModel> {
        let candidates = self.space.candidates.iter();
        let free = candidates.filter(|(candidate, _)| self.may_hold(base, candidate));
        let shapes: Vec<(Candidate, Vec<f64>)> = free
            .flat_map(|(candidate, scale)| {
                let shapes = candidate.effect.starts(scale).into_iter().take(SHAPES);
                shapes.map(move |shape| (candidate.clone(), shape))
            })
            .collect();
        let scores = joint_scores(linear, &shapes, JOINT);
        let starts: Vec<Start> = scores
            .into_iter()
            .map(|score| {
                let start = base.fit.estimate.clone();
                score
                    .starts
                    .into_iter()
                    .fold(start, |start, placed| add(&start, placed))
            })
            .collect();
        self.fit_all(&starts, linear)
    }

    /// The best of some sets, with one more effect from afar.
    pub(crate) fn extend_from_many_values(
        &self,
        sets: &[&CandidateModel],
    ) -> Result<Vec<CandidateModel>, EstimateError> {
        let mut found = Vec::new();
        for set in sets.iter().take(FAR) {
            if self.is_spent() {
                break;
            }
            let linear = linearise_at(self.problem, &set.fit, &self.options)?;
            found.extend(self.multistart(set, &linear)?);
        }
        Ok(found)
    }

    /// The best single effects of a pool in pairs, from the values that they were fitted with alone.
    pub(crate) fn unite(
        &self,
        pool: &[CandidateModel],
    ) -> Result<Vec<CandidateModel>, EstimateError> {
        let singles = pool.iter().filter(|set| set.effects().len() == 1);
        let singles: Vec<&CandidateModel> = singles.take(UNITED).collect();
        let mut found = Vec::new();
        for (i, one) in singles.iter().enumerate() {
            let others = singles[i + 1..].iter();
            let starts: Vec<Start> = others.filter_map(|other| united(one, other)).collect();
            if starts.is_empty() || self.is_spent() {
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
