//! A fitted set of effects, and what is put into its start or taken out of it.

use std::collections::BTreeSet;

use simgap_effects::{Family, Placed};
use simgap_estimate::{Candidate, Fit, Score, Start};

use crate::evidence::is_nominal;

/// Prior of [`Weights::independent`](simgap_estimate::Weights::independent) on nominal parameters.
pub(crate) const NOMINAL_PRIOR: f64 = 0.02;

/// A fitted set of effects.
#[derive(Clone)]
pub(crate) struct Hypothesis {
    pub(crate) fit: Fit,
    pub(crate) evidence: f64,
}

impl Hypothesis {
    pub(crate) fn effects(&self) -> &[Placed] {
        &self.fit.estimate.effects
    }

    /// Whether it names nominal parameters alone, or nothing.
    pub(crate) fn is_of_parameters(&self) -> bool {
        self.effects().iter().all(is_nominal)
    }

    /// The set, whatever the order in which its effects were found.
    pub(crate) fn key(&self) -> Vec<String> {
        let mut key: Vec<String> = self.effects().iter().map(name).collect();
        key.sort();
        key
    }

    /// Whether it is another set with one other effect in the place of its i-th.
    pub(crate) fn replaces(&self, i: usize, of: &Hypothesis) -> bool {
        let (key, mut others) = (self.key(), of.effects().iter().enumerate());
        key.len() == of.effects().len()
            && others.all(|(j, placed)| key.contains(&name(placed)) == (j != i))
    }

    /// Whether a candidate makes no sense beside the effects of the set: it is one of them, or one
    /// contains the other at the same place.
    pub(crate) fn rules_out(&self, candidate: &Candidate) -> bool {
        self.effects().iter().any(|p| {
            let related = candidate.effect.contains().contains(&p.effect.kind())
                || p.effect.contains().contains(&candidate.effect.kind());
            same(p, candidate) || (related && p.at == candidate.at)
        })
    }
}

pub(crate) fn name(placed: &Placed) -> String {
    format!("{} {}", placed.effect.kind(), placed.at)
}

pub(crate) fn same(placed: &Placed, candidate: &Candidate) -> bool {
    placed.effect.kind() == candidate.effect.kind() && placed.at == candidate.at
}

pub(crate) fn sort(hypotheses: &mut [Hypothesis]) {
    hypotheses.sort_by(|a, b| {
        b.evidence
            .total_cmp(&a.evidence)
            .then_with(|| a.key().cmp(&b.key()))
    });
}

/// Keeps the first of each set.
pub(crate) fn unique(hypotheses: &mut Vec<Hypothesis>) {
    let mut seen = BTreeSet::new();
    hypotheses.retain(|hypothesis| seen.insert(hypothesis.key()));
}

/// Sorts, and keeps the first of each set.
pub(crate) fn rank(hypotheses: &mut Vec<Hypothesis>) {
    sort(hypotheses);
    unique(hypotheses);
}

/// A start with one more effect. A nominal parameter that becomes an effect loses its prior.
pub(crate) fn add(start: &Start, effect: Placed) -> Start {
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

/// A start without one of its effects. A nominal parameter gets its prior back, unless nominal
/// parameters are held exactly.
pub(crate) fn remove(start: &Start, index: usize) -> Start {
    let mut next = start.clone();
    let mut removed = next.effects.remove(index);
    if removed.effect.family() == Family::NominalParameter && !next.nominal.is_empty() {
        removed.values = neutral(&removed);
        next.nominal.push(removed);
    }
    next
}

/// A start with another effect in the place of one of its own. A nominal parameter gets its prior back.
pub(crate) fn replace(start: &Start, index: usize, effect: Placed) -> Start {
    let mut next = remove(start, index);
    next.effects.insert(index, effect);
    next
}

fn neutral(placed: &Placed) -> Vec<f64> {
    placed
        .effect
        .parameters()
        .iter()
        .map(|p| p.neutral.unwrap_or(0.0))
        .collect()
}

/// What the prior takes from the evidence of a set: half the squared deviations of the nominal
/// parameters under it, in units of its standard deviation.
pub(crate) fn pull(start: &Start) -> f64 {
    start.nominal.iter().map(pull_of).sum()
}

/// Pull of the prior from which on nominal parameters are bent: four deviations of one of them, say.
const BENT: f64 = 8.0;

/// Nominal parameters to look for effects from: those of a set, or as given where a large gap has bent them. Beside the
/// true law they are near those, and bent ones may lie beyond a ridge.
pub(crate) fn straight(set: &Hypothesis) -> Vec<Placed> {
    let mut nominal = set.fit.estimate.nominal.clone();
    if is_bent(set) {
        for placed in &mut nominal {
            placed.values.fill(1.0);
        }
    }
    nominal
}

/// Whether a set takes the nominal parameters further than anyone is in error about them.
pub(crate) fn is_bent(set: &Hypothesis) -> bool {
    pull(&set.fit.estimate) > BENT
}

/// How much further a set takes the nominal parameters under their prior than another does, by [`pull`].
pub(crate) fn bends(set: &Hypothesis, other: &Hypothesis) -> f64 {
    pull(&set.fit.estimate) - pull(&other.fit.estimate)
}

pub(crate) fn pull_of(placed: &Placed) -> f64 {
    let deviations = placed.values.iter();
    deviations
        .map(|v| 0.5 * ((v - 1.0) / NOMINAL_PRIOR).powi(2))
        .sum()
}

/// Score of a nominal parameter that the fit already adjusts under its prior: freed, it gains what
/// the prior holds back, and about as much again in what it can then explain.
pub(crate) fn prior_score(base: &Hypothesis, candidate: &Candidate) -> Option<Score> {
    let placed = base
        .fit
        .estimate
        .nominal
        .iter()
        .find(|placed| same(placed, candidate))?;
    Some(Score {
        gain: 2.0 * pull_of(placed),
        share: 0.0,
        start: placed.clone(),
        initial: None,
    })
}
