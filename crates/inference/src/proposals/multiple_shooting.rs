//! Laws of the machine fitted to stretches of the records, each of which begins anew ([`crate::stretches`]).
//!
//! Nominal parameters are re-estimated beside the laws, as in [`super::recalibrated`]: over whole records they could not be.

use simgap_effects::Family;
use simgap_estimate::{Candidate, EstimateError, Fit, Problem, Start, linearise_at};

use crate::candidate_model::{CandidateModel, rank, straight};
use crate::model_space::ModelSpace;
use crate::search::Search;
use crate::stretches::Cut;

/// Single laws fitted to stretches, by score, and sets that are fitted to whole records then.
const FITTED: usize = 12;
const FINISHED: usize = 6;

impl Search<'_> {
    /// Laws of the machine fitted to stretches of the records, to longer ones, and then to whole records. Best first.
    pub(crate) fn multiple_shooting(
        &self,
        base: &CandidateModel,
    ) -> Result<Vec<CandidateModel>, EstimateError> {
        let cut = Cut::of(self.problem);
        let is_law = |candidate: &Candidate| candidate.effect.family().is_law();
        if cut.is_whole() || !self.space.candidates.iter().any(|(known, _)| is_law(known)) {
            return Ok(vec![]);
        }
        let found = self.fit_to_stretches(base, &cut)?;
        let fits = cut.lengthen(self.problem, found, &self.wide_options());
        let sets = fits.into_iter().map(|fit| self.candidate_model(fit));
        let mut sets = self.with_parameters_named(sets.collect());
        rank(&mut sets);
        Ok(sets)
    }

    /// The best laws, alone and together, each stretch with an initial state of its own.
    fn fit_to_stretches(
        &self,
        base: &CandidateModel,
        cut: &Cut,
    ) -> Result<Vec<Start>, EstimateError> {
        let problem = cut.apply(self.problem);
        let begun = cut.begin(self.problem, &straight(base), &self.options)?;
        let search = Search {
            problem: &problem,
            options: self.wide_options(),
            space: self.laws_in(&problem, &begun)?,
            nominal: self.nominal,
            budget: self.budget,
        };
        let begun = search.fit(&begun.estimate)?;
        let linear = linearise_at(&problem, &begun.fit, &search.options)?;
        let mut found = search.extend_at(&begun, &linear, FITTED)?;
        found.extend(search.fit_joint(&begun, &linear)?);
        found.extend(search.multistart(&begun, &linear)?);
        rank(&mut found);
        found.truncate(FINISHED);
        Ok(found.into_iter().map(|set| set.fit.estimate).collect())
    }

    /// The laws of the machine, with what is typical of the motion of a fit of other runs of the same records.
    fn laws_in(&self, problem: &Problem, fit: &Fit) -> Result<ModelSpace, EstimateError> {
        let is_beyond =
            |family: Family| !matches!(family, Family::Measurement | Family::NominalParameter);
        let laws = self.space.of_families(is_beyond).candidates;
        ModelSpace::of(problem, fit, laws.into_iter().map(|(law, _)| law))
    }
}
