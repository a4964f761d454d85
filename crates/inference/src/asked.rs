//! Sets that were asked what they stand for: themselves, or a part of theirs that holds all that is worth a name.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

use simgap_estimate::EstimateError;

use crate::candidate_model::{CandidateModel, by_key, keep, name};
use crate::search::Search;

/// Sets, each with what it stands for, once it was asked.
#[derive(Default)]
pub(crate) struct Asked {
    pub(crate) sets: Vec<CandidateModel>,
    /// Log posterior of each, with that of all that stand for it.
    weights: Vec<f64>,
    /// Where the set is that each stands for.
    stands_for: Vec<Option<usize>>,
    /// Where each set is, by its key.
    pub(crate) places: BTreeMap<Vec<String>, usize>,
}

impl Asked {
    /// Adds the sets that are not among them.
    pub(crate) fn extend(&mut self, sets: Vec<CandidateModel>) {
        for set in sets {
            if let Entry::Vacant(place) = self.places.entry(set.key()) {
                place.insert(self.sets.len());
                self.weights.push(set.log_posterior());
                self.sets.push(set);
                self.stands_for.push(None);
            }
        }
    }

    /// Adds a set that is not among them; where it is.
    pub(crate) fn place(&mut self, set: CandidateModel) -> usize {
        let key = set.key();
        self.extend(vec![set]);
        self.places[&key]
    }

    /// The likeliest of some sets, by their own log posterior; of equals the first.
    pub(crate) fn likeliest(&self, places: &[usize]) -> Option<usize> {
        let log_posterior = |place: &&usize| self.sets[**place].log_posterior();
        let by_posterior = |a: &&usize, b: &&usize| log_posterior(a).total_cmp(&log_posterior(b));
        places.iter().rev().max_by(by_posterior).copied()
    }

    /// Takes a likelier fit of a set that was not asked and that no other stands for; whether it did.
    pub(crate) fn improve(&mut self, index: usize, set: CandidateModel) -> bool {
        let is_alone = self.weights[index] == self.sets[index].log_posterior();
        let is_open = self.stands_for[index].is_none() && is_alone;
        let is_likelier = set.log_posterior() > self.sets[index].log_posterior();
        if is_open && is_likelier {
            self.weights[index] = set.log_posterior();
            self.sets[index] = set;
        }
        is_open && is_likelier
    }

    /// The likeliest of the sets that were not asked, unless its log posterior is further below that of the best answer than this.
    pub(crate) fn next(&self, below: f64) -> Option<usize> {
        let places = || 0..self.sets.len();
        let weight = |i: &usize| self.weights[*i];
        let answers = places().filter(|i| self.stands_for[*i] == Some(*i));
        let best = answers
            .map(|i| weight(&i))
            .fold(f64::NEG_INFINITY, f64::max);
        let open = places().filter(|i| self.stands_for[*i].is_none());
        // Of equals the first.
        let next = open.rev().max_by(|a, b| weight(a).total_cmp(&weight(b)));
        next.filter(|i| weight(i) >= best - below)
    }

    /// Notes that a set stands for another, or for itself.
    pub(crate) fn note(&mut self, index: usize, answer: usize) {
        // What the other stands for, if it was asked before. Of laws that turn into each other it may be the set itself.
        let mut end = answer;
        while let Some(next) = self.stands_for[end].filter(|next| *next != end) {
            end = next;
        }
        self.stands_for[index] = Some(end);
        if end != index {
            self.weights[end] = log_sum(self.weights[end], self.weights[index]);
        }
    }

    /// All that stand for themselves or were not asked, likeliest first, each with its log posterior.
    pub(crate) fn kept(self) -> (Vec<CandidateModel>, Vec<f64>) {
        let order = self.order();
        let weights = order.iter().map(|i| self.weights[*i]).collect();
        let mut sets: Vec<Option<CandidateModel>> = self.sets.into_iter().map(Some).collect();
        let kept = order.iter().filter_map(|i| sets[*i].take());
        (kept.collect(), weights)
    }

    /// The likeliest of those.
    pub(crate) fn best(&self) -> Option<&CandidateModel> {
        self.best_place().map(|i| &self.sets[i])
    }

    /// Where that is.
    pub(crate) fn best_place(&self) -> Option<usize> {
        self.order().first().copied()
    }

