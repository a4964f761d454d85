//! Which differences between two sets count.
//!
//! A simulation is no better than what is known of its inputs, and a record no better than its noise: sets that
//! differ by less are told by the number of their parameters, or by how far they take the nominal ones.

use simgap_effects::{Action, Placed, is_unseen, same_place};
use simgap_estimate::{EstimateError, Fit, Interval, fit_initial_states};

use crate::evidence::{evidence, is_nominal};
use crate::hypothesis::{Hypothesis, bends, name, pull};
use crate::out_of_sight::turns_into;
use crate::search::Search;
use crate::verdict::{EARNS, INDISTINGUISHABLE};

/// Smallest relative fall of the squared discrepancy that counts as an effect: below it the
/// integration of the nominal model is no better.
const RELEVANT: f64 = 0.02;
/// Smallest motion of an output, relative to its standard deviation, that counts as an effect.
const MOVES: f64 = 3e-3;
/// The same between a law and a special case of it, as a multiple of what a simulation may be off: what else is off
/// in one of them is off in the other.
const MOVES_ALIKE: f64 = 2.0;
/// A nominal parameter and a force in its place are the same as long as they differ by less than this share of
/// the motion.
const SAME_AS_PARAMETER: f64 = 1.5e-3;
/// What lowers the squared discrepancy by less than [`RELEVANT`] is an effect all the same where it is the only one:
/// by this evidence, with this multiple of what a simulation may be off, and if it does this part of the gap itself
/// that re-estimated parameters could have done nearly as well.
const SURE: f64 = 12.0;
/// See [`SURE`].
const SURELY_MOVES: f64 = 4.0;
/// See [`SURE`].
const DOES: f64 = 0.1;
/// An effect without which the squared discrepancy of a channel would be more than twice as large is seen, even
/// where only its size and its state at the start together are.
pub(crate) const SEEN: f64 = 0.5;
/// Multiple of what a set leaves, rms, that the noise of the inputs may be of it where it is the truth.
const DRIVES: f64 = 3.0;
/// Smallest part of the gap of the model as given, rms, that an effect must close in a channel.
const MATTERS: f64 = 0.015;

/// Whether an effect moves an output by more than a simulation may be off, and by more than what the noise of the
/// inputs leaves, which has the colour of the plant and is imitated by what does not exist: `larger` has it,
/// `smaller` lacks it. A fault of the samples imitates none of it, unless it interpolates between them.
pub(crate) fn relevant(search: &Search<'_>, larger: &Fit, smaller: &Fit) -> bool {
    let std = search.problem.output_std().into_iter();
    let of_samples = faults_of_samples(larger) > faults_of_samples(smaller);
    let least = std
        .zip(driven(search, &larger.variance))
        .map(|(std, driven)| {
            let driven = if of_samples { 0.0 } else { driven };
            driven.max(MOVES * std)
        });
    moves(larger, smaller, least)
}

/// rms of what the noise of the inputs does to each channel, where a set leaves so much of it: noise that drives the
/// nominal plant far does less where little is left, as what wanders without a spring is held by one that the model lacks.
fn driven(search: &Search<'_>, left: &[f64]) -> impl Iterator<Item = f64> {
    let channels = search.input_noise.iter().zip(left);
    channels.map(|(driven, left)| driven.rms().min(DRIVES * left.sqrt()))
}

fn faults_of_samples(fit: &Fit) -> usize {
    let actions = fit.estimate.effects.iter().map(Placed::action);
    actions
        .filter(|action| matches!(action, Action::Sampling(map) if !map.interpolates()))
        .count()
}

/// The same where `smaller` has a special case of the law in its place.
pub(crate) fn relevant_beyond_special_case(
    search: &Search<'_>,
    larger: &Fit,
    smaller: &Fit,
) -> bool {
    let least = search.accuracy.iter();
    moves(larger, smaller, least.map(|off| MOVES_ALIKE * off))
}

fn moves(larger: &Fit, smaller: &Fit, least: impl Iterator<Item = f64>) -> bool {
    let mut channels = moved(larger, smaller).zip(least);
    channels.any(|(moved, least)| moved > least) && fall(smaller, larger) > RELEVANT
}

/// rms by which the predictions of each channel differ: `larger` fits better.
fn moved(larger: &Fit, smaller: &Fit) -> impl Iterator<Item = f64> {
    let variances = smaller.variance.iter().zip(&larger.variance);
    variances.map(|(poorer, better)| (poorer - better).max(0.0).sqrt())
}

/// Relative fall of the squared discrepancy from a poorer fit to a better one, on the channel that
/// profits most: an effect may show on one channel alone.
pub(crate) fn fall(poorer: &Fit, better: &Fit) -> f64 {
    let ratios = poorer.variance.iter().zip(&better.variance);
    ratios
        .map(|(p, b)| 1.0 - b / p.max(f64::MIN_POSITIVE))
        .fold(f64::MIN, f64::max)
}

/// Whether a single effect is one although parameters alone, bent within what is known of them, leave little for it:
/// noise, that of the inputs too, and inaccurate simulation leave much less.
pub(crate) fn is_sure(
    search: &Search<'_>,
    single: &Hypothesis,
    parameters: &Hypothesis,
) -> Result<bool, EstimateError> {
    let accuracy = search.accuracy.iter().map(|off| SURELY_MOVES * off);
    let driven = driven(search, &single.fit.variance);
    let least = accuracy.zip(driven).map(|(off, driven)| driven.max(off));
    let mut channels = moved(&single.fit, &parameters.fit).zip(least);
    if !parameters.effects().is_empty()
        || single.evidence - parameters.evidence < SURE
        || !channels.any(|(moved, least)| moved > least)
    {
        return Ok(false);
    }
    // Without it and with nothing else changed.
    let others = &single.fit.estimate.nominal;
    let without = fit_initial_states(search.problem, others, &search.weights)?;
    let mut channels = moved(&single.fit, &without).zip(&search.gap);
    Ok(channels.any(|(does, gap)| does > DOES * gap))
}

