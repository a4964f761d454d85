//! From fitted sets to an answer: what earns its place, what rivals it, what is left.

use rayon::prelude::*;
use simgap_effects::{Equivalent, Placed, SiteScale, likelier_line, same_place};
use simgap_estimate::{EstimateError, Start};

use crate::common_cause::is_common_cause;
use crate::confirm::confirmed;
use crate::difference::{
    contains_named, discount, fall, identified, is_sure, lacking, level, matters, must_lead,
    relevant, relevant_beyond_special_case, replacement,
};
use crate::evidence::{freedom, probabilities};
use crate::hypothesis::{Hypothesis, bends, name, rank, remove};
use crate::jumps::brings_jumps_alone;
use crate::out_of_sight::turns_into;
use crate::search::Search;

/// Evidence an effect must bring beyond its own penalty. Calibrated on generated cases so that
/// noise alone earns an effect in fewer than one case in twenty.
pub(crate) const EARNS: f64 = 6.0;
/// The same of a law beyond a special case of it: that there is something, both say.
const EARNS_SHAPE: f64 = 3.0;
/// A rival whose evidence is this close cannot be told from the named effect.
pub(crate) const INDISTINGUISHABLE: f64 = 4.0;
/// A rival must lead by this much to take a place: less is the accuracy of the fits.
const TIE: f64 = 0.5;
/// A rival with fewer parameters may be less likely by this much and still take the place.
const SIMPLER: f64 = 2.0;
/// Not where it takes the other nominal parameters further by this, in log-likelihood: they would have to be named.
const BENDS: f64 = 4.0;
/// Rivals fitted for each named effect.
const RIVALS: usize = 8;
/// Evidence that a nominal parameter must bring beyond what it brings under its prior: the square of
/// its deviation in units of the prior, halved, less the penalty for a free parameter.
const EARNS_AS_PARAMETER: f64 = 1.0;

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
            let does = |larger| {
                size(set) < size(larger)
                    && (does_as_well(search, larger, set) || is_common_cause(search, set, larger))
            };
            does(best) && does(simplest) && search.shows(set)
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
    let holds = if smaller.is_of_parameters() && is_under_prior(larger, smaller) {
        larger.evidence - smaller.evidence <= EARNS_AS_PARAMETER
    } else {
        bends(smaller, larger) < EARNS
    };
    holds && !relevant(search, &larger.fit, &smaller.fit)
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
    let shrunk = set.effects().len() == subset.effects().len();
    let least = if shrunk { EARNS_SHAPE } else { EARNS };
    if brings < least || !identified(set, subset) {
        return Ok(false);
    }
    if bends(subset, set) > EARNS {
        // Nominal parameters can take its part, but only far from where they are known to be.
        return Ok(true);
    }
    let is_relevant = if shrunk {
        relevant_beyond_special_case(search, &set.fit, &subset.fit)
    } else {
        relevant(search, &set.fit, &subset.fit)
    };
    let alone = set.effects().len() < 2;
    let is_told = is_relevant
        && (shrunk || matters(search, set, subset))
        && (alone && !shrunk || !brings_jumps_alone(search, set, subset, least))
        && (alone || confirmed(search, set, subset)?);
    Ok(is_told || is_sure(search, set, subset)?)
}

/// Whether the effect that a subset lacks is a nominal parameter that it still adjusts.
fn is_under_prior(set: &Hypothesis, subset: &Hypothesis) -> bool {
    let adjusted = &subset.fit.estimate.nominal;
    lacking(subset, set).all(|(placed, _)| adjusted.iter().any(|known| name(known) == name(placed)))
}

/// What is left of a set when it is pruned and judged, if it still is an answer.
pub(crate) fn earned(
    search: &Search<'_>,
    set: Hypothesis,
    most_swaps: usize,
    is_answer: impl Fn(&Hypothesis) -> bool,
) -> Result<Option<(Hypothesis, Vec<Judged>)>, EstimateError> {
    let set = prune(search, set)?;
    if !is_answer(&set) {
        return Ok(None);
    }
    let judged = judge(search, set, most_swaps)?;
    Ok(Some(judged).filter(|(set, _)| is_answer(set)))
}

