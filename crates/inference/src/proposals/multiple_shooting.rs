//! Laws of the machine fitted to stretches of the records, each of which begins anew ([`crate::stretches`]).
//!
//! Nominal parameters are re-estimated beside the laws, as in [`super::recalibrated`]: over whole records they could not be.

use std::collections::BTreeSet;

use simgap_effects::{Family, Placed};
use simgap_estimate::{
    Candidate, EstimateError, Fit, FitOptions, Problem, Start, fit, linearise_at,
};
use simgap_model::Location;

use crate::candidate_model::{CandidateModel, add, rank, straight};
use crate::extended::Visited;
use crate::model_space::ModelSpace;
use crate::search::Search;
use crate::stretches::{Cut, fit_long};

/// Single laws fitted to stretches, by score, and sets that are fitted to whole records then.
const FITTED: usize = 12;
const FINISHED: usize = 6;
/// Share of its usual size that a term of a loss starts from.
const SMALL: f64 = 0.1;

impl Search<'_> {
    /// Laws of the machine fitted to stretches of the records, to longer ones, and then to whole records, as far as any of them could
    /// be likelier than what is known, by its log posterior. Best first.
    pub(crate) fn multiple_shooting(
        &self,
        base: &CandidateModel,
        known: f64,
    ) -> Result<Vec<CandidateModel>, EstimateError> {
        let mut cut = Cut::of(self.problem);
        let is_law = |candidate: &Candidate| candidate.effect.family().is_law();
        if cut.is_whole() || !self.space.candidates.iter().any(|(known, _)| is_law(known)) {
            return Ok(vec![]);
        }
        let wide = self.wide_options();
        let begun = cut.begin(self.problem, &straight(base), &self.options)?;
        let mut begun = begun.estimate;
        let mut found = vec![];
        let mut losses = self.loss_laws(&begun);
        // With a start of its own for each stretch a set leaves no more than over whole records, and its values cost something.
        let may_lead = |set: &CandidateModel| at_estimate(set) > known;
        let fitted = |problem: &Problem, starts: &[Start]| -> Vec<CandidateModel> {
            let fits = fit_long(problem, starts, &wide).into_iter();
            fits.map(|fit| self.candidate_model(fit)).collect()
        };
        // In the shortest stretches all is nearly linear: what the score of first order does not lead to is looked for in longer ones.
        let mut from_afar = cut.joined().is_whole();
        while !cut.is_whole() {
            // What was found in stretches alone says nothing of whole records.
            if self.is_spent() {
                return Ok(vec![]);
            }
            let (parameters, mut sets) = self.fit_beside(&begun, &cut, &wide, from_afar)?;
            from_afar = true;
            let mut of_losses = fitted(&cut.apply(self.problem), &losses);
            of_losses.retain(may_lead);
            let of_joined = |set: &CandidateModel| cut.of_joined(&set.fit.estimate);
            losses = of_losses.iter().map(of_joined).collect();
            sets.append(&mut found);
            sets.retain(may_lead);
            rank_in_stretches(&mut sets);
            sets.truncate(FINISHED);
            if sets.is_empty() && losses.is_empty() && !may_lead(&parameters) {
                return Ok(vec![]);
            }
            begun = of_joined(&parameters);
            let starts: Vec<Start> = sets.iter().map(of_joined).collect();
            cut = cut.joined();
            found = fitted(&cut.apply(self.problem), &starts);
        }
        found.extend(fitted(self.problem, &losses));
        let mut sets = self.with_parameters_named(found);

        rank(&mut sets);
        Ok(sets)
    }

    /// The terms of a loss together, at each place that several of them can be at: dry, viscous and quadratic damping stand for
    /// each other in a stretch of one amplitude, and each alone has the wrong size where the machine has all.
    fn loss_laws(&self, begun: &Start) -> Vec<Start> {
        let terms = self.space.candidates.iter();
        let terms = terms.filter(|(term, _)| term.effect.is_loss_term());
        let mut laws: Vec<(Location, Start)> = vec![];
        for (term, scale) in terms {
            let Some(mut values) = term.effect.starts(scale).into_iter().next() else {
                continue;
            };
            values.iter_mut().for_each(|value| *value *= SMALL);
            let placed = Placed::new(term.effect, term.at.clone(), values);
            match laws.iter_mut().find(|(at, _)| *at == term.at) {
                Some((_, law)) => *law = add(law, placed),
                None => laws.push((term.at.clone(), add(begun, placed))),
            }
        }
        let laws = laws.into_iter().map(|(_, law)| law);
        laws.filter(|law| law.effects.len() > 1).collect()
    }

    /// Nominal parameters in stretches, and the best laws beside them: alone by their scores, from afar together and from many values too.
    fn fit_beside(
        &self,
        begun: &Start,
        cut: &Cut,
        options: &FitOptions,
        from_afar: bool,
    ) -> Result<(CandidateModel, Vec<CandidateModel>), EstimateError> {
        let problem = &cut.apply(self.problem);
        let parameters = fit(problem, begun, options)?;
        let search = Search {
            noise: self.noise.clone(),
            problem,
            options: options.clone(),
            space: self.laws_in(problem, &parameters)?,
            gap: self.gap.clone(),
            nominal: self.nominal,
            budget: self.budget,
            visited: Visited::default(),
        };
        let parameters = search.candidate_model(parameters);
        let linear = linearise_at(problem, &parameters.fit, &search.options)?;
        let mut found = search.extend_at(&parameters, &linear, FITTED)?;
        if from_afar && !self.is_spent() {
            found.extend(search.fit_joint(&parameters, &linear));
            found.extend(search.multistart(&parameters, &linear)?);
        }
        Ok((parameters, found))
    }

    /// The laws of the machine, with what is typical of the motion that a fit predicts.
    fn laws_in(&self, problem: &Problem, fit: &Fit) -> Result<ModelSpace, EstimateError> {
        let is_beyond =
            |family: Family| !matches!(family, Family::Measurement | Family::NominalParameter);
        let laws = self.space.of_families(is_beyond).candidates;
        ModelSpace::of(problem, fit, laws.into_iter().map(|(law, _)| law))
    }
}

/// Log posterior of a set at its estimate: more than that of the set, by what its values cost.
fn at_estimate(set: &CandidateModel) -> f64 {
    set.log_prior - set.fit.objective
}

/// Sorts sets that were fitted to the same stretches by their posterior at the estimate, best first, and keeps the best fit of each.
/// Their marginal likelihoods do not compare them: with a start of its own for each of many stretches, most of its Occam
/// factor is how well the starts are known, which speaks against every set that leaves less.
fn rank_in_stretches(sets: &mut Vec<CandidateModel>) {
    sets.sort_by(|a, b| {
        let by_posterior = at_estimate(b).total_cmp(&at_estimate(a));
        by_posterior.then_with(|| a.key().cmp(&b.key()))
    });
    let mut seen = BTreeSet::new();
    sets.retain(|set| seen.insert(set.key()));
}
