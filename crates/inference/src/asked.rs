//! Sets that were asked whether all their effects are relevant.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

use simgap_estimate::EstimateError;

use crate::candidate_model::{CandidateModel, by_rank, keep, name, rank};
use crate::search::Search;

/// Sets, and of each whether all its effects are relevant, once it was asked.
#[derive(Default)]
pub(crate) struct Asked {
    pub(crate) sets: Vec<CandidateModel>,
    pub(crate) relevant: Vec<Option<bool>>,
    /// Where each set is, by its key.
    pub(crate) places: BTreeMap<Vec<String>, usize>,
}

impl Asked {
    /// Adds the sets that are not among them.
    pub(crate) fn extend(&mut self, sets: Vec<CandidateModel>) {
        for set in sets {
            if let Entry::Vacant(place) = self.places.entry(set.key()) {
                place.insert(self.sets.len());
                self.sets.push(set);
                self.relevant.push(None);
            }
        }
    }

    /// The likeliest of the sets that were not asked.
    pub(crate) fn next(&self) -> Option<usize> {
        let open = (0..self.sets.len()).filter(|&i| self.relevant[i].is_none());
        let posterior = |i: &usize| self.sets[*i].log_posterior();
        // Of equals the first.
        open.rev()
            .max_by(|a, b| posterior(a).total_cmp(&posterior(b)))
    }

    /// All but those that hold an irrelevant effect, likeliest first.
    pub(crate) fn kept(self) -> Vec<CandidateModel> {
        let sets = self.sets.into_iter().zip(self.relevant);
        let kept = sets.filter(|(_, relevant)| *relevant != Some(false));
        let mut kept: Vec<CandidateModel> = kept.map(|(set, _)| set).collect();
        rank(&mut kept);
        kept
    }

    /// The likeliest of those.
    pub(crate) fn best(&self) -> Option<&CandidateModel> {
        let sets = self.sets.iter().zip(&self.relevant);
        let kept = sets.filter(|(_, relevant)| **relevant != Some(false));
        kept.map(|(set, _)| set).min_by(|a, b| by_rank(a, b))
    }

    /// Some of the effects of a set, fitted without the others.
    pub(crate) fn part(
        &self,
        search: &Search<'_>,
        set: &CandidateModel,
        part: &[usize],
    ) -> Result<Cow<'_, CandidateModel>, EstimateError> {
        let mut key: Vec<String> = part.iter().map(|i| name(&set.effects()[*i])).collect();
        key.sort();
        if let Some(&known) = self.places.get(&key) {
            return Ok(Cow::Borrowed(&self.sets[known]));
        }
        let start = keep(&set.fit.estimate, |i| part.contains(&i), search.nominal);
        search.fit(&start).map(Cow::Owned)
    }
}
