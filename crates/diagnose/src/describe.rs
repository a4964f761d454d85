//! The answer in words and numbers.

use simgap_effects::{Placed, find_of, same_place, slip_of};
use simgap_estimate::{EstimateError, Fit, Interval};
use simgap_inference::{CandidateModel, EffectPosterior, name};
use simgap_model::{Location, Model};

use crate::check::{Check, Checked};
use crate::decide::Decision;
use crate::diagnosis::{
    CandidateResult, ChannelGap, ChannelShare, LocationShare, NamedEffect, NamedParameter,
    OtherCause, Rival, Status, Unexplained, Verdict,
};
use crate::place::place_of;
use crate::structure::describe;
use crate::units::Units;

/// Probabilities that are stated: nothing is certain, and nothing that is named is impossible.
const STATED: [f64; 2] = [0.01, 0.99];
/// Other kinds that are listed beside a named one.
const MOST_RIVALS: usize = 3;
/// Single effects that are listed with their gap.
const LISTED: usize = 12;
/// A channel of which a set explains less than this share of its variance is not moved by the model.
const UNCONNECTED: f64 = 0.1;

/// The answer.
pub(crate) fn verdict(
    model: &Model,
    decision: &Decision,
    estimate: &Fit,
    checked: &Checked,
    units: &Units,
) -> Verdict {
    // What is judged by the check records is the best set, unless a free law takes its place.
    let of_training = decision.other.probability;
    let is_judged = decision.status != Status::Unknown;
    let other = match is_judged {
        true => of_training.max(checked.other),
        false => of_training,
    };
    // Where nothing is named there is nothing to refute.
    let refuted = is_judged && checked.is_refuted() && !decision.effects.is_empty();
    let is_unknown = !is_judged || checked.is_refuted();
    // For `unknown` the final fit is that of something else: the values are those of the search.
    let fitted = match is_unknown {
        true => decision.posterior.best().map(|best| &best.fit),
        false => Some(estimate),
    };
    let own = 1.0 - other;
    let named: Vec<NamedEffect> = decision
        .order()
        .into_iter()
        .map(|i| {
            let effect = &decision.effects[i];
            let intervals = fitted.and_then(|fit| intervals_of(fit, &effect.placed));
            // What is left beside the other effects is the gap of each.
            let share = own.min(1.0 - effect.other);
            self::named(effect, share, intervals.unwrap_or_default(), units)
        })
        .collect();
    let (effects, leading) = match is_unknown {
        true => (vec![], named),
        false => (named, vec![]),
    };
    let status = if is_unknown {
        Status::Unknown
    } else {
        decision.status
    };
    Verdict {
        status,
        complete: checked.is_complete && !is_unknown,
        unexplained: unexplained(model, checked),
        refuted,
        other: OtherCause {
            probability: other,
            at: decision.other.law.as_ref().map(|law| law.placed.at.clone()),
            closed: decision.other.law.as_ref().map(|law| 1.0 - law.left),
        },
        description: match status {
            Status::Unknown => description(model, decision, checked, refuted),
            _ => vec![],
        },
        effects,
        leading,
    }
}

/// The values of an effect in a fit.
fn intervals_of<'a>(fit: &'a Fit, placed: &Placed) -> Option<&'a [Interval]> {
    let own = name(placed);
    let effects = fit.estimate.effects.iter().zip(&fit.intervals);
    let mut own = effects.filter(|(other, _)| name(other) == own);
    own.next().map(|(_, intervals)| &intervals[..])
}

fn named(
    posterior: &EffectPosterior,
    share: f64,
    intervals: &[Interval],
    units: &Units,
) -> NamedEffect {
    let effect = posterior.placed.effect;
    let parameters = effect.parameters().iter().zip(intervals);
    let parameters = parameters.map(|(parameter, interval)| NamedParameter {
        name: parameter.name.to_string(),
        unit: units.of(effect, parameter, &posterior.placed.at),
        value: interval.value,
        ci95: interval.ci95,
    });
    let parameters: Vec<NamedParameter> = parameters.collect();
    let [least, most] = STATED;
    NamedEffect {
        kind: effect.kind().to_string(),
        at: posterior.placed.at.clone(),
        probability: (posterior.probability * share).clamp(least, most),
        indistinguishable: rivals(posterior),
        evidence: sentences(posterior, &parameters),
        parameters,
    }
}