/// What came of rivals that were put in the place of an effect.
#[derive(Default)]
struct Former {
    /// Sets that a rival took the place of: they stay rivals.
    displaced: Vec<Hypothesis>,
    /// Sets with a rival that fits better and earns no place, by their [`Hypothesis::key`]: they are none.
    refused: Vec<Vec<String>>,
}

/// Finds the rivals of each effect of a set and weighs them. Where a rival turns out better than
/// the set, it takes its place.
pub(crate) fn judge(
    search: &Search<'_>,
    set: Hypothesis,
    most_swaps: usize,
) -> Result<(Hypothesis, Vec<Judged>), EstimateError> {
    let mut set = set;
    let mut former = Former::default();
    for _ in 0..most_swaps {
        let (judged, better) = judge_once(search, &set, &former)?;
        let Some(better) = better else {
            return Ok((set, judged));
        };
        let rival = better.key();
        let better = prune(search, better)?;
        if better.key() != rival && better.evidence < set.evidence {
            former.refused.push(rival);
        } else {
            former.displaced.push(std::mem::replace(&mut set, better));
        }
    }
    let (judged, _) = judge_once(search, &set, &former)?;
    Ok((set, judged))
}

/// Rivals of every effect, and the best of them where it beats the set.
fn judge_once(
    search: &Search<'_>,
    set: &Hypothesis,
    former: &Former,
) -> Result<(Vec<Judged>, Option<Hypothesis>), EstimateError> {
    let judged = (0..set.effects().len())
        .into_par_iter()
        .map(|i| judge_effect(search, set, i, former))
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
    former: &Former,
) -> Result<(Judged, Option<Hypothesis>), EstimateError> {
    let own = &set.effects()[i];
    let subset = without(search, set, i)?;
    let mut rivals = search.extend(&subset, RIVALS)?;
    rivals.extend(search.grow(set, i)?);
    for rival in &mut rivals {
        let contains = contains_named(set, rival);
        if contains {
            discount(search, set, rival);
        }
        level(search, set, rival);
        let leads = contains && rival.evidence > set.evidence;
        if leads && prune(search, rival.clone())?.key() == set.key() {
            // It would shrink to what is named.
            rival.evidence = set.evidence;
        }
    }
    // The set was held against these when it took their place.
    let known = former.displaced.iter();
    rivals.extend(known.filter(|old| old.replaces(i, set)).cloned());
    rivals.retain(|rival| {
        let is_behind = rival.evidence < set.evidence - INDISTINGUISHABLE;
        let key = rival.key();
        key != set.key() && !former.refused.contains(&key) && (is_behind || search.shows(rival))
    });
    rank(&mut rivals);
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
    // What the set took the place of does not take it back.
    rivals.retain(|rival| former.displaced.iter().all(|old| old.key() != rival.key()));
    // A simpler rival that is about as likely is the better name, and so is the parameter that dynamics turn into
    // whose mode no record shows; one as rich must lead.
    let handicap = |rival: &Hypothesis| {
        if let Some(lead) = lead_of_line(search, set, rival, &judged) {
            lead
        } else if let Some(lead) = must_lead(search, set, rival) {
            -lead
        } else if let Some(lead) = must_lead(search, rival, set) {
            lead
        } else if freedom(&rival.fit) < freedom(&set.fit) && bends(rival, set) < BENDS {
            -SIMPLER
        } else {
            TIE
        }
    };
    let mut better = rivals.into_iter();
    let better = better.find(|rival| rival.evidence > set.evidence + handicap(rival));
    Ok((judged, better))
}

/// By how much a rival must lead what is named where a line is the work of either, whatever the data, and its frequency
/// speaks for one of them.
fn lead_of_line(
    search: &Search<'_>,
    set: &Hypothesis,
    rival: &Hypothesis,
    named: &Judged,
) -> Option<f64> {
    let own = named.placed.effect.kind();
    let new = replacement(set, rival)?;
    let is_same =
        |other: &Equivalent| other.kind == new.effect.kind() && same_place(&other.at, &new.at);
    if own == new.effect.kind() || !named.same.iter().any(is_same) {
        return None;
    }
    let likelier = likelier_line(&named.placed, &search.problem.model)?;
    Some(match likelier == own {
        true => INDISTINGUISHABLE,
        false => -INDISTINGUISHABLE,
    })
}
