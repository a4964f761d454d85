//! Long records: a search in a part of the samples comes first, and what it finds is fitted to all of them.
//!
//! A simulation costs as many steps as there are samples, and most of what is tried is no match for the likeliest, which fewer samples
//! tell as well. What is found in the part is a proposal: sets are compared by fits to all samples that are searched in.

use simgap_estimate::{EstimateError, FitOptions, Problem, Start, fit_initial_states};

use crate::candidate_model::{CandidateModel, least, rank};
use crate::recolour::is_fitted_again;
use crate::search::Search;
use crate::stage::Stage;

impl Search<'_> {
    /// All sets that are fitted from a start without effects, likeliest first: with the colour of what the set leaves that leaves least, and
    /// with the best of them changed; once more, with noise told from what a model misses, where the best leaves more than noise. Where there is
    /// a part of the records, it is searched in first, unless nothing but noise is left of all of them.
    ///
    /// # Errors
    /// [`EstimateError`] when the model cannot be propagated.
    pub fn find(
        &mut self,
        start: &Start,
        part: Option<&Problem>,
    ) -> Result<Vec<CandidateModel>, EstimateError> {
        let base = self.fit(start)?;
        let pool = match part {
            Some(part) if !self.is_settled(std::slice::from_ref(&base), 0)? => {
                let found = self.find_in(part, start)?;
                self.tell(Stage::AllSamples);
                self.take_over(&base, part, &found)
            }
            _ => self.run(&base)?,
        };
        self.tell(Stage::Colour);
        let mut pool = self.recolour(&pool);
        self.refine(&mut pool)?;
        if pool
            .first()
            .is_some_and(|best| !self.leaves_only_noise(best))
        {
            pool = self.weigh(&pool);
            self.refine(&mut pool)?;
        }
        Ok(pool)
    }

    /// The sets that the same search finds in a part of the records.
    fn find_in(&self, part: &Problem, start: &Start) -> Result<Vec<CandidateModel>, EstimateError> {
        let noise = self.noise.at_rate_of(self.problem, part);
        let mut search = Search {
            nominal: self.nominal,
            ..Search::new(part, &noise, self.space.clone(), &self.gap, self.budget)
        };
        let plain = FitOptions::white(part.model.outputs.len());
        let begun = Start {
            initial: fit_initial_states(part, &[], &plain)?.estimate.initial,
            ..start.clone()
        };
        let base = search.fit(&begun)?;
        search.run(&base)
    }

    /// Sets that were found in a part of the records, fitted here: single effects, wrong parameters, and those within reach of the likeliest,
    /// with the colour of what the set leaves here that left least there. `base` holds no effect.
    fn take_over(
        &mut self,
        base: &CandidateModel,
        part: &Problem,
        found: &[CandidateModel],
    ) -> Vec<CandidateModel> {
        let mut runs = self.problem.runs.iter().zip(&part.runs);
        let begin_alike = runs.all(|(run, part)| run.start_s == part.start_s);
        let start = |set: &CandidateModel| match set.effects().is_empty() {
            true => base.fit.estimate.clone(),
            false if begin_alike => set.fit.estimate.clone(),
            false => Start {
                initial: base.fit.estimate.initial.clone(),
                ..set.fit.estimate.clone()
            },
        };
        let by_least = least(found).and_then(|least| self.fit(&start(least)).ok());
        if let Some(least) = by_least {
            self.take_colour_of(&least);
        }
        let is_spent = self.is_spent();
        let best = found.first().map_or(0.0, CandidateModel::log_posterior);
        // What is so far behind in the part is further behind in all of it.
        let times = duration_s(self.problem) / duration_s(part);
        let taken = found.iter().filter(|set| {
            let behind = times * (best - set.log_posterior());
            is_fitted_again(set, behind, is_spent)
        });
        let starts: Vec<Start> = taken.map(start).collect();
        let mut pool = self.fit_again(&starts);
        rank(&mut pool);
        pool
    }
}

fn duration_s(problem: &Problem) -> f64 {
    let runs = problem.runs.iter();
    runs.map(|run| run.len as f64 * run.time_step_s).sum()
}
