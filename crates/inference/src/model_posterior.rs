//! The posterior over all sets that were fitted.
//!
//! ```text
//! p(S | y) = p(S) Z(S) / Σ p(S') Z(S')                                     (1)
//! p(A | y) = Σ p(S | y) over the sets S of which A is what is worth a name    (2)
//! p(effect | y) = Σ p(A | y) over the answers that hold it or one that cannot be told from it  (3)
//! ```
//!
//! An effect is worth a name if it closes a share of the gap that matters (*practical relevance*). A set with one that is not
//! speaks for the smaller set: what it explains better is no reason to name another cause. Effects that can be exchanged within
//! the stated odds cannot be told apart.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

use simgap_effects::{Equivalent, Placed, same_place};
use simgap_estimate::{EstimateError, FitOptions, fit};

use crate::candidate_model::{CandidateModel, is_bent, name, rank, remove};
use crate::noise_model::NOISE_KNOWN;
use crate::other::RELEVANT_SHARE;
use crate::search::Search;

/// Practical relevance: an effect that closes less than [`RELEVANT_SHARE`] of the gap, rms, in every channel is not worth a
/// name, nor one that moves every output by less than this share of its motion, rms;
const OF_MOTION: f64 = 0.003;
/// nor one without which no more is left than no set is expected to explain, or that explains less than this share of what is
/// left above the noise, mean square.
const OF_REST: f64 = 0.5;
/// Log odds within which effects cannot be told apart: one to twenty.
const INDISTINGUISHABLE: f64 = 3.0;
/// Log odds beyond which an answer does not count.
const NEGLIGIBLE: f64 = 12.0;

/// What could stand in the place of a named effect.
#[derive(Clone)]
pub struct Rival {
    /// The effect.
    pub placed: Placed,
    /// Log odds of its set against the best one.
    pub log_odds: f64,
}

/// One effect of the best set.
#[derive(Clone)]
pub struct EffectPosterior {
    /// The effect.
    pub placed: Placed,
    /// (3), among the answers.
    pub probability: f64,
    /// Log posterior of the answer lost without it.
    pub worth: f64,
    /// Share of the gap that it closes, rms, in the channel that profits most.
    pub closes: f64,
    /// What cannot be told from it, likeliest first.
    pub rivals: Vec<Rival>,
    /// What is the same thing by another name on this plant, whatever the data.
    pub equivalents: Vec<Equivalent>,
}

/// The posterior.
pub struct ModelPosterior {
    /// The sets that are answers, likeliest first.
    pub sets: Vec<CandidateModel>,
    /// Logarithm of (2) of each, but for a constant that all share.
    pub log_posteriors: Vec<f64>,
    /// (2) of each.
    pub probabilities: Vec<f64>,
    /// The effects of the first.
    pub effects: Vec<EffectPosterior>,
}

impl ModelPosterior {
    /// The likeliest set.
    #[must_use]
    pub fn best(&self) -> Option<&CandidateModel> {
        self.sets.first()
    }

    /// Probability that an effect is part of the cause, among the sets.
    #[must_use]
    pub fn probability_of(&self, placed: &Placed) -> f64 {
        let own = name(placed);
        self.sum(|set| set.key().contains(&own))
    }

    fn sum(&self, of: impl Fn(&CandidateModel) -> bool) -> f64 {
        let sets = self.sets.iter().zip(&self.probabilities);
        sets.filter(|(set, _)| of(set)).map(|(_, p)| p).sum()
    }
}

/// Weighs the sets of a pool, all fitted under one noise model. `gap` is the rms of the gap of each channel.
///
/// # Errors
/// [`EstimateError`] when the model cannot be propagated.
pub fn model_posterior(
    search: &Search<'_>,
    pool: Vec<CandidateModel>,
    gap: &[f64],
) -> Result<ModelPosterior, EstimateError> {
    let relevance = Relevance {
        gap: gap.to_vec(),
        motion: search.problem.output_std(),
    };
    let (sets, log_posteriors) = relevance.answers(search, pool)?;
    let best = log_posteriors.first().copied().unwrap_or(0.0);
    let odds = log_posteriors.iter().map(|log| (log - best).exp());
    let odds: Vec<f64> = odds.collect();
    let all: f64 = odds.iter().sum();
    let mut posterior = ModelPosterior {
        probabilities: odds.iter().map(|odds| odds / all).collect(),
        sets,
        log_posteriors,
        effects: vec![],
    };
    let effects = posterior.sets.first().map_or(0, |set| set.effects().len());
    posterior.effects = (0..effects)
        .map(|i| effect(search, &relevance, &posterior, i))
        .collect();
    Ok(posterior)
}

/// What is worth a name.
struct Relevance {
    /// Gap of each channel, rms.
    gap: Vec<f64>,
    /// Motion of each channel, rms.
    motion: Vec<f64>,
}