    /// Where they are, likeliest first.
    fn order(&self) -> Vec<usize> {
        let places = 0..self.sets.len();
        let stays = |i: &usize| self.stands_for[*i].is_none_or(|answer| answer == *i);
        let mut order: Vec<usize> = places.filter(stays).collect();
        order.sort_by(|a, b| {
            let by_weight = self.weights[*b].total_cmp(&self.weights[*a]);
            by_weight.then_with(|| by_key(&self.sets[*a], &self.sets[*b]))
        });
        order
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

/// ln(eᵃ + eᵇ).
fn log_sum(a: f64, b: f64) -> f64 {
    let (low, high) = (a.min(b), a.max(b));
    if low == f64::NEG_INFINITY {
        return high;
    }
    high + (low - high).exp().ln_1p()
}

#[cfg(test)]
mod tests {
    use faer::Mat;
    use simgap_effects::{Placed, find};
    use simgap_estimate::{Curvature, Fit, Start};
    use simgap_model::Location;

    use super::*;

    /// A set of sensor biases in some channels.
    fn set(log_posterior: f64, channels: &[&str]) -> CandidateModel {
        let bias = |channel: &&str| {
            let at = Location::Channel((*channel).into());
            Placed::new(find("sensor_bias").unwrap(), at, vec![1.0])
        };
        CandidateModel {
            log_marginal_likelihood: log_posterior,
            log_prior: 0.0,
            fit: Fit {
                estimate: Start {
                    effects: channels.iter().map(bias).collect(),
                    nominal: vec![],
                    initial: vec![],
                },
                objective: 0.0,
                misfit: 0.0,
                variance: vec![],
                intervals: vec![],
                nominal_intervals: vec![],
                curvature: Curvature {
                    hessian: Mat::zeros(0, 0),
                    coordinates: vec![],
                },
                discrepancy: vec![],
                iterations: 0,
                is_finished: true,
            },
        }
    }

    /// A small answer with two that refine it in a row, beside one that is likelier than it and less likely than these.
    fn asked() -> Asked {
        let mut asked = Asked::default();
        asked.extend(vec![
            set(-40.0, &["a"]),
            set(0.0, &["b"]),
            set(2.0, &["a", "c"]),
            set(1.0, &["a", "c", "d"]),
        ]);
        asked
    }

    #[test]
    fn what_refines_an_answer_speaks_for_it() {
        let mut asked = asked();
        assert_eq!(asked.next(12.0), Some(2));
        asked.note(2, 0);
        assert_eq!(asked.next(12.0), Some(0), "as likely as what stands for it");
        asked.note(0, 0);
        assert_eq!(asked.next(12.0), Some(3));
        asked.note(3, 2);
        assert_eq!(asked.next(12.0), Some(1));
        let (sets, weights) = asked.kept();
        let keys: Vec<Vec<String>> = sets.iter().map(CandidateModel::key).collect();
        assert_eq!(keys, [["sensor_bias channel a"], ["sensor_bias channel b"]]);
        let all: f64 = weights.iter().map(|weight| weight.exp()).sum();
        let sum: f64 = [-40.0, 0.0, 2.0, 1.0].iter().map(|w: &f64| w.exp()).sum();
        assert!((all - sum).abs() < 1e-12 * sum, "no probability is lost");
        assert!((weights[0] - (2f64.exp() + 1f64.exp()).ln()).abs() < 1e-12);
    }

    #[test]
    fn of_effects_that_can_stand_for_each_other_the_set_without_one_is_the_likeliest() {
        let mut asked = asked();
        // What stands for a set does not make it a better fit.
        asked.note(2, 0);
        assert_eq!(asked.likeliest(&[0, 1]), Some(1));
        assert_eq!(asked.likeliest(&[3, 2, 1]), Some(2));
        assert_eq!(asked.likeliest(&[1, 1, 0]), Some(1));
        assert_eq!(asked.likeliest(&[]), None);
    }

    #[test]
    fn a_likelier_fit_takes_the_place_of_a_set_that_was_not_asked() {
        let mut asked = asked();
        assert!(!asked.improve(0, set(-41.0, &["a"])), "less likely");
        assert!(asked.improve(0, set(-2.0, &["a"])));
        asked.note(2, 0);
        assert!(!asked.improve(0, set(9.0, &["a"])), "another stands for it");
        asked.note(1, 1);
        assert!(!asked.improve(1, set(9.0, &["b"])), "it was asked");
        assert_eq!(asked.sets[0].log_posterior(), -2.0);
    }

    #[test]
    fn the_order_in_which_sets_are_asked_does_not_matter() {
        let mut one = asked();
        one.note(3, 2);
        one.note(2, 0);
        let mut other = asked();
        other.note(2, 0);
        other.note(3, 2);
        let [one, other] = [one, other].map(|asked| asked.kept().1);
        assert!(one.iter().zip(&other).all(|(a, b)| (a - b).abs() < 1e-12));
    }

    #[test]
    fn what_is_far_below_the_best_answer_is_not_asked() {
        let mut asked = asked();
        asked.note(2, 2);
        asked.note(3, 3);
        asked.note(1, 1);
        assert_eq!(asked.next(12.0), None);
        assert_eq!(asked.next(50.0), Some(0));
    }

    #[test]
    fn sums_of_logarithms() {
        let nothing = f64::NEG_INFINITY;
        assert_eq!(log_sum(nothing, nothing), nothing);
        assert_eq!(log_sum(nothing, 3.0), 3.0);
        assert!((log_sum(1000.0, 1000.0) - (1000.0 + 2f64.ln())).abs() < 1e-12);
    }
}
