//! Laws of the machine fitted to stretches of the records, each of which begins anew ([`crate::stretches`]).
//!
//! Nominal parameters are re-estimated beside the laws, as in [`super::recalibrated`]: over whole records they could not be.

use rayon::prelude::*;
use simgap_effects::Family;
use simgap_estimate::{Candidate, EstimateError, Fit, Problem, Start, linearise_at};

use crate::candidate_model::{CandidateModel, rank, straight};
use crate::model_space::ModelSpace;
use crate::search::Search;
use crate::stretches::{Cut, fit_long};

/// Single laws fitted to stretches, by score, and sets that are fitted to whole records then.
const FITTED: usize = 12;
const FINISHED: usize = 6;

impl Search<'_> {
    /// Laws of the machine fitted to stretches of the records, to longer ones, and then to whole records. Best first.
    pub(crate) fn multiple_shooting(
        &self,
        base: &CandidateModel,
    ) -> Result<Vec<CandidateModel>, EstimateError> {
        let mut cut = Cut::of(self.problem);
        let is_law = |candidate: &Candidate| candidate.effect.family().is_law();
        if cut.is_whole() || !self.space.candidates.iter().any(|(known, _)| is_law(known)) {
            return Ok(vec![]);
        }
        let wide = self.wide_options();
        let mut begun = cut.begin(self.problem, &straight(base), &self.options)?;
        let mut found: Vec<Start> = vec![];
        while !cut.is_whole() {
            let problem = cut.apply(self.problem);
            let search = Search {
                problem: &problem,
                options: wide.clone(),
                space: self.laws_in(&problem, &begun)?,
                nominal: self.nominal,
                budget: self.budget,
            };
            let parameters = search.fit(&begun.estimate)?;
            begun = parameters.fit.clone();
            let mut sets = search.fit_laws(&parameters)?;
            sets.extend(
                found
                    .par_iter()
                    .filter_map(|start| search.fit(start).ok())
                    .collect::<Vec<_>>(),
            );
            rank(&mut sets);
            sets.truncate(FINISHED);
            found = sets
                .iter()
                .map(|set| cut.of_joined(&set.fit.estimate))
                .collect();
            begun.estimate = cut.of_joined(&begun.estimate);
            cut = cut.joined();
        }
        let fits = fit_long(self.problem, &found, &wide).into_iter();
        let mut sets =
            self.with_parameters_named(fits.map(|fit| self.candidate_model(fit)).collect());
        rank(&mut sets);
        Ok(sets)
    }

    /// The best laws beside a set, alone and together.
    fn fit_laws(&self, base: &CandidateModel) -> Result<Vec<CandidateModel>, EstimateError> {
        let linear = linearise_at(self.problem, &base.fit, &self.options)?;
        let mut found = self.extend_at(base, &linear, FITTED)?;
        found.extend(self.fit_joint(base, &linear)?);
        found.extend(self.multistart(base, &linear)?);
        Ok(found)
    }

    /// The laws of the machine, with what is typical of the motion of a fit of other runs of the same records.
    fn laws_in(&self, problem: &Problem, fit: &Fit) -> Result<ModelSpace, EstimateError> {
        let is_beyond =
            |family: Family| !matches!(family, Family::Measurement | Family::NominalParameter);
        let laws = self.space.of_families(is_beyond).candidates;
        ModelSpace::of(problem, fit, laws.into_iter().map(|(law, _)| law))
    }
}
