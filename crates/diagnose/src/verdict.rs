//! From fitted sets to an answer: what earns its place, what rivals it, what is left.

use rayon::prelude::*;
use simgap_effects::{Equivalent, Placed, SiteScale, same_place};
use simgap_estimate::{EstimateError, Fit, Interval, Start};

use crate::confirm::confirmed;
use crate::evidence::{evidence, freedom, is_nominal, probabilities};
use crate::hypothesis::{Hypothesis, name, pull, remove, sort, unique};
use crate::out_of_sight::turns_into;
use crate::search::Search;
use crate::stand_in::is_unseen;

/// Evidence an effect must bring beyond its own penalty. Calibrated on generated cases so that
/// noise alone earns an effect in fewer than one case in twenty.
pub(crate) const EARNS: f64 = 6.0;
/// Smallest relative fall of the squared discrepancy that counts as an effect: below it the
/// integration of the nominal model is no better.
pub(crate) const RELEVANT: f64 = 0.02;
/// Smallest motion of an output, relative to its standard deviation, that counts as an effect.
const MOVES: f64 = 3e-3;
/// The same between a law and a special case of it, as a multiple of what a simulation may be off: what else is off
/// in one of them is off in the other.
const MOVES_ALIKE: f64 = 2.0;
/// A nominal parameter and a force in its place are the same as long as they differ by less than this share of
/// the motion.
const SAME_AS_PARAMETER: f64 = 1.5e-3;
/// A rival whose evidence is this close cannot be told from the named effect.
pub(crate) const INDISTINGUISHABLE: f64 = 4.0;
/// Share of the gap (above the noise floor) that a verdict must close, else the cause is unknown.
pub(crate) const CLOSES: f64 = 0.6;
/// Share of what recalibration leaves that named effects must close, else the cause is unknown: a
/// familiar effect in the place of a foreign one leaves more.
pub(crate) const CLOSES_BEYOND_RECALIBRATION: f64 = 0.85;
/// Several forces may imitate one that is foreign: what a pair may leave of what recalibration leaves,
/// and what three may, when it stands out of the noise by [`IMITATION_STANDS_OUT`].
pub(crate) const IMITATION_LEAVES: [f64; 2] = [0.12, 0.05];
/// See [`IMITATION_LEAVES`]; true effects left up to 1.12 times the noise on tuning cases, sets that
/// imitate a foreign one 1.14 to 3.5.
pub(crate) const IMITATION_STANDS_OUT: f64 = 1.25;
/// A residual below this multiple of the noise floor does not stand out of the noise.
pub(crate) const STANDS_OUT: f64 = 1.6;
/// An effect without which the squared discrepancy of a channel would be more than twice as large is seen, even
/// where only its size and its state at the start together are.
pub(crate) const SEEN: f64 = 0.5;
/// A rival must lead by this much to take a place: less is the accuracy of the fits.
const TIE: f64 = 0.5;
/// A rival with fewer parameters may be less likely by this much and still take the place.
const SIMPLER: f64 = 2.0;
/// Rivals fitted for each named effect.
const RIVALS: usize = 8;
/// Evidence that a nominal parameter must bring beyond what it brings under its prior: the square of
/// its deviation in units of the prior, halved, less the penalty for a free parameter.
const EARNS_AS_PARAMETER: f64 = 1.0;
/// Smallest part of the gap of the model as given, rms, that an effect must close in a channel.
const MATTERS: f64 = 0.015;

/// A rival of one effect of a set.
#[derive(Clone)]
pub(crate) struct Swap {
    /// What would stand in its place.
    pub(crate) placed: Placed,
    /// Evidence of the set with it.
    pub(crate) evidence: f64,
    /// How much worse the set with it fits, its number of parameters aside.
    pub(crate) misfit: f64,
    /// That set.
    pub(crate) estimate: Start,
    /// The nominal parameter that it turns into where its own mode is out of sight: what is named, or fits as
    /// well in the place of what is named.
    pub(crate) turns_into: Option<&'static str>,
}

