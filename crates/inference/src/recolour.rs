//! Sets fitted again once the colour of what is left is known.
//!
//! Samples count by the colour of what the set leaves that leaves least ([`crate::noise_model`]). Under another colour a set that is as it
//! was has another misfit, which follows from its discrepancies without a fit. Of sets of several effects those are fitted again that
//! are within reach of the likeliest then.

use rayon::prelude::*;
use simgap_estimate::misfit;

use crate::candidate_model::{CandidateModel, least, rank};
use crate::extended::Visited;
use crate::search::Search;

/// Log odds beyond which a set is no match for the likeliest, whatever a fit of it still gains.
const REACH: f64 = 20.0;

impl Search<'_> {
    /// The single effects of a ranked pool, its sets of wrong parameters, and those within reach, fitted again with the colour of what the
    /// set leaves that leaves least. A fit may end elsewhere under another colour, and single effects are the simplest answers. Where
    /// the colour is that of the set of before, it stays as it is, and fits that were finished stay too.
    pub fn recolour(&mut self, pool: &[CandidateModel]) -> Vec<CandidateModel> {
        let Some(least) = least(pool) else {
            return vec![];
        };
        let is_new = self.visited.coloured_by.as_ref() != Some(&least.key());
        if is_new {
            self.noise = self.noise.with_colour_of(&least.fit);
            self.options = self.noise.search_options();
            self.visited = Visited {
                coloured_by: Some(least.key()),
                ..Visited::default()
            };
        }
        let expected = |set: &CandidateModel| {
            let misfit = misfit(self.problem, &set.fit.variance, &self.options);
            set.log_posterior() + set.fit.misfit - misfit
        };
        let expected: Vec<f64> = pool.iter().map(expected).collect();
        let best = expected.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let again = pool.par_iter().zip(expected).filter(|(set, expected)| {
            let is_simple = set.effects().len() == 1 || set.is_of_parameters();
            is_simple || *expected > best - REACH
        });
        let fitted = again.filter_map(|(set, _)| self.fit_again(set, is_new));
        let mut fitted: Vec<CandidateModel> = fitted.collect();
        rank(&mut fitted);
        fitted
    }

    /// A set, fitted again where it has to be, from better initial states where there are any; `None` where the fit fails.
    fn fit_again(&self, set: &CandidateModel, is_new: bool) -> Option<CandidateModel> {
        let again = match is_new || !set.fit.is_finished {
            true => self.fit(&set.fit.estimate).ok()?,
            false => set.clone(),
        };
        Some(self.with_better_states(again))
    }
}
