//! Laws of the machine fitted to stretches of the records, each of which begins anew ([`crate::stretches`]).
//!
//! Nominal parameters are re-estimated beside the laws, as in [`super::recalibrated`]: over whole records they could not be.

use simgap_effects::Family;
use simgap_estimate::{Candidate, EstimateError, Fit, FitOptions, Problem, Start, linearise_at};

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
        // Parameters that are re-estimated may hide a law at first: in the shortest stretches it is looked for beside those of the
        // model as well.
        let mut found = self.fit_beside(&begun, &cut, &self.options)?.1;
        while !cut.is_whole() {
            let (parameters, mut sets) = self.fit_beside(&begun, &cut, &wide)?;
            sets.append(&mut found);
            rank(&mut sets);
            sets.truncate(FINISHED);
            begun.estimate = cut.of_joined(&parameters.fit.estimate);
            let starts = sets.iter().map(|set| cut.of_joined(&set.fit.estimate));
            let starts: Vec<Start> = starts.collect();
            cut = cut.joined();
            let carried = fit_long(&cut.apply(self.problem), &starts, &wide).into_iter();
            found = carried.map(|fit| self.candidate_model(fit)).collect();
        }
        let mut sets = self.with_parameters_named(found);
        rank(&mut sets);
        Ok(sets)
    }

    /// Nominal parameters in stretches, and the best laws beside them, alone and together.
    fn fit_beside(
        &self,
        begun: &Fit,
        cut: &Cut,
        options: &FitOptions,
    ) -> Result<(CandidateModel, Vec<CandidateModel>), EstimateError> {
        let problem = &cut.apply(self.problem);
        let search = Search {
            problem,
            options: options.clone(),
            space: self.laws_in(problem, begun)?,
            nominal: self.nominal,
            budget: self.budget,
        };
        let parameters = search.fit(&begun.estimate)?;
        let linear = linearise_at(problem, &parameters.fit, &search.options)?;
        let mut found = search.extend_at(&parameters, &linear, FITTED)?;
        found.extend(search.fit_joint(&parameters, &linear)?);
        found.extend(search.multistart(&parameters, &linear)?);
        Ok((parameters, found))
    }

    /// The laws of the machine, with what is typical of the motion of a fit of other runs of the same records.
    fn laws_in(&self, problem: &Problem, fit: &Fit) -> Result<ModelSpace, EstimateError> {
        let is_beyond =
            |family: Family| !matches!(family, Family::Measurement | Family::NominalParameter);
        let laws = self.space.of_families(is_beyond).candidates;
        ModelSpace::of(problem, fit, laws.into_iter().map(|(law, _)| law))
    }
}
