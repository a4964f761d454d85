//! Effects beside nominal parameters that are far off.
//!
//! On a real machine several nominal values are off at once, and what is missing from the model shows only once they are
//! re-estimated: dry friction that a damper was made to stand for fits with the wrong sign beside that damper. Effects are
//! looked for beside nominal parameters under a wide prior. What is found is then a proposal like any other: parameters that
//! are wrong become effects of the set, the others keep to what the model states. Which of them, the quadratic of the fit tells
//! for any set of them; the likeliest sets are fitted.

use std::collections::BTreeSet;

use simgap_effects::{Family, Placed};
use simgap_estimate::{EstimateError, FitOptions, Start, linearise_at};

use crate::candidate_model::{CandidateModel, add, is_nominal, is_of, name, rank, remove};
use crate::extended::Visited;
use crate::proposals::model_reduction::Reduced;
use crate::search::{MOST_EFFECTS, Search, counts, size};
use crate::stretches::recalibrate;

/// Prior on nominal parameters while they are re-estimated: known to a factor of about two.
pub const RECALIBRATION_STD: f64 = 0.5;
/// Effects that are fitted alone, and beside each of the best sets.
const FITTED: usize = 12;
const BESIDE: usize = 6;
/// Sets that are extended, and sets that are proposed.
const EXTENDED: usize = 1;
const PROPOSED: usize = 6;
/// What an effect takes over of a re-estimated parameter that it resembles: half, and nearly all.
const SHARES: [f64; 2] = [0.5, 0.9];
/// Sets of wrong parameters that are fitted of each, besides that of all.
const LIKELIEST: usize = 2;

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
            gap: self.gap.clone(),
            visited: Visited::default(),
            ..*self
        };
        let linear = linearise_at(self.problem, &recalibrated.fit, &wide.options)?;
        let mut found = wide.extend_at(recalibrated, &linear, FITTED)?;
        if !self.is_spent() {
            found.extend(wide.fit_joint(recalibrated, &linear));
        }
        if !self.is_spent() {
            // By sensitivities of their own: those without friction lead elsewhere.
            let shared = wide.shared(recalibrated);
            let fitted = self.try_each(&shared, |start| wide.fit(start).ok());
            found.extend(fitted.into_iter().flatten());
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

    /// Starts in which what a re-estimated parameter does is shared with an effect that resembles it. Dry friction has the wrong sign in
    /// its score beside a damper that was fitted to what both lose; between the two lies a valley with many steps.
    fn shared(&self, recalibrated: &CandidateModel) -> Vec<Start> {
        let estimate = &recalibrated.fit.estimate;
        let parts = estimate.nominal.iter().enumerate();
        let parts = parts.flat_map(|parameter| SHARES.map(|share| (parameter, share)));
        let shared = parts.flat_map(|((index, parameter), share)| {
            let kind = parameter.effect.kind();
            let part = |share: f64| -> Vec<f64> {
                parameter.values.iter().map(|value| share * value).collect()
            };
            let candidates = self.space.candidates.iter();
            let alike = candidates.filter(move |(candidate, _)| {
                candidate.at == parameter.at && candidate.effect.resembles().contains(&kind)
            });
            alike.flat_map(move |(candidate, scale)| {
                let values = candidate.effect.grown_from(kind, &part(share), scale);
                values.into_iter().map(move |values| {
                    let mut start = estimate.clone();
                    start.nominal[index].values = part(1.0 - share);
                    let placed = Placed::new(candidate.effect, candidate.at.clone(), values);
                    add(&start, placed)
                })
            })
        });
        shared.collect()
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
        let namings = found.iter().flat_map(|set| self.namings(set));
        let fitted = self.try_each(&namings.collect::<Vec<_>>(), |start| self.fit(start).ok());
        let mut fitted: Vec<CandidateModel> = fitted.into_iter().flatten().collect();
        rank(&mut fitted);
        fitted
    }

    /// Starts of the likeliest sets in which some nominal parameters of a fit are wrong, and the others as the model states. They are
    /// looked for from all parameters to none, the one that is missed least at a time, and from none to all. That of most wrong ones is
    /// among them: it begins where the fit ended, and where small moves part the motions no other finds its way.
    fn namings(&self, set: &CandidateModel) -> Vec<Start> {
        let is_known = |placed: &Placed| {
            let mut candidates = self.space.candidates.iter();
            candidates.any(|(known, _)| is_of(placed, known))
        };
        let parameters = set.fit.estimate.placed();
        let parameters = parameters.filter(|p| is_nominal(p) && is_known(p));
        let parameters: Vec<(String, f64)> = parameters
            .map(|placed| (name(placed), self.space.log_prior_of(placed.effect)))
            .collect();
        let weigh = |wrong: BTreeSet<usize>| -> Option<Naming> {
            let names: BTreeSet<&String> = wrong.iter().map(|&i| &parameters[i].0).collect();
            let reduced = self.reduced(&set.fit, |placed| names.contains(&name(placed)))?;
            let log_prior: f64 = wrong.iter().map(|&i| parameters[i].1).sum();
            Some(Naming {
                log_posterior: log_prior + reduced.log_marginal_likelihood,
                wrong,
                reduced,
            })
        };
        let all: BTreeSet<usize> = (0..parameters.len()).collect();
        let mut met: Vec<Naming> = vec![];
        for from in [all, BTreeSet::new()] {
            let mut at = from.clone();
            met.extend(weigh(from.clone()));
            for _ in 0..parameters.len() {
                let next = (0..parameters.len()).filter(|i| at.contains(i) == from.contains(i));
                let next = next.filter_map(|i| weigh(&at ^ &BTreeSet::from([i])));
                let likeliest = next.max_by(|a, b| a.log_posterior.total_cmp(&b.log_posterior));
                let Some(likeliest) = likeliest else {
                    break;
                };
                at.clone_from(&likeliest.wrong);
                met.push(likeliest);
            }
        }
        let [others, _] = counts(set);
        met.retain(|naming| size(others, naming.wrong.len()) <= MOST_EFFECTS);
        met.sort_by(|a, b| {
            let by_posterior = b.log_posterior.total_cmp(&a.log_posterior);
            by_posterior.then_with(|| a.wrong.cmp(&b.wrong))
        });
        met.dedup_by(|a, b| a.wrong == b.wrong);
        let all_named = met.iter().max_by_key(|naming| naming.wrong.len());
        let all_named = all_named.map(|naming| naming.wrong.clone());
        let proposed = met.into_iter().enumerate().filter(|(i, naming)| {
            *i < LIKELIEST || all_named.as_ref().is_some_and(|all| *all == naming.wrong)
        });
        proposed.map(|(_, naming)| naming.reduced.start).collect()
    }

    /// A start without one of the effects of a set; the others move along with a nominal parameter that returns to what the model states.
    pub(crate) fn without(&self, set: &CandidateModel, index: usize) -> Start {
        let removed = &set.effects()[index];
        let is_kept = |placed: &Placed| {
            let mut effects = set.effects().iter();
            name(placed) != name(removed) && effects.any(|known| name(known) == name(placed))
        };
        let moved = is_nominal(removed).then(|| self.reduced(&set.fit, is_kept));
        match moved.flatten() {
            Some(reduced) => reduced.start,
            None => remove(&set.fit.estimate, index, self.nominal),
        }
    }
}

/// Which nominal parameters are wrong, by their places in a list.
struct Naming {
    wrong: BTreeSet<usize>,
    reduced: Reduced,
    log_posterior: f64,
}