/// One effect of the answer with its rivals.
pub(crate) struct Judged {
    pub(crate) placed: Placed,
    /// Typical sizes at its place.
    pub(crate) scale: Option<SiteScale>,
    /// What is the same thing by another name on this plant.
    pub(crate) same: Vec<Equivalent>,
    pub(crate) probability: f64,
    /// Evidence lost without it.
    pub(crate) worth: f64,
    /// Probabilities of its rivals, in the order of `swaps`.
    pub(crate) swap_probabilities: Vec<f64>,
    /// Relative fall of the squared discrepancy with it.
    pub(crate) relevance: f64,
    pub(crate) swaps: Vec<Swap>,
}

/// Whether an effect moves an output by more than a simulation may be off: `larger` has it, `smaller` lacks it.
fn relevant(search: &Search<'_>, larger: &Fit, smaller: &Fit) -> bool {
    let least = search.problem.output_std().into_iter();
    moves(larger, smaller, least.map(|std| MOVES * std))
}

/// The same where `smaller` has a special case of the law in its place.
fn relevant_beyond_special_case(search: &Search<'_>, larger: &Fit, smaller: &Fit) -> bool {
    let least = search.accuracy.iter();
    moves(larger, smaller, least.map(|off| MOVES_ALIKE * off))
}

fn moves(larger: &Fit, smaller: &Fit, least: impl Iterator<Item = f64>) -> bool {
    let variances = smaller.variance.iter().zip(&larger.variance);
    let moved = variances.map(|(poorer, better)| (poorer - better).max(0.0).sqrt());
    moved.zip(least).any(|(moved, least)| moved > least) && fall(smaller, larger) > RELEVANT
}

/// The best of the finalists, or a smaller set that predicts as well but for what a simulation may
/// be off: two effects can imitate one.
pub(crate) fn simplest(
    search: &Search<'_>,
    finalists: Vec<Hypothesis>,
    singles: &[Hypothesis],
) -> Option<Hypothesis> {
    let best = finalists.first()?;
    let mut simplest = best;
    loop {
        let size = |set: &Hypothesis| set.effects().len();
        let smaller = finalists.iter().chain(singles).filter(|set| {
            let does = |larger| size(set) < size(larger) && does_as_well(search, larger, set);
            does(best) && does(simplest)
        });
        let next = smaller.max_by(|a, b| {
            let by_size = size(a).cmp(&size(b));
            by_size.then(a.evidence.total_cmp(&b.evidence))
        });
        match next {
            Some(next) => simplest = next,
            None => return Some(simplest.clone()),
        }
    }
}

/// Whether a smaller set predicts as well as a larger one but for what a simulation may be off.
fn does_as_well(search: &Search<'_>, larger: &Hypothesis, smaller: &Hypothesis) -> bool {
    let of_parameters = smaller.effects().iter().all(is_nominal);
    let holds = if of_parameters && is_under_prior(larger, smaller) {
        larger.evidence - smaller.evidence <= EARNS_AS_PARAMETER
    } else {
        pull(&smaller.fit.estimate) - pull(&larger.fit.estimate) < EARNS
    };
    holds && !relevant(search, &larger.fit, &smaller.fit)
}

/// Relative fall of the squared discrepancy from a poorer fit to a better one, on the channel that
/// profits most: an effect may show on one channel alone.
pub(crate) fn fall(poorer: &Fit, better: &Fit) -> f64 {
    let ratios = poorer.variance.iter().zip(&better.variance);
    ratios
        .map(|(p, b)| 1.0 - b / p.max(f64::MIN_POSITIVE))
        .fold(f64::MIN, f64::max)
}

/// The set without its i-th effect, fitted again.
fn without(
    search: &Search<'_>,
    set: &Hypothesis,
    index: usize,
) -> Result<Hypothesis, EstimateError> {
    search.fit(&remove(&set.fit.estimate, index))
}

