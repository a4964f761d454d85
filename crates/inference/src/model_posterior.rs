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
//! a few laws say, and what refines an answer speaks for it, not for another that explains as much by a larger effect. Effects that can be exchanged within the stated odds cannot
//! be told apart; an effect that can be left out within them cannot be told from none, and is not named.

use simgap_effects::{Equivalent, Placed, same_place};
use simgap_estimate::{EstimateError, FitOptions, fit};

use crate::asked::Asked;
use crate::candidate_model::{
    CandidateModel, INDISTINGUISHABLE, is_bent, is_nominal, name, rank, remove,
};
use crate::gap::RELEVANT_SHARE;
use crate::motion;
use crate::noise_model::{NOISE_KNOWN, stored_rounding_variance};
use crate::search::Search;
use crate::shapley::shapley_values;

/// Practical relevance: an effect that closes less than [`RELEVANT_SHARE`] of the gap, rms, in every channel is not worth a
/// name, nor one that closes no more in any than a tenth of what it is rounded by ([`NOISE_KNOWN`]), for rounding follows the
/// motion, nor one that moves no output by enough ([`motion::is_enough`]), nor one without which no more is left than no set is
/// expected to explain; nor one beside others that explains less than this share of what is left above the noise, mean square.
const OF_REST: f64 = 0.5;
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
        rounded: stored_rounding_variance(search.problem),
    };
    let asked = relevance.ask(search, pool)?;
    let shares = match asked.best() {
        Some(best) => (0..best.effects().len())
            .zip(explained(search, &relevance, &asked, best)?)
            .map(|(i, explains)| share(search, &relevance, &asked, best, (i, explains)))
            .collect::<Result<Vec<_>, EstimateError>>()?,
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

/// What is worth a name.
struct Relevance {
    /// Gap of each channel, rms.
    gap: Vec<f64>,
    /// Motion of each channel, rms.
    motion: Vec<f64>,
    /// What each channel is rounded by, mean square.
    rounded: Vec<f64>,
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
        // Values that no prior holds are no set.
        if without.log_posterior() == f64::NEG_INFINITY {
            return true;
        }
        // Of two sets that cannot be told apart the smaller is the answer.
        if with.log_posterior() - without.log_posterior() < INDISTINGUISHABLE {
            return false;
        }
        // Nominal parameters that are bent to stand for the effect do what it does.
        if is_bent(without) && !is_bent(with) {
            return true;
        }
        // What comes late in one channel may show in another: where records begin follows the late one.
        if !motion::is_enough(moved, &self.motion).any(|enough| enough) {
            return false;
        }
        let noise = search
            .noise_of(with)
            .into_iter()
            .zip(search.unexplainable(without));
        let left = without.fit.variance.iter().zip(noise);
        let channels = closed(with, without).zip(left);
        let mut channels = channels.zip(self.gap.iter().zip(&self.rounded));
        let is_first = without.effects().is_empty();
        channels.any(|((closed, (left, (noise, floor))), (gap, rounded))| {
            let stands_out = *left > NOISE_KNOWN * floor;
            stands_out
                && closed > (NOISE_KNOWN - 1.0) * rounded
                && closed > (RELEVANT_SHARE * gap).powi(2)
                && (is_first || closed > OF_REST * (left - noise))
        })
    }

    /// What each set stands for, as far down as sets count.
    fn ask(
        &self,
        search: &Search<'_>,
        mut pool: Vec<CandidateModel>,
    ) -> Result<Asked, EstimateError> {
        // Of each set its best fit.
        rank(&mut pool);
        let mut asked = Asked::default();
        asked.extend(pool);
        while let Some(index) = asked.next(NEGLIGIBLE) {
            let set = asked.sets[index].clone();
            let smaller = self.without_irrelevant(search, &set, &mut asked)?;
            asked.note(index, smaller.unwrap_or(index));
        }
        Ok(asked)
    }

    /// Share of the motion that a set leaves, mean square.
    fn left(&self, set: &CandidateModel) -> f64 {
        let channels = set.fit.variance.iter().zip(&self.motion);
        channels
            .map(|(left, motion)| left / (motion * motion))
            .sum()
    }

    /// Where the set is that lacks an irrelevant effect of a set, or has a special case of it; none where all are relevant.
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
            // A wrong nominal parameter is told however little it moves: the others bend where it is kept as given.
            let moved = match is_nominal(&set.effects()[i]) {
                true => vec![f64::INFINITY; self.motion.len()],
                false => moved(search, set, i)?,
            };
            let from_here = || search.fit(&remove(&set.fit.estimate, i, search.nominal));
            let known = asked.places.get(&set.key_without(i)).copied();
            let place = match known {
                Some(known) => known,
                None => asked.place(from_here()?),
            };
            let mut is_relevant = self.is_relevant(search, set, &asked.sets[place], &moved);
            // A search that ended early may have left it elsewhere.
            if is_relevant && known.is_some() && asked.improve(place, from_here()?) {
                is_relevant = self.is_relevant(search, set, &asked.sets[place], &moved);
            }
            if !is_relevant {
                return Ok(Some(place));
            }
            // A law beyond a special case of it is held to the same.
            for special in search.shrink(set, i) {
                let is_relevant = self.is_relevant(search, set, &special, &moved);
                let place = asked.place(special);
                if !is_relevant {
                    return Ok(Some(place));
                }
            }
        }
        Ok(None)
    }
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
    Ok(motion::between(&set.fit, &rest))
}

/// Squared discrepancy of each channel that a set explains and another does not.
fn closed<'a>(
    with: &'a CandidateModel,
    without: &'a CandidateModel,
) -> impl Iterator<Item = f64> + 'a {
    let variances = without.fit.variance.iter().zip(&with.fit.variance);
    variances.map(|(poorer, better)| (poorer - better).max(0.0))
}

/// What one effect of the best set is to it.
struct Share {
    /// [`EffectPosterior::worth`].
    worth: f64,
    /// [`EffectPosterior::closes`].
    closes: f64,
    /// [`EffectPosterior::explains`].
    explains: f64,
}

fn share(
    search: &Search<'_>,
    relevance: &Relevance,
    asked: &Asked,
    best: &CandidateModel,
    (index, explains): (usize, f64),
) -> Result<Share, EstimateError> {
    let without = asked.part(search, best, &all_but(best, index))?;
    Ok(Share {
        worth: best.log_posterior() - without.log_posterior(),
        closes: relevance.closes(best, &without),
        explains,
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
        rivals,
        equivalents: same,
    }
}

/// The places of all effects of a set but one.
fn all_but(set: &CandidateModel, index: usize) -> Vec<usize> {
    (0..set.effects().len()).filter(|i| *i != index).collect()
}

/// What each effect of a set explains, as a share of the motion, mean square: the Shapley value of a law among the laws of
/// the set, its wrong nominal parameters as they are; of such a parameter what the others leave without it.
fn explained(
    search: &Search<'_>,
    relevance: &Relevance,
    asked: &Asked,
    set: &CandidateModel,
) -> Result<Vec<f64>, EstimateError> {
    let (parameters, laws): (Vec<usize>, Vec<usize>) =
        (0..set.effects().len()).partition(|i| is_nominal(&set.effects()[*i]));
    let left = |part: &[usize]| -> Result<f64, EstimateError> {
        Ok(relevance.left(asked.part(search, set, part)?.as_ref()))
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
        explained[parameter] = left(&all_but(set, parameter))? - relevance.left(set);
    }
    Ok(explained)
}