impl Relevance {
    /// Share of the gap that a set closes and another does not, in the channel that profits most.
    fn closes(&self, with: &CandidateModel, without: &CandidateModel) -> f64 {
        let channels = closed(with, without).zip(&self.gap);
        channels
            .map(|(closed, gap)| closed.sqrt() / gap)
            .fold(0.0, f64::max)
    }

    /// Whether what a set has beyond another is worth a name. `moved` is what the effect moves each output by.
    fn is_relevant(
        &self,
        search: &Search<'_>,
        with: &CandidateModel,
        without: &CandidateModel,
        moved: &[f64],
    ) -> bool {
        // Nominal parameters that are bent to stand for the effect do what it does.
        if is_bent(without) && !is_bent(with) {
            return true;
        }
        let moves = moved.iter().zip(&self.motion);
        let moves = moves.map(|(by, motion)| *by > OF_MOTION * motion);
        let noise = search
            .noise_of(with)
            .into_iter()
            .zip(search.unexplainable(without));
        let left = without.fit.variance.iter().zip(noise);
        let channels = closed(with, without).zip(left);
        let mut channels = channels.zip(self.gap.iter().zip(moves));
        channels.any(|((closed, (left, (noise, floor))), (gap, moves))| {
            let stands_out = *left > NOISE_KNOWN * floor;
            stands_out
                && moves
                && closed > (RELEVANT_SHARE * gap).powi(2)
                && closed > OF_REST * (left - noise)
        })
    }

    /// The sets of which every effect is relevant, each with the logarithm of (2), likeliest first.
    fn answers(
        &self,
        search: &Search<'_>,
        mut pool: Vec<CandidateModel>,
    ) -> Result<(Vec<CandidateModel>, Vec<f64>), EstimateError> {
        // Of each set its best fit.
        rank(&mut pool);
        let mut asked = Asked::default();
        asked.extend(pool);
        let mut best = f64::NEG_INFINITY;
        while let Some(mut index) = asked.next() {
            let log_posterior = asked.sets[index].log_posterior();
            if log_posterior < best - NEGLIGIBLE {
                break;
            }
            // What it speaks for is as likely as it is, at the least, and is asked as well.
            best = best.max(log_posterior);
            while asked.speaks_for[index].is_none() {
                let set = asked.sets[index].clone();
                let other = self.without_irrelevant(search, &set, &mut asked)?;
                asked.speaks_for[index] = Some(other.unwrap_or(index));
                index = other.unwrap_or(index);
            }
        }
        Ok(asked.answers())
    }

    /// The place of the set that is left of one without an effect that is not relevant, or with less of it; `None` where all are.
    fn without_irrelevant(
        &self,
        search: &Search<'_>,
        set: &CandidateModel,
        asked: &mut Asked,
    ) -> Result<Option<usize>, EstimateError> {
        // What is fitted already tells soonest.
        let is_known = |i: &usize| asked.places.contains_key(&set.key_without(*i));
        let (mut order, unknown): (Vec<usize>, Vec<usize>) =
            (0..set.effects().len()).partition(is_known);
        order.extend(unknown);
        for i in order {
            let moved = moved(search, set, i)?;
            let smaller = match asked.places.get(&set.key_without(i)) {
                Some(&known) => asked.sets[known].clone(),
                None => search.fit(&remove(&set.fit.estimate, i, search.nominal))?,
            };
            // A law beyond a special case of it is held to the same.
            let is_relevant = |other: &CandidateModel| self.is_relevant(search, set, other, &moved);
            let enough = match is_relevant(&smaller) {
                true => search
                    .shrink(set, i)
                    .into_iter()
                    .find(|special| !is_relevant(special)),
                false => Some(smaller.clone()),
            };
            asked.extend(vec![smaller]);
            if let Some(enough) = enough {
                let key = enough.key();
                asked.extend(vec![enough]);
                return Ok(asked.places.get(&key).copied());
            }
        }
        Ok(None)
    }
}

/// Sets, and of each, once it was asked, the place of the set that it speaks for: its own where all its effects are relevant.
#[derive(Default)]
struct Asked {
    sets: Vec<CandidateModel>,
    speaks_for: Vec<Option<usize>>,
    /// Where each set is, by its key.
    places: BTreeMap<Vec<String>, usize>,
}

impl Asked {
    /// Adds the sets that are not among them.
    fn extend(&mut self, sets: Vec<CandidateModel>) {
        for set in sets {
            if let Entry::Vacant(place) = self.places.entry(set.key()) {
                place.insert(self.sets.len());
                self.sets.push(set);
                self.speaks_for.push(None);
            }
        }
    }