/// Takes effects off a set, or lets them shrink to special cases, until every one earns its place
/// by evidence, by relevance and on samples that were held back.
pub(crate) fn prune(search: &Search<'_>, set: Hypothesis) -> Result<Hypothesis, EstimateError> {
    let mut set = set;
    loop {
        // A subset that cannot be simulated takes nothing's place.
        let mut smaller = (0..set.effects().len())
            .into_par_iter()
            .filter_map(|i| without(search, &set, i).ok())
            .collect::<Vec<_>>();
        for i in 0..set.effects().len() {
            smaller.extend(search.shrink(&set, i)?);
        }
        let mut weakest: Option<Hypothesis> = None;
        for subset in smaller {
            if !earns(search, &set, &subset)?
                && weakest
                    .as_ref()
                    .is_none_or(|w| subset.evidence > w.evidence)
            {
                weakest = Some(subset);
            }
        }
        match weakest {
            Some(subset) => set = subset,
            None => return Ok(set),
        }
    }
}

/// Whether what a subset lacks earns its place in a set.
fn earns(
    search: &Search<'_>,
    set: &Hypothesis,
    subset: &Hypothesis,
) -> Result<bool, EstimateError> {
    let brings = set.evidence - subset.evidence;
    if is_under_prior(set, subset) {
        // The subset predicts as well: what it lacks is only how far the parameter may go.
        return Ok(brings > EARNS_AS_PARAMETER);
    }
    if brings < EARNS || !identified(set, subset) {
        return Ok(false);
    }
    if pull(&subset.fit.estimate) - pull(&set.fit.estimate) > EARNS {
        // Nominal parameters can take its part, but only far from where they are known to be.
        return Ok(true);
    }
    let shrunk = set.effects().len() == subset.effects().len();
    let is_relevant = if shrunk {
        relevant_beyond_special_case(search, &set.fit, &subset.fit)
    } else {
        relevant(search, &set.fit, &subset.fit)
    };
    Ok(is_relevant
        && (shrunk || matters(search, set, subset))
        && (set.effects().len() < 2 || confirmed(search, set, subset)?))
}

/// Whether the effect that a subset lacks is a nominal parameter that it still adjusts.
fn is_under_prior(set: &Hypothesis, subset: &Hypothesis) -> bool {
    let kept = subset.key();
    let mut lost = set.effects().iter().filter(|p| !kept.contains(&name(p)));
    let adjusted = &subset.fit.estimate.nominal;
    lost.all(|placed| adjusted.iter().any(|known| name(known) == name(placed)))
}

/// Whether the effect closes a part of the gap that is worth a name.
fn matters(search: &Search<'_>, set: &Hypothesis, subset: &Hypothesis) -> bool {
    let variances = subset.fit.variance.iter().zip(&set.fit.variance);
    let mut channels = variances.zip(&search.gap);
    channels.any(|((poorer, better), gap)| (poorer - better).max(0.0).sqrt() > MATTERS * gap)
}

/// Whether the effect that a subset lacks has a size that can be told from none.
pub(crate) fn identified(set: &Hypothesis, subset: &Hypothesis) -> bool {
    if fall(&subset.fit, &set.fit) > SEEN {
        return true;
    }
    let kept = subset.key();
    let effects = set.effects().iter().zip(&set.fit.intervals);
    let mut lost = effects.filter(|(placed, _)| !kept.contains(&name(placed)));
    lost.all(|(placed, intervals)| is_told_from_none(placed, intervals))
}

/// Whether one of the parameters of an effect that have a neutral value is surely away from it.
pub(crate) fn is_told_from_none(placed: &Placed, intervals: &[Interval]) -> bool {
    if placed.action().is_stepped() {
        // No derivative to take an interval from.
        return true;
    }
    let parameters = placed.effect.parameters().iter().zip(intervals);
    let mut sizes = parameters
        .filter(|(parameter, _)| !parameter.per_record)
        .filter_map(|(parameter, interval)| Some((parameter.neutral?, interval.ci95)))
        .filter(|(neutral, _)| neutral.is_finite())
        .peekable();
    sizes.peek().is_none() || sizes.any(|(neutral, [low, high])| neutral < low || neutral > high)
}