/// Whether the effect closes a part of the gap that is worth a name.
pub(crate) fn matters(search: &Search<'_>, set: &Hypothesis, subset: &Hypothesis) -> bool {
    closes_more(search, set, subset, MATTERS)
}

/// Whether a set closes more of the gap of some channel than another, by this part of it.
pub(crate) fn closes_more(
    search: &Search<'_>,
    set: &Hypothesis,
    other: &Hypothesis,
    part: f64,
) -> bool {
    let mut channels = moved(&set.fit, &other.fit).zip(&search.gap);
    channels.any(|(moved, gap)| moved > part * gap)
}

/// Whether the effect that a subset lacks has a size that can be told from none.
pub(crate) fn identified(set: &Hypothesis, subset: &Hypothesis) -> bool {
    if fall(&subset.fit, &set.fit) > SEEN {
        return true;
    }
    lacking(subset, set).all(|(placed, intervals)| is_told_from_none(placed, intervals))
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

/// Whether a rival has a law of which an effect of the set is a special case.
pub(crate) fn contains_named(set: &Hypothesis, rival: &Hypothesis) -> bool {
    replacement(set, rival).is_some_and(|new| {
        let is_special = |old: &Placed| new.effect.contains().contains(&old.effect.kind());
        let mut effects = set.effects().iter();
        effects.any(|old| old.at == new.at && is_special(old))
    })
}

/// A rival that [contains](contains_named) an effect of the set and moves no output by more than the simulation may
/// be off is worth no more than the set, less its penalty for further parameters.
pub(crate) fn discount(search: &Search<'_>, set: &Hypothesis, rival: &mut Hypothesis) {
    if !relevant_beyond_special_case(search, &rival.fit, &set.fit) {
        rival.evidence = rival
            .evidence
            .min(set.evidence - search.penalty(rival, set));
    }
}

/// A rival that fits as well or as badly as the set but for what a simulation may be off is judged by its
/// number of parameters, and by how far it takes the nominal ones. A nominal parameter in the place of a force is
/// so judged as long as they differ by less than what counts as an effect.
pub(crate) fn level(search: &Search<'_>, set: &Hypothesis, rival: &mut Hypothesis) {
    let new = replacement(set, rival);
    let is_parameter = new.is_some_and(is_nominal);
    let in_place_of_a_force = match (replacement(rival, set), new) {
        (Some(old), Some(new)) => !old.action().adds_mass() && same_place(&old.at, &new.at),
        _ => false,
    };
    let least = if is_parameter && in_place_of_a_force {
        SAME_AS_PARAMETER
    } else {
        0.0
    };
    let std = search.problem.output_std();
    // A lag that is not there smooths the noise of the inputs on its way to the outputs.
    let variances = set.fit.variance.iter().zip(&rival.fit.variance);
    let left: Vec<f64> = variances.clone().map(|(own, its)| own.min(*its)).collect();
    let off = search.accuracy.iter().zip(driven(search, &left)).zip(std);
    let off = off.map(|((accuracy, driven), std)| accuracy.max(least * std).hypot(driven));
    let mut channels = variances.zip(off);
    if channels.all(|((own, its), off)| (own - its).abs().sqrt() < off) {
        let misfit = |set: &Hypothesis| set.fit.objective - pull(&set.fit.estimate);
        rival.evidence += misfit(rival) - misfit(set);
        if is_parameter {
            // A set that took a place in this way has kept what it was given: so does a parameter in its place.
            rival.evidence += set.evidence - evidence(&set.fit, search.effective_samples);
        }
    }
}

/// The effect of a rival set that the set lacks.
pub(crate) fn replacement<'a>(set: &Hypothesis, rival: &'a Hypothesis) -> Option<&'a Placed> {
    lacking(set, rival).next().map(|(placed, _)| placed)
}

/// The effects of another set that a set lacks, with their intervals.
pub(crate) fn lacking<'a>(
    set: &Hypothesis,
    other: &'a Hypothesis,
) -> impl Iterator<Item = (&'a Placed, &'a [Interval])> {
    let key = set.key();
    let effects = other.effects().iter().zip(&other.fit.intervals);
    effects
        .filter(move |(placed, _)| !key.contains(&name(placed)))
        .map(|(placed, intervals)| (placed, &intervals[..]))
}

/// By how much a set must lead one that names a parameter in the place of dynamics that turn into it and nothing
/// else; `None` where that is not how they differ. Without end where the dynamics move no output by more than the
/// simulation may be off, and the parameter need not go far for it.
pub(crate) fn must_lead(
    search: &Search<'_>,
    dynamics: &Hypothesis,
    limit: &Hypothesis,
) -> Option<f64> {
    let (hidden, intervals) = lacking(limit, dynamics).next()?;
    turns_into((hidden.effect, &hidden.at), replacement(dynamics, limit)?)?;
    if hidden.effect.turns_into().len() != 1 {
        return None;
    }
    if bends(limit, dynamics) < EARNS && !relevant(search, &dynamics.fit, &limit.fit) {
        return Some(f64::INFINITY);
    }
    let parameters = hidden.effect.parameters().iter().zip(intervals);
    let mut shapes = parameters.filter(|(parameter, _)| parameter.neutral.is_none());
    let hides = shapes.any(|(_, interval)| is_unseen(interval.ci95));
    hides.then_some(INDISTINGUISHABLE)
}
