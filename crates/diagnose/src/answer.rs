//! The answer in words and numbers.

use rayon::prelude::*;
use simgap_effects::{Action, Family, Placed, find, same_place};
use simgap_estimate::{EstimateError, Interval, Problem, Weights};
use simgap_model::Location;

use crate::diagnosis::{
    CandidateResult, Gap, LocationShare, NamedEffect, NamedParameter, Rival, Status, Verdict,
};
use crate::evidence::probabilities;
use crate::gap::{closed, predict, total};
use crate::hypothesis::name;
use crate::pipeline::Answer;
use crate::stand_in::{company, doubts};
use crate::structure::describe;
use crate::verdict::{
    CLOSES, CLOSES_BEYOND_RECALIBRATION, IMITATION_LEAVES, IMITATION_STANDS_OUT, INDISTINGUISHABLE,
    Judged, STANDS_OUT, Swap,
};

/// A corrected gap below this share of the motion is good enough for any model.
const TRIFLE: f64 = 0.01;
/// Share of what a set leaves beyond the noise that a law of any shape at the place of a named effect
/// may explain: more, and the law of this place is not the named one.
const ANOTHER_LAW: f64 = 0.3;
/// Share of the gap on the check records that a name which may be a stand-in may leave: with less, it
/// serves as well as the law it stands in for.
const STAND_IN_LEAVES: f64 = 0.03;
/// Values within this share of each other are the same.
const ALIKE: f64 = 0.01;
/// Two laws at one place that are there leave the noise of the check records, but for this factor.
const TWO_STAND_OUT: f64 = 1.03;
/// Effects that close less than [`CLOSES`] of the gap on the check records, and less than this of what
/// parameters alone leave, are of no use.
const OF_SOME_USE: f64 = 0.3;
/// A name that may be a stand-in and leaves more than [`STAND_IN_LEAVES`] must not stand out of the noise by
/// more than this.
const STAND_IN_STANDS_OUT: f64 = 1.2;
/// What leaves less than this multiple of the noise leaves nothing.
pub(crate) const NOTHING_BUT_NOISE: f64 = 1.1;
/// The same where samples are lost or stored in steps: no model says which, and the noise is known less well.
const NOTHING_BUT_EVENTS: f64 = 1.3;
/// How often a name is right that beats its rivals by far, and one that may be a stand-in; on
/// generated cases.
const TRUST: [f64; 2] = [0.97, 0.8];
/// Other kinds that are listed beside a named one.
const MOST_RIVALS: usize = 2;
/// Single effects whose gap on the check records is computed.
const SHOWN: usize = 12;

pub(crate) fn verdict(train: &Problem, answer: &Answer, gap: &Gap) -> Verdict {
    let effects: Vec<NamedEffect> = (0..answer.judged.len()).map(|i| named(answer, i)).collect();
    let mut status = if effects.is_empty() {
        Status::None
    } else if answer
        .judged
        .iter()
        .all(|judged| judged.placed.effect.family() == Family::NominalParameter)
    {
        Status::Parameters
    } else {
        Status::Effect
    };
    let mut description = Vec::new();
    if unexplained(train, answer, gap, status) {
        status = Status::Unknown;
        description = describe_rest(train, answer);
    }
    Verdict {
        status,
        effects,
        description,
    }
}

/// The i-th effect of the answer.
fn named(answer: &Answer, i: usize) -> NamedEffect {
    let judged = &answer.judged[i];
    let effect = judged.placed.effect;
    let intervals = answer.estimate.intervals.get(i).into_iter().flatten();
    let parameters = effect.parameters().iter().zip(intervals);
    let doubts = doubts(answer, i);
    let mut evidence = sentences(judged);
    if !doubts.is_empty() {
        evidence.push(format!(
            "it may only stand in for a law that the catalogue does not have: {}",
            doubts.join("; ")
        ));
    }
    NamedEffect {
        kind: effect.kind().to_string(),
        at: judged.placed.at.clone(),
        probability: judged.probability * trust(!doubts.is_empty()),
        parameters: parameters
            .map(|(parameter, interval)| NamedParameter {
                name: parameter.name.to_string(),
                value: interval.value,
                ci95: interval.ci95,
            })
            .collect(),
        indistinguishable: rivals(answer, judged),
        stand_in: !doubts.is_empty(),
        evidence,
    }
}