/// By how much a set must lead one that names a parameter in the place of dynamics that turn into it and nothing
/// else; `None` where that is not how they differ. Without end where the dynamics move no output by more than the
/// simulation may be off, and the parameter need not go far for it.
fn must_lead(search: &Search<'_>, dynamics: &Hypothesis, limit: &Hypothesis) -> Option<f64> {
    let key = limit.key();
    let mut each = dynamics.effects().iter().zip(&dynamics.fit.intervals);
    let (hidden, intervals) = each.find(|(placed, _)| !key.contains(&name(placed)))?;
    turns_into((hidden.effect, &hidden.at), replacement(dynamics, limit)?)?;
    if hidden.effect.turns_into().len() != 1 {
        return None;
    }
    let further = pull(&limit.fit.estimate) - pull(&dynamics.fit.estimate);
    if further < EARNS && !relevant(search, &dynamics.fit, &limit.fit) {
        return Some(f64::INFINITY);
    }
    let parameters = hidden.effect.parameters().iter().zip(intervals);
    let mut shapes = parameters.filter(|(parameter, _)| parameter.neutral.is_none());
    let hides = shapes.any(|(_, interval)| is_unseen(interval));
    hides.then_some(INDISTINGUISHABLE)
}

/// Finds the rivals of each effect of a set and weighs them. Where a rival turns out better than
/// the set, it takes its place.
pub(crate) fn judge(
    search: &Search<'_>,
    set: Hypothesis,
    most_swaps: usize,
) -> Result<(Hypothesis, Vec<Judged>), EstimateError> {
    let mut set = set;
    for _ in 0..most_swaps {
        let (judged, better) = judge_once(search, &set)?;
        match better {
            Some(better) => set = prune(search, better)?,
            None => return Ok((set, judged)),
        }
    }
    let (judged, _) = judge_once(search, &set)?;
    Ok((set, judged))
}

/// Rivals of every effect, and the best of them where it beats the set.
fn judge_once(
    search: &Search<'_>,
    set: &Hypothesis,
) -> Result<(Vec<Judged>, Option<Hypothesis>), EstimateError> {
    let judged = (0..set.effects().len())
        .into_par_iter()
        .map(|i| judge_effect(search, set, i))
        .collect::<Result<Vec<_>, _>>()?;
    let (list, better): (Vec<Judged>, Vec<Option<Hypothesis>>) = judged.into_iter().unzip();
    let better = better.into_iter().flatten().reduce(|best, other| {
        if other.evidence > best.evidence {
            other
        } else {
            best
        }
    });
    Ok((list, better))
}

