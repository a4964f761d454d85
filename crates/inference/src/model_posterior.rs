//! The posterior over all sets that were fitted.
//!
//! ```text
//! p(S | y) = p(S) Z(S) / Σ p(S') Z(S')                                     (1)
//! p(answer | y) = Σ p(S | y) over the sets that stand for it               (2)
//! p(effect | y) = Σ p(answer | y) over the answers that hold it or one that cannot be told from it     (3)
//! ```
//!
//! A set is an answer if each of its effects closes a share of the gap that is worth a name (*practical
//! relevance*). One with an effect that closes less stands for what the set without that stands for: no real machine is exactly what
//! a few laws say, and what refines an answer speaks for it, not for another that explains as much by a larger effect. The likeliest
//! stands for one that predicts the same by a wrong nominal parameter, whatever the data. Effects that can be exchanged within the stated odds cannot
//! be told apart; an effect that can be left out within them cannot be told from none, and is not named.

use simgap_effects::{Equivalent, Family, Placed, same_place};
use simgap_estimate::EstimateError;

use crate::asked::Asked;
use crate::candidate_model::{CandidateModel, INDISTINGUISHABLE, is_nominal, name, rank, remove};
use crate::motion;
use crate::other::other_of_one;
use crate::search::Search;
use crate::shapley::shapley_values;

/// Log odds beyond which a set does not count.
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
    /// ln Z + ln p lost without it; infinite where the others alone are no set.
    pub worth: f64,
    /// Share of the gap that it closes, rms, in the channel that profits most.
    pub closes: f64,
    /// Share of the motion that it explains, mean square: its Shapley value among the laws of the set.
    pub explains: f64,
    /// Probability that what it explains beside the others has a cause outside the catalogue.
    pub other: f64,
    /// What cannot be told from it, likeliest first.
    pub rivals: Vec<Rival>,
    /// What is the same thing by another name on this plant, whatever the data.
    pub equivalents: Vec<Equivalent>,
}

/// The posterior.
pub struct ModelPosterior {
    /// The answers, likeliest first.
    pub sets: Vec<CandidateModel>,
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

/// Weighs the sets of a pool, all fitted under one noise model.
///
/// # Errors
/// [`EstimateError`] when the model cannot be propagated.
pub fn model_posterior(
    search: &Search<'_>,
    pool: Vec<CandidateModel>,
) -> Result<ModelPosterior, EstimateError> {
    let asked = search.ask(pool)?;
    let shares = match asked.best() {
        Some(best) => {
            // Simulated in half steps: once for all effects.
            let noise = search.noise_of(best);
            let effects = explained(search, &asked, best)?.into_iter().enumerate();
            let shares = effects.map(|effect| share(search, &asked, (best, &noise), effect));
            shares.collect::<Result<Vec<_>, EstimateError>>()?
        }
        None => vec![],
    };
    let (sets, log_posteriors) = asked.kept();
    let best = log_posteriors.first().copied().unwrap_or_default();
    let odds: Vec<f64> = log_posteriors
        .iter()
        .map(|log_posterior| (log_posterior - best).exp())
        .collect();
    let all: f64 = odds.iter().sum();
    let mut posterior = ModelPosterior {
        probabilities: odds.iter().map(|odds| odds / all).collect(),
        sets,
        effects: vec![],
    };
    posterior.effects = shares
        .into_iter()
        .enumerate()
        .map(|(i, share)| effect(search, &posterior, i, share))
        .collect();
    Ok(posterior)
}

/// Where sets are asked what they stand for.
impl Search<'_> {
    /// What each set stands for, as far down as sets count.
    fn ask(&self, mut pool: Vec<CandidateModel>) -> Result<Asked, EstimateError> {
        // Of each set its best fit.
        rank(&mut pool);
        let mut asked = Asked::default();
        asked.extend(pool);
        while let Some(index) = asked.next(NEGLIGIBLE) {
            let set = asked.sets[index].clone();
            let smaller = self.without_irrelevant(&set, &mut asked)?;
            asked.note(index, smaller.unwrap_or(index));
        }
        if let Some(best) = asked.best_place()
            && let Some(same) = self.by_everyday_name(&asked.sets[best], &asked)
        {
            asked.note(best, same);
        }
        Ok(asked)
    }

    /// Where a set is that predicts the same whatever the data, with a wrong nominal parameter in the place of another effect: one answer,
    /// by the name of what is met more often. Between the two no data decide, only how wide the initial states of either are seen.
    fn by_everyday_name(&self, set: &CandidateModel, asked: &Asked) -> Option<usize> {
        let others = (0..set.effects().len()).filter(|i| !is_nominal(&set.effects()[*i]));
        let mut same = others.flat_map(|i| {
            let model = &self.problem.model;
            let same = self.space.equivalents(set.effects(), i, model).into_iter();
            same.filter_map(move |same| {
                let candidate = self.space.candidate_of(&same)?;
                let is_parameter = candidate.effect.family() == Family::NominalParameter;
                let key = is_parameter.then(|| set.key_with(i, candidate))?;
                asked.places.get(&key).copied()
            })
        });
        let most = set.fit.misfit + INDISTINGUISHABLE;
        same.find(|place| asked.sets[*place].fit.misfit < most)
    }