    /// The likeliest of the sets that were not asked.
    fn next(&self) -> Option<usize> {
        let open = (0..self.sets.len()).filter(|&i| self.speaks_for[i].is_none());
        let posterior = |i: &usize| self.sets[*i].log_posterior();
        // Of equals the first.
        open.rev()
            .max_by(|a, b| posterior(a).total_cmp(&posterior(b)))
    }

    /// The answers with the logarithm of (2), likeliest first. What was not asked counts too little to matter.
    fn answers(self) -> (Vec<CandidateModel>, Vec<f64>) {
        let answer_of = |mut place: usize| {
            while let Some(next) = self.speaks_for[place].filter(|&next| next != place) {
                place = next;
            }
            place
        };
        let mut terms: Vec<Vec<f64>> = vec![vec![]; self.sets.len()];
        for (place, set) in self.sets.iter().enumerate() {
            terms[answer_of(place)].push(set.log_posterior());
        }
        let answers = self.sets.into_iter().zip(&terms);
        let answers = answers.filter(|(_, terms)| !terms.is_empty());
        let mut answers: Vec<(CandidateModel, f64)> =
            answers.map(|(set, terms)| (set, log_sum(terms))).collect();
        answers.sort_by(|(a, p), (b, q)| q.total_cmp(p).then_with(|| a.key().cmp(&b.key())));
        answers.into_iter().unzip()
    }
}

/// ln Σ exp of some logarithms.
fn log_sum(logs: &[f64]) -> f64 {
    let most = logs.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    if most.is_infinite() {
        return most;
    }
    most + logs.iter().map(|log| (log - most).exp()).sum::<f64>().ln()
}

/// What one effect of a set moves each output by, with everything else as it is, rms.
fn moved(
    search: &Search<'_>,
    set: &CandidateModel,
    index: usize,
) -> Result<Vec<f64>, EstimateError> {
    let held = FitOptions {
        most_steps: 0,
        ..search.options.clone()
    };
    let rest = fit(
        search.problem,
        &remove(&set.fit.estimate, index, search.nominal),
        &held,
    )?;
    let runs = || set.fit.discrepancy.iter().zip(&rest.discrepancy);
    let channels = 0..search.problem.model.outputs.len();
    let of_channel = channels.map(|c| {
        let (mut square, mut count) = (0.0, 0.0);
        for (with, without) in runs() {
            let pairs = with[c].iter().zip(&without[c]);
            square += pairs.map(|(a, b)| (a - b).powi(2)).sum::<f64>();
            count += with[c].len() as f64;
        }
        (square / f64::max(count, 1.0)).sqrt()
    });
    Ok(of_channel.collect())
}

/// Squared discrepancy of each channel that a set explains and another does not.
fn closed<'a>(
    with: &'a CandidateModel,
    without: &'a CandidateModel,
) -> impl Iterator<Item = f64> + 'a {
    let variances = without.fit.variance.iter().zip(&with.fit.variance);
    variances.map(|(poorer, better)| (poorer - better).max(0.0))
}

fn effect(
    search: &Search<'_>,
    relevance: &Relevance,
    posterior: &ModelPosterior,
    index: usize,
) -> EffectPosterior {
    let best = &posterior.sets[0];
    let own = &best.effects()[index];
    let own_name = name(own);
    let key = best.key();
    let mut rivals: Vec<Rival> = vec![];
    let answers = posterior.sets.iter().zip(&posterior.log_posteriors);
    let of_best = posterior.log_posteriors[0];
    for (set, log_posterior) in answers.clone().skip(1) {
        let log_odds = log_posterior - of_best;
        if log_odds < -INDISTINGUISHABLE || set.key().contains(&own_name) {
            continue;
        }
        let new = set
            .effects()
            .iter()
            .filter(|placed| !key.contains(&name(placed)));
        for placed in new {
            if rivals
                .iter()
                .all(|known| name(&known.placed) != name(placed))
            {
                rivals.push(Rival {
                    placed: placed.clone(),
                    log_odds,
                });
            }
        }
    }
    let same = search
        .space
        .equivalents(best.effects(), index, &search.problem.model);
    let is_one = |placed: &Placed| {
        name(placed) == own_name
            || rivals
                .iter()
                .any(|rival| name(&rival.placed) == name(placed))
            || same.iter().any(|other| {
                other.kind == placed.effect.kind() && same_place(&other.at, &placed.at)
            })
    };
    let smaller_key = best.key_without(index);
    let smaller = answers.clone().find(|(set, _)| set.key() == smaller_key);
    EffectPosterior {
        placed: own.clone(),
        probability: posterior.sum(|set| set.effects().iter().any(is_one)),
        worth: smaller.map_or(f64::INFINITY, |(_, log)| of_best - log),
        closes: smaller.map_or(1.0, |(set, _)| relevance.closes(best, set)),
        rivals,
        equivalents: same,
    }
}