/// Rivals of one effect, and the best of them where it beats the set.
fn judge_effect(
    search: &Search<'_>,
    set: &Hypothesis,
    i: usize,
) -> Result<(Judged, Option<Hypothesis>), EstimateError> {
    let own = &set.effects()[i];
    let subset = without(search, set, i)?;
    let mut rivals = search.extend(&subset, RIVALS)?;
    rivals.extend(search.grow(set, i)?);
    for rival in &mut rivals {
        discount(search, set, rival);
        level(search, set, rival);
    }
    rivals.retain(|rival| rival.key() != set.key());
    sort(&mut rivals);
    unique(&mut rivals);
    let mut each = vec![set.evidence, subset.evidence];
    each.extend(rivals.iter().map(|rival| rival.evidence));
    // The set, the set without the effect, then the rivals.
    let shares = probabilities(&each);
    let swaps: Vec<Swap> = rivals
        .iter()
        .map(|rival| {
            // A rival that is the set with another start has nothing to put in its place.
            let placed = replacement(set, rival).unwrap_or(own);
            Swap {
                placed: placed.clone(),
                evidence: rival.evidence,
                misfit: rival.fit.objective - set.fit.objective,
                estimate: rival.fit.estimate.clone(),
                turns_into: turns_into((placed.effect, &placed.at), own),
            }
        })
        .collect();
    let same = search.same(set, i);
    // The same thing by another name is as likely, whether it was fitted or not.
    let is_fitted = |other: &&Equivalent| {
        let mut fitted = swaps.iter().map(|swap| &swap.placed);
        fitted.any(|one| one.effect.kind() == other.kind && same_place(&one.at, &other.at))
    };
    let not_fitted = same.len() - same.iter().filter(is_fitted).count();
    let all = 1.0 + not_fitted as f64 * shares[0];
    let judged = Judged {
        placed: own.clone(),
        scale: search.scale_at(&own.at),
        same,
        probability: shares[0] / all,
        swap_probabilities: shares[2..].iter().map(|share| share / all).collect(),
        worth: set.evidence - subset.evidence,
        relevance: fall(&subset.fit, &set.fit),
        swaps,
    };
    // A simpler rival that is about as likely is the better name, and so is the parameter that dynamics turn into
    // whose mode no record shows; one as rich must lead.
    let handicap = |rival: &Hypothesis| {
        if let Some(lead) = must_lead(search, set, rival) {
            -lead
        } else if let Some(lead) = must_lead(search, rival, set) {
            lead
        } else if freedom(&rival.fit) < freedom(&set.fit) {
            -SIMPLER
        } else {
            TIE
        }
    };
    let mut better = rivals
        .into_iter()
        .filter(|rival| rival.evidence > set.evidence + handicap(rival));
    Ok((judged, better.next()))
}

/// A rival that contains an effect of the set and moves no output by more than the simulation may
/// be off is worth no more than the set, less its penalty for further parameters.
fn discount(search: &Search<'_>, set: &Hypothesis, rival: &mut Hypothesis) {
    let Some(new) = replacement(set, rival) else {
        return;
    };
    let nested = set
        .effects()
        .iter()
        .any(|old| old.at == new.at && new.effect.contains().contains(&old.effect.kind()));
    if nested && !relevant_beyond_special_case(search, &rival.fit, &set.fit) {
        rival.evidence = rival
            .evidence
            .min(set.evidence - search.penalty(rival, set));
    }
}

/// A rival that fits as well or as badly as the set but for what a simulation may be off is judged by its
/// number of parameters, and by how far it takes the nominal ones. A nominal parameter in the place of a force is
/// so judged as long as they differ by less than what counts as an effect.
fn level(search: &Search<'_>, set: &Hypothesis, rival: &mut Hypothesis) {
    let is_parameter = match (replacement(rival, set), replacement(set, rival)) {
        (Some(old), Some(new)) => {
            is_nominal(new) && !old.action().adds_mass() && same_place(&old.at, &new.at)
        }
        _ => false,
    };
    let least = if is_parameter { SAME_AS_PARAMETER } else { 0.0 };
    let std = search.problem.output_std();
    let off = search.accuracy.iter().zip(std);
    let variances = set.fit.variance.iter().zip(&rival.fit.variance);
    let mut channels = variances.zip(off.map(|(accuracy, std)| accuracy.max(least * std)));
    if channels.all(|((own, its), off)| (own - its).abs().sqrt() < off) {
        let misfit = |set: &Hypothesis| set.fit.objective - pull(&set.fit.estimate);
        rival.evidence += misfit(rival) - misfit(set);
        if replacement(set, rival).is_some_and(is_nominal) {
            // A set that took a place in this way has kept what it was given: so does a parameter in its place.
            rival.evidence += set.evidence - evidence(&set.fit, search.effective_samples);
        }
    }
}

/// The effect of a rival set that the set lacks.
pub(crate) fn replacement<'a>(set: &Hypothesis, rival: &'a Hypothesis) -> Option<&'a Placed> {
    let key = set.key();
    rival
        .effects()
        .iter()
        .find(|placed| !key.contains(&name(placed)))
}
