//! The same effects from initial states that are found anew.
//!
//! Where motions that begin nearly alike part (play, sticking, stops), the objective of an initial state has many valleys. A fit
//! of effects, parameters and states together ends in the one that the states were in while the values were still wrong. With the
//! values of a set as they are, the states are found anew, over longer and longer parts of the records
//! ([`simgap_estimate::fit_initial_states`]); where that leaves less, the set is fitted again from there.

use simgap_effects::Placed;
use simgap_estimate::{Start, fit_initial_states, may_part, take_own_values};

use crate::candidate_model::CandidateModel;
use crate::search::Search;

impl Search<'_> {
    /// A set, from initial states found anew where these leave less; as it is where it stays less likely than `least` with them.
    pub(crate) fn with_better_states(&self, set: CandidateModel, least: f64) -> CandidateModel {
        let anew = self
            .states_anew(&set, least)
            .and_then(|start| self.fit(&start).ok());
        let likelier = anew.filter(|anew| anew.log_posterior() > set.log_posterior());
        likelier.unwrap_or(set)
    }

    /// The values of a set with initial states found anew; `None` where they leave no less, or not by enough.
    fn states_anew(&self, set: &CandidateModel, least: f64) -> Option<Start> {
        let mut start = set.fit.estimate.clone();
        let placed: Vec<Placed> = start.placed().cloned().collect();
        if !may_part(&placed) {
            return None;
        }
        let found = fit_initial_states(self.problem, &placed, &self.options).ok()?;
        // Phases and hidden states that records have of their own are found with their initial states.
        let mut given = self.problem.given.clone();
        let of_set = start.effects.iter_mut().chain(&mut start.nominal);
        take_own_values(given.iter_mut().chain(of_set), &found);
        start.initial = found.estimate.initial;
        let gain = set.fit.misfit - found.misfit;
        (gain > self.options.converged && set.log_posterior() + gain > least).then_some(start)
    }
}
