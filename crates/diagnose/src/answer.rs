//! The answer in words and numbers.

use rayon::prelude::*;
use simgap_effects::{Placed, find, same_place};
use simgap_estimate::{EstimateError, Interval, Problem, Weights, fit_initial_states};
use simgap_model::Location;

use crate::diagnosis::{
    CandidateResult, Gap, LocationShare, NamedEffect, NamedParameter, Rival, Status, Verdict,
};
use crate::evidence::{is_nominal, probabilities};
use crate::gap::{predict, total};
use crate::hypothesis::{Hypothesis, name};
use crate::pipeline::Answer;
use crate::stand_in::doubts;
use crate::structure::describe;
use crate::unexplained::unexplained;
use crate::verdict::{INDISTINGUISHABLE, Judged, Swap};

/// How often a name is right that beats its rivals by far, and one that may be a stand-in; on
/// generated cases.
const TRUST: [f64; 2] = [0.97, 0.8];
/// Other kinds that are listed beside a named one.
const MOST_RIVALS: usize = 2;
/// Single effects whose gap on the check records is computed.
const SHOWN: usize = 12;

pub(crate) fn verdict(train: &Problem, answer: &Answer, gap: &Gap) -> Verdict {
    // What does most comes first, and what the model lacks before parameters of it that are off besides.
    let mut order: Vec<usize> = (0..answer.judged.len()).collect();
    order.sort_by(|&i, &j| {
        let [one, other] = [i, j].map(|k| &answer.judged[k]);
        let by_family = is_nominal(&one.placed).cmp(&is_nominal(&other.placed));
        by_family.then(other.worth.total_cmp(&one.worth))
    });
    let effects: Vec<NamedEffect> = order.into_iter().map(|i| named(answer, gap, i)).collect();
    let mut status = if effects.is_empty() {
        Status::None
    } else if answer.names_more_than_parameters() {
        Status::Effect
    } else {
        Status::Parameters
    };
    let mut description = Vec::new();
    if let Some(why) = unexplained(train, answer, gap, status) {
        status = Status::Unknown;
        description = describe_rest(train, answer);
        if !answer.set.effects().is_empty() {
            let nearest = crate::pipeline::names(answer.set.effects());
            description.push(format!(
                "the nearest of the catalogue, {nearest}, cannot be believed: {why}"
            ));
        }
    }
    Verdict {
        status,
        effects,
        description,
    }
}

impl Answer {
    /// Intervals of the parameters of the i-th effect.
    pub(crate) fn intervals(&self, i: usize) -> &[Interval] {
        self.estimate.intervals.get(i).map_or(&[], Vec::as_slice)
    }
}

/// The i-th effect of the answer.
fn named(answer: &Answer, gap: &Gap, i: usize) -> NamedEffect {
    let judged = &answer.judged[i];
    let effect = judged.placed.effect;
    let parameters = effect.parameters().iter().zip(answer.intervals(i));
    let doubts = doubts(answer, gap, i);
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

fn describe_rest(train: &Problem, answer: &Answer) -> Vec<String> {
    let Some(run) = train.runs.first() else {
        return vec![];
    };
    let Ok(simulator) = train.simulator(&answer.estimate.estimate.nominal, 0) else {
        return vec![];
    };
    let initial = &answer.estimate.estimate.initial[0];
    // What is left is told as it is, not as an answer is judged by it.
    let as_it_is = train.is_whitened().then(|| {
        let alone = train.unfiltered().with_runs(vec![run.clone()]);
        let plain = Weights::independent(train.model.outputs.len());
        fit_initial_states(&alone, &[], &plain).ok()
    });
    let nominal = as_it_is.flatten();
    let left = &nominal.as_ref().unwrap_or(&answer.nominal).discrepancy[0];
    let mut sentences = Vec::new();
    for (c, output) in train.model.outputs.iter().enumerate() {
        let place = match (&output.at, &output.between) {
            (Some(at), _) => Location::Mass(at.clone()),
            (None, Some(pair)) => Location::Between(pair.clone()),
            (None, None) => continue,
        };
        if let Ok(path) = simulator.path(run, initial, &place) {
            let across = match &place {
                Location::Mass(mass) => format!("of {mass}"),
                place => place.to_string(),
            };
            let rate = 1.0 / run.time_step_s;
            sentences.extend(describe(&output.channel, &left[c], &path, &across, rate));
        }
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

/// What the first single effects leave of the check records.
pub(crate) fn held_back(
    check: &Problem,
    singles: &[Hypothesis],
    weights: &Weights,
) -> Result<Vec<f64>, EstimateError> {
    let shown = &singles[..singles.len().min(SHOWN)];
    shown
        .par_iter()
        .map(|single| {
            let set: Vec<Placed> = single.fit.estimate.placed().cloned().collect();
            Ok(total(&predict(check, &set, weights)?.nrmse))
        })
        .collect()
}

/// Single effects with their gap on the check records and their part in the answer.
pub(crate) fn candidates(answer: &Answer, verdict: &Verdict) -> Vec<CandidateResult> {
    let singles = answer.singles.iter().map(|single| &single.effects()[0]);
    let mut results: Vec<CandidateResult> = singles
        .zip(&answer.held_back)
        .map(|(placed, &held_back_gap)| CandidateResult {
            kind: placed.effect.kind().to_string(),
            at: placed.at.clone(),
            held_back_gap,
            probability: probability(answer, verdict, placed),
        })
        .collect();
    results.sort_by(|a, b| {
        b.probability
            .total_cmp(&a.probability)
            .then(a.held_back_gap.total_cmp(&b.held_back_gap))
    });
    results
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
