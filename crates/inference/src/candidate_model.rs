//! A fitted set of effects, and how sets are changed.

use std::cmp::Ordering;
use std::collections::BTreeSet;

use simgap_effects::{Effect, Family, Placed};
use simgap_estimate::{Candidate, Fit, Owner, Score, Start};
use simgap_model::Location;

/// A fitted set of effects.
#[derive(Clone)]
pub struct CandidateModel {
    /// The fit.
    pub fit: Fit,
    /// ln Z of the set: computed once, never changed.
    pub log_marginal_likelihood: f64,
    /// ln p of the set before any data.
    pub log_prior: f64,
}

impl CandidateModel {
    /// The effects of the set.
    #[must_use]
    pub fn effects(&self) -> &[Placed] {
        &self.fit.estimate.effects
    }

    /// ln Z + ln p, by which sets are compared and by nothing else.
    #[must_use]
    pub fn log_posterior(&self) -> f64 {
        self.log_marginal_likelihood + self.log_prior
    }

    /// Whether it holds wrong nominal parameters alone, or nothing.
    #[must_use]
    pub fn is_of_parameters(&self) -> bool {
        self.effects().iter().all(is_nominal)
    }

    /// The set, whatever the order in which its effects were found.
    #[must_use]
    pub fn key(&self) -> Vec<String> {
        let mut key: Vec<String> = self.effects().iter().map(name).collect();
        key.sort();
        key
    }

    /// The key of the set without its i-th effect.
    #[must_use]
    pub fn key_without(&self, index: usize) -> Vec<String> {
        let others = self
            .effects()
            .iter()
            .enumerate()
            .filter(|(i, _)| *i != index);
        let mut key: Vec<String> = others.map(|(_, placed)| name(placed)).collect();
        key.sort();
        key
    }

    /// The key of the set with a candidate in the place of its i-th effect.
    pub(crate) fn key_with(&self, index: usize, candidate: &Candidate) -> Vec<String> {
        let mut key = self.key_without(index);
        key.push(name_of(candidate.effect, &candidate.at));
        key.sort();
        key
    }

    /// Whether a candidate makes no sense beside the effects of the set: it is one of them, or one
    /// contains the other at the same place.
    pub(crate) fn rules_out(&self, candidate: &Candidate) -> bool {
        self.effects().iter().any(|p| {
            let related = candidate.effect.contains().contains(&p.effect.kind())
                || p.effect.contains().contains(&candidate.effect.kind());
            is_of(p, candidate) || (related && p.at == candidate.at)
        })
    }

    /// Half the squared deviations of the nominal parameters under their prior, in units of its standard deviation.
    pub(crate) fn nominal_deviation(&self) -> f64 {
        let coordinates = self.fit.curvature.coordinates.iter();
        let nominal = coordinates.filter(|c| matches!(c.owner, Owner::Nominal(..)));
        nominal
            .map(|c| 0.5 * ((c.value - 1.0) / c.prior_std).powi(2))
            .sum()
    }
}

/// Whether an effect is a wrong value of a nominal parameter.
#[must_use]
pub fn is_nominal(placed: &Placed) -> bool {
    placed.effect.family() == Family::NominalParameter
}

/// Kind and place, for keys and messages.
#[must_use]
pub fn name(placed: &Placed) -> String {
    name_of(placed.effect, &placed.at)
}

fn name_of(effect: &dyn Effect, at: &Location) -> String {
    format!("{} {at}", effect.kind())
}

pub(crate) fn is_of(placed: &Placed, candidate: &Candidate) -> bool {
    placed.effect.kind() == candidate.effect.kind() && placed.at == candidate.at
}

/// In the order of their names.
pub(crate) fn by_key(a: &CandidateModel, b: &CandidateModel) -> Ordering {
    a.key().cmp(&b.key())
}

/// The likelier first.
fn by_rank(a: &CandidateModel, b: &CandidateModel) -> Ordering {
    let by_posterior = b.log_posterior().total_cmp(&a.log_posterior());
    by_posterior.then_with(|| by_key(a, b))
}

/// The set that leaves least, by its likelihood.
pub(crate) fn least<'a>(
    sets: impl IntoIterator<Item = &'a CandidateModel>,
) -> Option<&'a CandidateModel> {
    let by_misfit =
        |a: &&CandidateModel, b: &&CandidateModel| a.fit.misfit.total_cmp(&b.fit.misfit);
    sets.into_iter().min_by(by_misfit)
}

