//! Effects beside nominal parameters that are far off.
//!
//! On a real machine several nominal values are off at once, and what is missing from the model shows only once they are
//! re-estimated: dry friction that a damper was made to stand for fits with the wrong sign beside that damper. Effects are
//! looked for beside nominal parameters under a wide prior. What is found is then a proposal like any other: parameters that
//! have left what the model states of them become effects of the set, with the prior of a wrong one. Which of them is found
//! both ways: one after the other is added as long as the set grows likelier by it; all are, and go again one by one.

use rayon::prelude::*;
use simgap_effects::{Family, Placed};
use simgap_estimate::{EstimateError, Fit, FitOptions, Start, linearise_at};

use crate::candidate_model::{CandidateModel, add, is_nominal, name, rank, remove};
use crate::extended::Extended;
use crate::proposals::compensated::compensated;
use crate::search::Search;
use crate::stretches::recalibrate;

/// Prior on nominal parameters while they are re-estimated: known to a factor of about two.
pub const RECALIBRATION_STD: f64 = 0.5;
/// Effects that are fitted alone, and beside each of the best sets.
const FITTED: usize = 12;
const BESIDE: usize = 6;
/// Sets that are extended, and sets that are proposed.
const EXTENDED: usize = 1;
const PROPOSED: usize = 6;
/// Sets whose parameters are removed again one by one.
const PRUNED: usize = 2;
/// Stated standard deviations from which a parameter has left what the model states of it.
const LEFT: f64 = 2.0;
/// Parameters that are named at the most.
const MOST_OFF: usize = 6;