/// What cannot be told from a named effect: the same by another name first, then what fits as well; of a few kinds.
fn rivals(posterior: &EffectPosterior) -> Vec<Rival> {
    let same = posterior.equivalents.iter().map(|other| Rival {
        kind: other.kind.to_string(),
        at: other.at.clone(),
        because: other.because.to_string(),
    });
    let close = posterior.rivals.iter().map(|rival| Rival {
        kind: rival.placed.effect.kind().to_string(),
        at: rival.placed.at.clone(),
        because: format!(
            "in its place it explains the training records about as well (log odds {:.1}; from -3 on they can be told apart)",
            rival.log_odds
        ),
    });
    let mut kinds = vec![posterior.placed.effect.kind().to_string()];
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

fn sentences(posterior: &EffectPosterior, parameters: &[NamedParameter]) -> Vec<String> {
    let mut sentences = vec![posterior.placed.effect.summary().to_string()];
    let gains = parameters.iter().filter(|p| p.name == "gain_factor");
    for slip in gains.filter_map(|gain| slip_of(gain.value)) {
        let at = &posterior.placed.at;
        sentences.push(format!(
            "looks like a slip of units or sign {at}: {}",
            slip.name
        ));
    }
    sentences.push(match posterior.worth.is_finite() {
        true => format!(
            "without it the log posterior of the set falls by {:.1}",
            posterior.worth
        ),
        false => "without it the others take values that machines do not have".into(),
    });
    sentences.push(format!(
        "it closes {:.0} % of the gap in the channel that profits most",
        100.0 * posterior.closes.min(1.0)
    ));
    sentences
}

fn unexplained(model: &Model, checked: &Checked) -> Unexplained {
    let gap = &checked.gap;
    let all: f64 = gap.channels.iter().map(|c| c.nominal.powi(2)).sum();
    let channels = gap.channels.iter().zip(&checked.left_of_channels);
    let channels = channels.map(|(channel, left)| ChannelShare {
        channel: channel.channel.clone(),
        share: (left / all.sqrt().max(f64::MIN_POSITIVE)).min(1.0),
    });
    Unexplained {
        share: checked.left,
        of: "gap",
        channels: channels.collect(),
        looks_like: match checked.left > 0.0 {
            true => looks_like(model, checked, 2)
                .into_iter()
                .next()
                .unwrap_or_default(),
            false => String::new(),
        },
    }
}

/// What the discrepancy of the given prediction looks like on the first check record.
fn looks_like(model: &Model, checked: &Checked, prediction: usize) -> Vec<String> {
    let prediction = &checked.predictions[prediction];
    let mut sentences = Vec::new();
    let (Some(left), Some(path_of)) = (prediction.discrepancy.first(), checked.paths.first())
    else {
        return sentences;
    };
    for (c, output) in model.outputs.iter().enumerate() {
        let (Some(place), Some(path)) = (place_of(output), path_of.get(c)) else {
            continue;
        };
        let across = match &place {
            Location::Mass(mass) => format!("of {mass}"),
            place => place.to_string(),
        };
        let rate = checked.sample_rate_hz;
        sentences.extend(describe(&output.channel, &left[c], path, &across, rate));
    }
    sentences
}

/// The channels that the model does not move.
fn unconnected(checked: &Checked) -> impl Iterator<Item = &str> {
    let channels = checked.gap.channels.iter();
    let explained = |c: &ChannelGap| 1.0 - c.recalibrated.min(c.corrected).powi(2);
    let unmoved = channels.filter(move |c| explained(c) < UNCONNECTED);
    unmoved.map(|c| c.channel.as_str())
}

fn description(
    model: &Model,
    decision: &Decision,
    checked: &Checked,
    refuted: bool,
) -> Vec<String> {
    let mut sentences = vec![];
    if refuted {
        sentences.push(
            "the check records refute the best set: it closes less than half of the gap there"
                .into(),
        );
    }
    for channel in unconnected(checked) {
        sentences.push(format!(
            "channel {channel} has nothing to do with the inputs: no set of the catalogue explains a tenth of it"
        ));
    }
    if let Some(found) = &decision.other.coincidence {
        let effects = found.effects.iter();
        let names: Vec<String> = effects.map(|(kind, at)| format!("{kind} {at}")).collect();
        sentences.push(match &names[..] {
            [one] => format!("{one} has two values that agree: one would do"),
            _ => format!(
                "{} agree in {}: one cause behind both is likelier than two",
                names.join(" and "),
                found.parameter
            ),
        });
    }
    if let Some(law) = &decision.other.law {
        let at = &law.placed.at;
        let closed = 100.0 * (1.0 - law.left);
        sentences.push(format!(
            "a free law {at} closes {closed:.0} % of the gap of the training records"
        ));
    }
    if let Some(best) = decision
        .posterior
        .best()
        .filter(|best| !best.effects().is_empty())
    {
        let nearest: Vec<String> = best.effects().iter().map(name).collect();
        sentences.push(format!(
            "the best set of the catalogue, {}, leaves {:.0} % of it",
            nearest.join(", "),
            100.0 * decision.other.left
        ));
    }
    sentences.extend(looks_like(model, checked, 0));
    sentences
}

/// Single effects with their gap on the check records and their probability.
pub(crate) fn candidates(
    decision: &Decision,
    verdict: &Verdict,
    check: &Check<'_>,
) -> Result<Vec<CandidateResult>, EstimateError> {
    let singles = decision
        .posterior
        .sets
        .iter()
        .filter(|set| set.effects().len() == 1);
    let singles: Vec<&CandidateModel> = singles.take(LISTED).collect();
    let gaps = check.held_back(&singles)?;
    let own = 1.0 - verdict.other.probability;
    let mut results: Vec<CandidateResult> = singles
        .iter()
        .zip(gaps)
        .map(|(set, held_back_gap)| {
            let placed = &set.effects()[0];
            let mut named = verdict.effects.iter();
            let named = named.find(|e| e.kind == placed.effect.kind() && e.at == placed.at);
            CandidateResult {
                kind: placed.effect.kind().to_string(),
                at: placed.at.clone(),
                held_back_gap,
                probability: named.map_or_else(
                    || own * decision.posterior.probability_of(placed),
                    |named| named.probability,
                ),
            }
        })
        .collect();
    results.sort_by(|a, b| {
        b.probability
            .total_cmp(&a.probability)
            .then(a.held_back_gap.total_cmp(&b.held_back_gap))
    });
    Ok(results)
}

/// How the cause spreads over the places: effects of the likeliest sets, each by the probability of its set; for
/// `unknown` the place of the free law with the probability of another cause.
pub(crate) fn locations(decision: &Decision, is_unknown: bool) -> Vec<LocationShare> {
    let mut shares: Vec<LocationShare> = Vec::new();
    let mut add = |at: &Location, share: f64| match shares.iter_mut().find(|s| &s.at == at) {
        Some(known) => known.share += share,
        None => shares.push(LocationShare {
            at: at.clone(),
            share,
        }),
    };
    let own = 1.0 - decision.other.probability;
    let sets = decision
        .posterior
        .sets
        .iter()
        .zip(&decision.posterior.probabilities);
    for (set, probability) in sets {
        for placed in set.effects() {
            add(&placed.at, own * probability / set.effects().len() as f64);
        }
    }
    if is_unknown {
        if let Some(law) = &decision.other.law {
            add(&law.placed.at, decision.other.probability);
        }
    } else if decision
        .posterior
        .best()
        .is_none_or(|best| best.effects().is_empty())
    {
        for effect in &decision.effects {
            add(&effect.placed.at, effect.probability);
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

/// What to measure next: to tell rivals apart, or, where the cause is unknown, to see what it is.
pub(crate) fn next_experiment(
    model: &Model,
    verdict: &Verdict,
    checked: &Checked,
) -> Option<String> {
    let rivals: Vec<String> = verdict
        .effects
        .iter()
        .filter_map(|effect| {
            let rival = effect.indistinguishable.first()?;
            let mine = find_of(model, &effect.kind)?.experiment();
            let other = find_of(model, &rival.kind)?.experiment();
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
    let is_unknown = verdict.status == Status::Unknown;
    let channels: Vec<&str> = unconnected(checked).filter(|_| is_unknown).collect();
    if !channels.is_empty() {
        return Some(format!(
            "see whether the sensor of {} is connected: its reading while the machine is moved by hand, or driven slowly",
            channels.join(" and of ")
        ));
    }
    is_unknown.then(|| {
        "slow loading forwards and back over the whole travel, then the same motion at three speeds: force against displacement and against velocity show what kind of law is missing".into()
    })
}