    /// Where the likeliest set is that lacks an irrelevant effect of a set, or has a special case of it; none where all are relevant.
    fn without_irrelevant(
        &self,
        set: &CandidateModel,
        asked: &mut Asked,
    ) -> Result<Option<usize>, EstimateError> {
        let mut smaller = vec![];
        for i in 0..set.effects().len() {
            let moves = self.moves_enough(set, i)?;
            let from_here = || self.fit(&remove(&set.fit.estimate, i, self.nominal));
            let known = asked.places.get(&set.key_without(i)).copied();
            let place = match known {
                Some(known) => known,
                None => asked.place(from_here()?),
            };
            let mut is_relevant = self.is_relevant(set, &asked.sets[place], moves);
            // A search that ended early may have left it elsewhere.
            if is_relevant && known.is_some() && asked.improve(place, from_here()?) {
                is_relevant = self.is_relevant(set, &asked.sets[place], moves);
            }
            if !is_relevant {
                smaller.push(place);
                continue;
            }
            // A law beyond a special case of it is held to the same, by what they differ by.
            for special in self.shrink(set, i) {
                let beyond = motion::between(&set.fit, &special.fit);
                let is_relevant = self.is_relevant(set, &special, self.is_enough(&beyond));
                let place = asked.place(special);
                if !is_relevant {
                    smaller.push(place);
                }
            }
        }
        // Of effects that can stand for each other the one goes without which the rest is likeliest.
        Ok(asked.likeliest(&smaller))
    }
}

/// What one effect of the best set is to it.
struct Share {
    /// [`EffectPosterior::worth`].
    worth: f64,
    /// [`EffectPosterior::closes`].
    closes: f64,
    /// [`EffectPosterior::explains`].
    explains: f64,
    /// [`EffectPosterior::other`].
    other: f64,
}

fn share(
    search: &Search<'_>,
    asked: &Asked,
    (best, noise): (&CandidateModel, &[f64]),
    (index, explains): (usize, f64),
) -> Result<Share, EstimateError> {
    let without = asked.part(search, best, &all_but(best, index))?;
    Ok(Share {
        worth: best.log_posterior() - without.log_posterior(),
        closes: search.closes(best, &without),
        explains,
        other: other_of_one(search, (best, noise), &without),
    })
}

fn effect(
    search: &Search<'_>,
    posterior: &ModelPosterior,
    index: usize,
    share: Share,
) -> EffectPosterior {
    let best = &posterior.sets[0];
    let own = &best.effects()[index];
    let own_name = name(own);
    let key = best.key();
    let mut rivals: Vec<Rival> = vec![];
    let answers = posterior.sets.iter().zip(&posterior.probabilities);
    for (set, probability) in answers.skip(1) {
        let log_odds = (probability / posterior.probabilities[0]).ln();
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
    EffectPosterior {
        placed: own.clone(),
        probability: posterior.sum(|set| set.effects().iter().any(is_one)),
        worth: share.worth,
        closes: share.closes,
        explains: share.explains,
        other: share.other,
        rivals,
        equivalents: same,
    }
}

/// Share of the motion that a set leaves, mean square.
fn left_of(search: &Search<'_>, set: &CandidateModel) -> f64 {
    let motion = search.problem.output_std();
    let channels = set.fit.variance.iter().zip(&motion);
    channels
        .map(|(left, motion)| left / (motion * motion))
        .sum()
}

/// The places of all effects of a set but one.
fn all_but(set: &CandidateModel, index: usize) -> Vec<usize> {
    (0..set.effects().len()).filter(|i| *i != index).collect()
}

/// What each effect of a set explains, as a share of the motion, mean square: the Shapley value of a law among the laws of
/// the set, its wrong nominal parameters as they are; of such a parameter what the others leave without it.
fn explained(
    search: &Search<'_>,
    asked: &Asked,
    set: &CandidateModel,
) -> Result<Vec<f64>, EstimateError> {
    let (parameters, laws): (Vec<usize>, Vec<usize>) =
        (0..set.effects().len()).partition(|i| is_nominal(&set.effects()[*i]));
    let left = |part: &[usize]| -> Result<f64, EstimateError> {
        Ok(left_of(search, asked.part(search, set, part)?.as_ref()))
    };
    let mut explained = vec![0.0; set.effects().len()];
    let of_laws = shapley_values(laws.len(), |some| {
        let mut part = parameters.clone();
        part.extend(some.iter().map(|k| laws[*k]));
        left(&part).map(|left| -left)
    })?;
    for (law, value) in laws.iter().zip(of_laws) {
        explained[*law] = value;
    }
    for parameter in parameters {
        explained[parameter] = left(&all_but(set, parameter))? - left_of(search, set);
    }
    Ok(explained)
}