/// What a probability among the rivals is worth: something that is not among them may be the cause.
fn trust(in_doubt: bool) -> f64 {
    if in_doubt { TRUST[1] } else { TRUST[0] }
}

/// Whether structure well above the noise is left that the set does not explain.
fn unexplained(train: &Problem, answer: &Answer, gap: &Gap, status: Status) -> bool {
    if imitation(answer, gap)
        || another_law(answer, gap)
        || is_poor_stand_in(answer, gap) && !answer.follows_anew
        || is_of_no_use(answer, gap, status)
        || on_every_channel(train, answer)
    {
        return true;
    }
    // What remains must stand out of the noise, and not be a trifle of the motion itself.
    if gap.corrected < STANDS_OUT * gap.noise_floor || gap.corrected < TRIFLE {
        return false;
    }
    if status == Status::None {
        return true;
    }
    let std = train.output_std();
    let size = |variance: &[f64]| -> f64 {
        let each: Vec<f64> = variance
            .iter()
            .zip(&std)
            .map(|(v, s)| v.sqrt() / s)
            .collect();
        total(&each)
    };
    let floor = gap.noise_floor;
    let learnt = closed(
        size(&answer.nominal.variance),
        size(&answer.estimate.variance),
        floor,
    );
    learnt.max(gap.closed) < CLOSES
        || (status == Status::Parameters && gap.closed < CLOSES_BEYOND_RECALIBRATION)
        || (status == Status::Effect
            && leaves_much(gap)
            && !explains_all_it_saw(answer)
            && !answer.follows_anew)
}

/// Whether what is left of the check records stands out of the noise, and less of what recalibration leaves
/// is closed than named effects must close.
pub(crate) fn leaves_much(gap: &Gap) -> bool {
    gap.corrected >= STANDS_OUT * gap.noise_floor
        && closed(gap.recalibrated, gap.corrected, gap.noise_floor) < CLOSES_BEYOND_RECALIBRATION
}

/// Whether a set with one force at the most, and no dynamics, leaves nothing but noise of the records it was
/// fitted to. Where it fails on the check records then, their motion hangs on differences that no estimate
/// resolves: play, sticking.
fn explains_all_it_saw(answer: &Answer) -> bool {
    let mut named = answer.judged.iter().map(|judged| &judged.placed);
    let has_dynamics = named
        .clone()
        .any(|placed| placed.effect.family() == Family::Dynamics);
    let most = if named.any(|placed| matches!(placed.action(), Action::Sampling(_))) {
        NOTHING_BUT_EVENTS
    } else {
        NOTHING_BUT_NOISE
    };
    !has_dynamics && laws(answer) <= 1 && answer.remainder.over_noise < most
}

/// Named forces and dynamics.
pub(crate) fn laws(answer: &Answer) -> usize {
    let named = answer.judged.iter();
    named
        .filter(|judged| judged.placed.effect.family().is_law())
        .count()
}

/// Whether a force is named: only with one may motions that begin alike part.
pub(crate) fn has_force(answer: &Answer) -> bool {
    let mut named = answer.judged.iter();
    named.any(|judged| judged.placed.effect.family() == Family::Force)
}

/// Whether several forces and dynamics together leave more than true ones would: a law that the
/// catalogue lacks is imitated by two or three that it has.
fn imitation(answer: &Answer, gap: &Gap) -> bool {
    let count = laws(answer);
    let left = 1.0 - closed(gap.recalibrated, gap.corrected, gap.noise_floor);
    let stands_out = gap.corrected > IMITATION_STANDS_OUT * gap.noise_floor;
    let several = count >= 2 && stands_out && left > IMITATION_LEAVES[usize::from(count > 2)];
    several || two_for_one(answer, gap)
}

/// Whether two laws at one place leave more than one law that stands in for a foreign one may.
fn two_for_one(answer: &Answer, gap: &Gap) -> bool {
    let mut each = 0..answer.judged.len();
    each.any(|i| company(answer, i).is_some())
        && gap.closed < 1.0 - STAND_IN_LEAVES
        && gap.corrected > TWO_STAND_OUT * gap.noise_floor
}

