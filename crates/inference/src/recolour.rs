//! Sets fitted again once the colour of what is left, and the noise in it, are known.
//!
//! Samples count by the colour of what the set leaves that leaves least, and then what is left beyond its noise as a discrepancy
//! ([`crate::noise_model`]). Where samples count otherwise, a set that is as it was has another misfit, which follows from its discrepancies without a fit. Of sets of several effects those are fitted again that
//! are within reach of the likeliest then. All start from the sensitivities of the set that holds no effect; a few steps tell which are
//! worth the whole way.

use rayon::prelude::*;
use simgap_estimate::{FitOptions, Start, linearise_at, misfit};

use crate::candidate_model::{CandidateModel, least, rank};
use crate::extended::Visited;
use crate::proposals::{FINISHED, ROUGH_STEPS};
use crate::search::Search;

/// Log odds beyond which a set is no match for the likeliest, whatever a fit of it still gains.
const REACH: f64 = 20.0;

/// Whether a set is fitted again that is so far behind the likeliest, by a search that has ended or not.
pub(crate) fn is_fitted_again(set: &CandidateModel, behind: f64, is_spent: bool) -> bool {
    let is_simple = set.effects().len() == 1 || set.is_of_parameters();
    let is_base = set.effects().is_empty();
    is_base || (is_simple && !is_spent) || behind < REACH
}

impl Search<'_> {
    /// The single effects of a ranked pool, its sets of wrong parameters, and those within reach, fitted again with the colour of what the
    /// set leaves that leaves least. A fit may end elsewhere under another colour, and single effects are the simplest answers. Where
    /// the colour is that of the set of before, it stays as it is, and fits that were finished stay too. Of a search that has ended only the
    /// sets within reach are fitted again. The likeliest are tried from initial states found anew.
    pub fn recolour(&mut self, pool: &[CandidateModel]) -> Vec<CandidateModel> {
        let Some(least) = least(pool) else {
            return vec![];
        };
        let is_new = self.visited.coloured_by.as_ref() != Some(&least.key());
        if is_new {
            self.take_colour_of(least);
        }
        self.counted_anew(pool, is_new)
    }

    /// The same where noise of the sensors counts in full and what a lumped model misses beyond it does not; the colour stays.
    pub(crate) fn weigh(&mut self, pool: &[CandidateModel]) -> Vec<CandidateModel> {
        let Some(least) = least(pool) else {
            return vec![];
        };
        self.noise = self.noise.with_noise(&self.noise_of(least));
        self.options = self.noise.search_options();
        self.visited = Visited::default();
        self.counted_anew(pool, true)
    }

    /// Sets of a ranked pool by how samples count now; all are fitted again if that `is_new`.
    fn counted_anew(&self, pool: &[CandidateModel], is_new: bool) -> Vec<CandidateModel> {
        let expected = |set: &CandidateModel| {
            let misfit = misfit(self.problem, &set.fit.variance, &self.options);
            set.log_posterior() + set.fit.misfit - misfit
        };
        let expected: Vec<f64> = pool.iter().map(expected).collect();
        let best = expected.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let is_spent = self.is_spent();
        let is_again = |(set, expected): &(&CandidateModel, f64)| {
            is_fitted_again(set, best - expected, is_spent)
        };
        let again = pool.iter().zip(expected).filter(is_again);
        let (again, stay): (Vec<&CandidateModel>, Vec<&CandidateModel>) = again
            .map(|(set, _)| set)
            .partition(|set| is_new || !set.fit.is_finished);
        let starts: Vec<Start> = again.iter().map(|set| set.fit.estimate.clone()).collect();
        let mut sets = self.fit_again(&starts);
        sets.extend(stay.into_iter().cloned());
        rank(&mut sets);
        let best = sets.first().map_or(0.0, CandidateModel::log_posterior);
        let most = if is_spent { 1 } else { FINISHED.iter().sum() };
        let better = sets.into_par_iter().enumerate();
        let better = better.map(|(place, set)| match place < most {
            true => self.with_better_states(set, best - REACH),
            false => set,
        });
        let mut fitted: Vec<CandidateModel> = better.collect();
        rank(&mut fitted);
        fitted
    }

    /// Counts samples by the colour of what a set leaves, from here on.
    pub(crate) fn take_colour_of(&mut self, set: &CandidateModel) {
        self.noise = self.noise.with_colour_of(&set.fit);
        self.options = self.noise.search_options();
        self.visited = Visited {
            coloured_by: Some(set.key()),
            ..Visited::default()
        };
    }

    /// Sets fitted from where they were found; those of which no fit succeeds are left out.
    pub(crate) fn fit_again(&self, starts: &[Start]) -> Vec<CandidateModel> {
        let empty = starts.iter().find(|start| start.effects.is_empty());
        let base = empty.and_then(|empty| self.fit(empty).ok());
        let linear = base
            .as_ref()
            .and_then(|base| linearise_at(self.problem, &base.fit, &self.options).ok());
        let Some(linear) = linear else {
            let each = starts.par_iter();
            return each.filter_map(|start| self.fit(start).ok()).collect();
        };
        let fit = |start: &Start, most_steps: usize| {
            let options = FitOptions {
                most_steps,
                ..self.options.clone()
            };
            let fit = linear.fit(start, &options).ok()?;
            Some(self.candidate_model(fit))
        };
        let rough = starts
            .par_iter()
            .filter_map(|start| fit(start, ROUGH_STEPS));
        let mut rough: Vec<CandidateModel> = rough.collect();
        rank(&mut rough);
        let best = rough.first().map_or(0.0, CandidateModel::log_posterior);
        // Even beyond reach as many as of single effects.
        let most = FINISHED.iter().sum();
        let finish = |(place, set): (usize, CandidateModel)| {
            let is_promising = place < most || set.log_posterior() > best - REACH;
            match is_promising && !set.fit.is_finished {
                true => fit(&set.fit.estimate, self.options.most_steps).unwrap_or(set),
                false => set,
            }
        };
        rough.into_par_iter().enumerate().map(finish).collect()
    }
}