/// Sorts, best first, and keeps the best fit of each set.
pub fn rank(sets: &mut Vec<CandidateModel>) {
    sets.sort_by(by_rank);
    let mut seen = BTreeSet::new();
    sets.retain(|set| seen.insert(set.key()));
}

/// A start with one more effect. A nominal parameter that becomes an effect leaves its narrow prior.
#[must_use]
pub fn add(start: &Start, effect: Placed) -> Start {
    let mut next = start.clone();
    next.nominal.retain(|p| name(p) != name(&effect));
    next.effects.push(effect);
    next
}

/// [`add`] of what a score starts from.
pub(crate) fn add_scored(start: &Start, score: Score) -> Start {
    let mut next = add(start, score.start);
    next.initial = score.initial.unwrap_or(next.initial);
    next
}

/// A start without one of its effects. A nominal parameter gets its narrow prior back, unless the others are held exactly.
pub(crate) fn remove(start: &Start, index: usize, nominal: NominalPrior) -> Start {
    let mut next = start.clone();
    let mut removed = next.effects.remove(index);
    if is_nominal(&removed) && nominal == NominalPrior::Wrong {
        let parameters = removed.effect.parameters().iter();
        removed.values = parameters.map(|p| p.neutral.unwrap_or(0.0)).collect();
        next.nominal.push(removed);
    }
    next
}

/// A start without the effects that are not kept, by their places.
pub(crate) fn keep(start: &Start, kept: impl Fn(usize) -> bool, nominal: NominalPrior) -> Start {
    let mut next = start.clone();
    for i in (0..start.effects.len()).rev().filter(|i| !kept(*i)) {
        next = remove(&next, i, nominal);
    }
    next
}

/// A start with another effect in the place of one of its own.
pub(crate) fn replace(start: &Start, index: usize, effect: Placed, nominal: NominalPrior) -> Start {
    let mut next = remove(start, index, nominal);
    next.nominal.retain(|p| name(p) != name(&effect));
    next.effects.insert(index, effect);
    next
}

/// Log odds within which two sets cannot be told apart: one to twenty. Nor can their effects, nor an effect from none.
pub(crate) const INDISTINGUISHABLE: f64 = 3.0;

/// Deviation of the nominal parameters from which on they are bent: four standard deviations of one of them, say.
const BENT: f64 = 8.0;

/// Whether a set takes the nominal parameters further than their prior allows.
pub(crate) fn is_bent(set: &CandidateModel) -> bool {
    set.nominal_deviation() > BENT
}

/// Whether a set takes the nominal parameters so much further than another.
pub(crate) fn is_bent_from(set: &CandidateModel, other: &CandidateModel) -> bool {
    set.nominal_deviation() > other.nominal_deviation() + BENT
}

/// Nominal parameters to look for effects from: those of a set, or as given where a large gap has bent them. Beside the
/// true law they are near those, and bent ones may lie beyond a ridge.
pub(crate) fn straight(set: &CandidateModel) -> Vec<Placed> {
    let mut nominal = set.fit.estimate.nominal.clone();
    if is_bent(set) {
        for placed in &mut nominal {
            placed.values.fill(1.0);
        }
    }
    nominal
}

/// Score of a nominal parameter that the fit already adjusts under its narrow prior: freed, it gains what
/// the prior holds back, and about as much again in what it can then explain.
pub(crate) fn prior_score(base: &CandidateModel, candidate: &Candidate) -> Option<Score> {
    let mut nominal = base.fit.estimate.nominal.iter().enumerate();
    let (index, placed) = nominal.find(|(_, placed)| is_of(placed, candidate))?;
    let coordinates = base.fit.curvature.coordinates.iter();
    let own = coordinates.filter(|c| matches!(c.owner, Owner::Nominal(i, _) if i == index));
    let deviation: f64 = own.map(|c| ((c.value - 1.0) / c.prior_std).powi(2)).sum();
    Some(Score {
        gain: deviation,
        share: 0.0,
        start: placed.clone(),
        initial: None,
    })
}

/// Which prior a nominal parameter has that is an effect of a set.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum NominalPrior {
    /// It is wrong: that of its kind, off by a factor.
    Wrong,
    /// It is as right as the model states, by its standard deviation.
    Stated(f64),
}