/// Whether a law of another shape than the named one acts at its place.
fn another_law(answer: &Answer, gap: &Gap) -> bool {
    let Some(law) = &answer.remainder.law else {
        return false;
    };
    let mut named = answer.judged.iter().map(|judged| &judged.placed);
    let is_here =
        |placed: &Placed| placed.at == law.at && placed.effect.family() == law.effect.family();
    // Parameters alone leave room for a law at any place.
    let mut laws = named
        .clone()
        .filter(|placed| placed.effect.family() != Family::NominalParameter);
    law.share > ANOTHER_LAW
        && gap.corrected > IMITATION_STANDS_OUT * gap.noise_floor
        && gap.closed < 1.0 - STAND_IN_LEAVES
        && gap.corrected > TRIFLE
        && (named.any(is_here) || laws.next().is_none())
}

/// Whether a name that may be a stand-in leaves more than a stand-in may.
pub(crate) fn is_poor_stand_in(answer: &Answer, gap: &Gap) -> bool {
    gap.closed < 1.0 - STAND_IN_LEAVES
        && gap.corrected > STAND_IN_STANDS_OUT * gap.noise_floor
        && (0..answer.judged.len()).any(|i| !doubts(answer, i).is_empty())
}

/// Whether named effects do hardly better on the check records than parameters alone.
fn is_of_no_use(answer: &Answer, gap: &Gap, status: Status) -> bool {
    status == Status::Effect
        && gap.closed < CLOSES
        && closed(gap.recalibrated, gap.corrected, gap.noise_floor) < OF_SOME_USE
        && !explains_all_it_saw(answer)
        && !answer.follows_anew
}

/// Whether the same effect of the measurement chain, with the same values, is named on every one of several
/// channels: its cause is common to them, and lies before the sensors.
fn on_every_channel(train: &Problem, answer: &Answer) -> bool {
    let channels = train.model.outputs.len();
    let of_kind = |kind: &str| {
        let all = answer.judged.iter().zip(&answer.estimate.intervals);
        let same = all.filter(|(judged, _)| judged.placed.effect.kind() == kind);
        same.map(|(_, intervals)| intervals).collect::<Vec<_>>()
    };
    let agree = |one: &Vec<Interval>, other: &Vec<Interval>| {
        let mut both = one.iter().zip(other);
        both.all(|(a, b)| {
            let apart = (a.value - b.value).abs();
            apart <= ALIKE * a.value.abs() || a.ci95[0] <= b.ci95[1] && b.ci95[0] <= a.ci95[1]
        })
    };
    let mut smooth = answer.judged.iter().map(|judged| &judged.placed);
    channels > 1
        && smooth.any(|placed| {
            let on = of_kind(placed.effect.kind());
            matches!(placed.action(), Action::Output(_))
                && on.len() == channels
                && on.windows(2).all(|pair| agree(pair[0], pair[1]))
        })
}

fn describe_rest(train: &Problem, answer: &Answer) -> Vec<String> {
    let Some(run) = train.runs.first() else {
        return vec![];
    };
    let Ok(simulator) = train.simulator(&answer.estimate.estimate.nominal, 0) else {
        return vec![];
    };
    let initial = &answer.estimate.estimate.initial[0];
    let mut sentences = Vec::new();
    for (c, output) in train.model.outputs.iter().enumerate() {
        let place = match (&output.at, &output.between) {
            (Some(at), _) => Location::Mass(at.clone()),
            (None, Some(pair)) => Location::Between(pair.clone()),
            (None, None) => continue,
        };
        if let Ok(path) = simulator.path(run, initial, &place) {
            let left = &answer.nominal.discrepancy[0][c];
            let rate = 1.0 / run.time_step_s;
            sentences.extend(describe(
                &output.channel,
                left,
                &path,
                &place.to_string(),
                rate,
            ));
        }
    }
    if !answer.set.effects().is_empty() {
        sentences.push(format!(
            "the nearest of the catalogue, {}, leaves most of it",
            crate::pipeline::names(answer.set.effects())
        ));
    }
    sentences
}