impl Search<'_> {
    /// Every nominal parameter re-estimated under a wide prior; nothing where there is none or the fit fails.
    pub(crate) fn recalibrated(&self, base: &CandidateModel) -> Option<CandidateModel> {
        if base.fit.estimate.nominal.is_empty() {
            return None;
        }
        let fit = recalibrate(self.problem, &base.fit.estimate, &self.wide_options()).ok()?;
        Some(self.candidate_model(fit))
    }

    /// Sets of one effect or more beside re-estimated nominal parameters, each with those that are off as effects of the set.
    pub(crate) fn beside_recalibrated(
        &self,
        recalibrated: &CandidateModel,
    ) -> Result<Vec<CandidateModel>, EstimateError> {
        let wide = Search {
            noise: self.noise.clone(),
            options: self.wide_options(),
            space: self
                .space
                .of_families(|family| family != Family::NominalParameter),
            extended: Extended::default(),
            ..*self
        };
        let linear = linearise_at(self.problem, &recalibrated.fit, &wide.options)?;
        let mut found = wide.extend_at(recalibrated, &linear, FITTED)?;
        if !self.is_spent() {
            found.extend(wide.fit_joint(recalibrated, &linear));
        }
        found.push(recalibrated.clone());
        rank(&mut found);
        let mut larger = vec![];
        for set in found.iter().take(EXTENDED) {
            if !self.is_full(set) && !self.is_spent() {
                larger.extend(wide.extend(set, BESIDE)?);
            }
        }
        found.extend(larger);
        // The parameters alone have been proposed before.
        found.retain(|set| !set.effects().is_empty());
        Ok(self.with_parameters_named(found))
    }

    /// Options of a fit beside nominal parameters under a wide prior.
    pub(crate) fn wide_options(&self) -> FitOptions {
        FitOptions {
            nominal_std: Some(RECALIBRATION_STD),
            ..self.options.clone()
        }
    }

    /// The best of some sets that were fitted beside nominal parameters under a wide prior, with those of the parameters that are
    /// off as effects of the set.
    pub(crate) fn with_parameters_named(
        &self,
        mut found: Vec<CandidateModel>,
    ) -> Vec<CandidateModel> {
        found.retain(|set| set.log_marginal_likelihood.is_finite());
        rank(&mut found);
        found.truncate(PROPOSED);
        let starts: Vec<Start> = found
            .iter()
            .map(|set| self.name_parameters(&set.fit))
            .collect();
        let proposed = starts.par_iter().filter_map(|start| self.fit(start).ok());
        let mut proposed: Vec<CandidateModel> = proposed.collect();
        rank(&mut proposed);
        let both_ways = proposed
            .iter()
            .take(PRUNED)
            .flat_map(|set| self.prune_parameters(set));
        let added = found
            .iter()
            .take(PRUNED)
            .flat_map(|set| self.add_parameters(&set.fit));
        let both_ways: Vec<CandidateModel> = both_ways.chain(added).collect();
        proposed.extend(both_ways);
        proposed
    }

    /// The effects of a fit beside nominal parameters as stated, then with those that are off, the one that helps most
    /// first, as long as the set grows likelier.
    fn add_parameters(&self, wide: &Fit) -> Vec<CandidateModel> {
        let mut off = self.off(&wide.estimate);
        let Ok(first) = self.fit(&compensated(wide, is_nominal)) else {
            return vec![];
        };
        let mut grown = vec![first];
        while let Some(last) = grown.last() {
            let larger = off.par_iter().filter_map(|placed| {
                let is_named = |other: &Placed| {
                    let mut named = last.effects().iter().chain([placed]);
                    named.any(|known| name(known) == name(other))
                };
                self.fit(&named(wide, is_named)).ok()
            });
            let best = likeliest(larger.collect());
            let Some(best) = best.filter(|best| best.log_posterior() > last.log_posterior()) else {
                break;
            };
            off.retain(|placed| {
                best.effects()
                    .iter()
                    .all(|known| name(known) != name(placed))
            });
            grown.push(best);
        }
        grown
    }

    /// Nominal parameters that have left what the model states of them, the farthest first.
    fn off(&self, start: &Start) -> Vec<Placed> {
        let apart = |placed: &Placed| {
            let std = self.problem.stated_std(placed);
            let values = placed.values.iter();
            values
                .map(|value| (value - 1.0).abs() / std)
                .fold(0.0, f64::max)
        };
        let mut off: Vec<Placed> = start.nominal.clone();
        off.retain(|placed| apart(placed) > LEFT);
        off.sort_by(|a, b| apart(b).total_cmp(&apart(a)));
        off.truncate(MOST_OFF);
        off
    }

    /// A start in which every nominal parameter that has left what the model states of it is an effect.
    fn name_parameters(&self, wide: &Fit) -> Start {
        let off = self.off(&wide.estimate);
        named(wide, |placed| {
            off.iter().any(|known| name(known) == name(placed))
        })
    }

    /// A start without one of the effects of a set; nominal parameters move along with one that returns to its nominal value.
    pub(crate) fn without(&self, set: &CandidateModel, index: usize) -> Start {
        let removed = &set.effects()[index];
        let start = match is_nominal(removed) {
            true => compensated(&set.fit, |placed| name(placed) == name(removed)),
            false => set.fit.estimate.clone(),
        };
        remove(&start, index, self.nominal)
    }

    /// A set with one parameter less, and again, as long as it is likelier so.
    pub(crate) fn prune_parameters(&self, set: &CandidateModel) -> Vec<CandidateModel> {
        let mut pruned: Vec<CandidateModel> = vec![];
        loop {
            let last = pruned.last().unwrap_or(set);
            let parameters = (0..last.effects().len()).filter(|&i| is_nominal(&last.effects()[i]));
            let parameters: Vec<usize> = parameters.collect();
            let smaller = parameters
                .par_iter()
                .filter_map(|&i| self.fit(&self.without(last, i)).ok());
            let best = likeliest(smaller.collect());
            match best.filter(|best| best.log_posterior() > last.log_posterior()) {
                Some(best) => pruned.push(best),
                None => return pruned,
            }
        }
    }
}

/// A start in which some nominal parameters are effects, and the others as the model states them.
fn named(wide: &Fit, is_named: impl Fn(&Placed) -> bool) -> Start {
    let start = compensated(wide, |placed| !is_named(placed));
    let off: Vec<Placed> = start.nominal.clone();
    let off = off.into_iter().filter(|placed| is_named(placed));
    off.fold(start, |named, placed| add(&named, placed))
}

fn likeliest(sets: Vec<CandidateModel>) -> Option<CandidateModel> {
    let by_posterior =
        |a: &CandidateModel, b: &CandidateModel| a.log_posterior().total_cmp(&b.log_posterior());
    sets.into_iter().max_by(by_posterior)
}