/// The likeliest rivals that the data cannot tell from a named effect, of at most [`MOST_RIVALS`] kinds.
fn rivals(answer: &Answer, judged: &Judged) -> Vec<Rival> {
    let swaps = judged.swaps.iter();
    let mut close: Vec<&Swap> = swaps
        .filter(|swap| {
            is_as_likely(answer, swap) || is_same_line(swap) || out_of_sight(swap).is_some()
        })
        .collect();
    close.sort_by(|a, b| {
        // What is the same where a mode is out of sight comes before what happens to fit as well.
        let by_sight = out_of_sight(b).is_some().cmp(&out_of_sight(a).is_some());
        let by_fit = a.misfit.total_cmp(&b.misfit);
        by_sight
            .then(b.evidence.total_cmp(&a.evidence))
            .then(by_fit)
    });
    let own = judged.placed.effect.kind();
    let same = judged.same.iter().map(|other| Rival {
        kind: other.kind.to_string(),
        at: other.at.clone(),
        because: other.because.to_string(),
    });
    let close = close.into_iter().map(|swap| Rival {
        kind: swap.placed.effect.kind().to_string(),
        at: swap.placed.at.clone(),
        because: because(answer, judged, swap),
    });
    let mut kinds = vec![own.to_string()];
    let mut rivals: Vec<Rival> = Vec::new();
    for rival in same.chain(close) {
        if kinds.len() <= MOST_RIVALS && !kinds.contains(&rival.kind) {
            kinds.push(rival.kind.clone());
        }
        let is_new = rivals
            .iter()
            .all(|known| known.kind != rival.kind || !same_place(&known.at, &rival.at));
        if kinds.contains(&rival.kind) && is_new {
            rivals.push(rival);
        }
    }
    rivals
}

fn is_as_likely(answer: &Answer, swap: &Swap) -> bool {
    answer.set.evidence - swap.evidence < INDISTINGUISHABLE
}

/// A clock that ticks in step with the motion: no data at this rate can tell, whatever the number of
/// its parameters says.
fn is_same_line(swap: &Swap) -> bool {
    swap.placed.effect.clock().is_some() && swap.misfit < INDISTINGUISHABLE
}

/// What dynamics turn into where their own mode is out of sight: the data would have to contradict them, the
/// number of their parameters says nothing.
fn out_of_sight(swap: &Swap) -> Option<&'static str> {
    swap.turns_into.filter(|_| swap.misfit < INDISTINGUISHABLE)
}

fn because(answer: &Answer, judged: &Judged, swap: &Swap) -> String {
    let own = judged.placed.effect.kind();
    let behind = answer.set.evidence - swap.evidence;
    if let Some(limit) = out_of_sight(swap) {
        return format!(
            "where its own mode is out of sight it acts as {limit} does, and it fits as well"
        );
    }
    if !is_as_likely(answer, swap) {
        return format!(
            "at this sample rate its line is where {own} leaves one of this motion, and it fits as well"
        );
    }
    format!(
        "in its place it fits the training records as well (log evidence {} by {:.1}, needed to tell them apart is {INDISTINGUISHABLE:.0})",
        if behind >= 0.0 { "lower" } else { "higher" },
        behind.abs()
    )
}

fn sentences(judged: &Judged) -> Vec<String> {
    let mut sentences = vec![
        judged.placed.effect.summary().to_string(),
        format!("log evidence falls by {:.1} without it", judged.worth),
        format!(
            "the squared discrepancy of the channel that profits most is {:.1} % lower with it",
            100.0 * judged.relevance
        ),
    ];
    if let Some(next) = judged.swaps.first() {
        sentences.push(format!(
            "the next best in its place is {}",
            name(&next.placed)
        ));
    }
    sentences
}

/// Single effects with their gap on the check records and their part in the answer.
pub(crate) fn candidates(
    check: &Problem,
    answer: &Answer,
    verdict: &Verdict,
    weights: &Weights,
) -> Result<Vec<CandidateResult>, EstimateError> {
    let sets: Vec<Vec<Placed>> = answer
        .singles
        .iter()
        .take(SHOWN)
        .map(|single| {
            let estimate = &single.fit.estimate;
            estimate
                .effects
                .iter()
                .chain(&estimate.nominal)
                .cloned()
                .collect()
        })
        .collect();
    let gaps = sets
        .par_iter()
        .map(|set| Ok(total(&predict(check, set, weights)?.nrmse)))
        .collect::<Result<Vec<f64>, EstimateError>>()?;
    let mut results: Vec<CandidateResult> = sets
        .iter()
        .zip(gaps)
        .map(|(set, held_back_gap)| CandidateResult {
            kind: set[0].effect.kind().to_string(),
            at: set[0].at.clone(),
            held_back_gap,
            probability: probability(answer, verdict, &set[0]),
        })
        .collect();
    results.sort_by(|a, b| {
        b.probability
            .total_cmp(&a.probability)
            .then(a.held_back_gap.total_cmp(&b.held_back_gap))
    });
    Ok(results)
}

/// Probability that an effect belongs to the cause: its own where it is named, what it holds
/// against a named one where it is a rival.
fn probability(answer: &Answer, verdict: &Verdict, placed: &Placed) -> f64 {
    if verdict.effects.is_empty() {
        return 0.0;
    }
    let mut named = verdict.effects.iter();
    if let Some(named) = named.find(|e| e.kind == placed.effect.kind() && e.at == placed.at) {
        return named.probability;
    }
    answer
        .judged
        .iter()
        .flat_map(shares_of)
        .filter(|(candidate, _)| name(candidate) == name(placed))
        .map(|(_, probability)| probability * TRUST[0])
        .fold(0.0, f64::max)
}

/// A named effect and its rivals with their probabilities.
fn shares_of(judged: &Judged) -> impl Iterator<Item = (&Placed, f64)> {
    let rivals = judged.swaps.iter().zip(&judged.swap_probabilities);
    std::iter::once((&judged.placed, judged.probability))
        .chain(rivals.map(|(swap, &probability)| (&swap.placed, probability)))
}

/// How the cause spreads over the places: each named effect counts by what it explains, each of
/// its rivals by its probability.
pub(crate) fn locations(answer: &Answer, unknown: bool) -> Vec<LocationShare> {
    let mut shares: Vec<LocationShare> = Vec::new();
    let mut add = |at: &Location, share: f64| match shares.iter_mut().find(|s| &s.at == at) {
        Some(known) => known.share += share,
        None => shares.push(LocationShare {
            at: at.clone(),
            share,
        }),
    };
    if answer.judged.is_empty() || unknown {
        let evidence: Vec<f64> = answer.singles.iter().map(|s| s.evidence).collect();
        for (single, share) in answer.singles.iter().zip(probabilities(&evidence)) {
            add(&single.effects()[0].at, share);
        }
    } else {
        for judged in &answer.judged {
            for (placed, probability) in shares_of(judged) {
                add(&placed.at, probability * judged.relevance.max(1e-3));
            }
        }
    }
    let sum: f64 = shares.iter().map(|s| s.share).sum();
    shares
        .iter_mut()
        .for_each(|s| s.share /= sum.max(f64::MIN_POSITIVE));
    shares.retain(|s| s.share >= 0.01);
    shares.sort_by(|a, b| b.share.total_cmp(&a.share));
    shares
}

/// What to measure next when rivals are left.
pub(crate) fn next_experiment(verdict: &Verdict) -> Option<String> {
    let rivals: Vec<String> = verdict
        .effects
        .iter()
        .filter_map(|effect| {
            let rival = effect.indistinguishable.first()?;
            let mine = find(&effect.kind)?.experiment();
            let other = find(&rival.kind)?.experiment();
            Some(if mine == other {
                format!(
                    "to tell {} {} from {} {}: {mine}, with a sensor at each of the two places",
                    effect.kind, effect.at, rival.kind, rival.at
                )
            } else {
                format!(
                    "to tell {} from {}: {mine}; or {other}",
                    effect.kind, rival.kind
                )
            })
        })
        .collect();
    if !rivals.is_empty() {
        return Some(rivals.join(". "));
    }
    (verdict.status == Status::Unknown).then(|| {
        "slow loading forwards and back over the whole travel, then the same motion at three speeds: force against displacement and against velocity show what kind of law is missing".into()
    })
}
