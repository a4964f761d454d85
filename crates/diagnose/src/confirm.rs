//! Whether a further effect helps on samples that neither set was fitted to.

use rayon::prelude::*;
use simgap_effects::{Action, Placed};
use simgap_estimate::{EstimateError, Problem, Start, Weights, fit, fit_initial_states};
use simgap_model::{Location, Model};
use simgap_simulate::Run;

use crate::difference::lacking;
use crate::hypothesis::Hypothesis;
use crate::search::Search;

/// Share of the training records that the confirmation learns from.
const LEARNT: f64 = 0.7;
/// A further effect must lower the squared discrepancy on samples it was not fitted to by this much.
const CONFIRMED: f64 = 0.01;

/// What samples that neither of two sets was fitted to say about them.
enum Ruling {
    Better,
    Worse,
    Open,
}

/// Whether the larger set predicts better what neither was fitted to: the last part of each run
/// or, where that says nothing (a decay that is over), a whole run.
pub(crate) fn confirmed(
    search: &Search<'_>,
    larger: &Hypothesis,
    smaller: &Hypothesis,
) -> Result<bool, EstimateError> {
    let runs = &search.problem.runs;
    let cut = |run: &Run| (run.len as f64 * LEARNT) as usize;
    let first = runs.iter().map(|run| run.slice(0..cut(run))).collect();
    let last = runs
        .iter()
        .map(|run| run.slice(cut(run)..run.len))
        .collect();
    let struck = struck(&search.problem.model, larger, smaller);
    let sets = [larger, smaller];
    match ruling(search, sets, struck, first, last)? {
        Ruling::Better => return Ok(true),
        Ruling::Worse => return Ok(false),
        Ruling::Open => {}
    }
    // Samples that are struck now and then need not be among those that are kept.
    let nothing_said = struck.is_some();
    let Some((apart, others)) = runs.split_last().filter(|(_, others)| !others.is_empty()) else {
        return Ok(nothing_said);
    };
    let (learnt, kept) = (others.to_vec(), vec![apart.clone()]);
    Ok(match ruling(search, sets, struck, learnt, kept)? {
        Ruling::Better => true,
        Ruling::Worse => false,
        Ruling::Open => nothing_said,
    })
}

/// The channel of what one set has beyond another, where that is a fault of stored values.
fn struck(model: &Model, larger: &Hypothesis, smaller: &Hypothesis) -> Option<usize> {
    let mut further = lacking(smaller, larger);
    let (Some((further, _)), None) = (further.next(), further.next()) else {
        return None;
    };
    match (further.action(), &further.at) {
        (Action::Sampling(map), Location::Channel(channel)) if map.is_lossy() => {
            model.output_index(channel)
        }
        _ => None,
    }
}

/// Which of two sets, both fitted to `learnt`, predicts `kept` better: on the `struck` channel, where a fault of its stored
/// values is all they differ by, else on all.
fn ruling(
    search: &Search<'_>,
    sets: [&Hypothesis; 2],
    struck: Option<usize>,
    learnt: Vec<Run>,
    kept: Vec<Run>,
) -> Result<Ruling, EstimateError> {
    let learnt = search.problem.with_runs(learnt);
    let kept = search.problem.with_runs(kept);
    let left = sets
        .into_par_iter()
        .map(|set| held_back_variance(&learnt, &kept, &set.fit.estimate, &search.weights))
        .collect::<Result<Vec<_>, _>>()?;
    // One channel that profits is enough, as long as the others do not pay for it.
    let asked = |c: &usize| struck.is_none_or(|struck| *c == struck);
    let ratios: Vec<f64> = (0..left[0].len())
        .filter(asked)
        .map(|c| left[0][c] / left[1][c])
        .collect();
    let best = ratios.iter().copied().fold(f64::INFINITY, f64::min);
    let geometric = ratios.iter().map(|r| r.ln()).sum::<f64>() / ratios.len().max(1) as f64;
    Ok(if best < 1.0 - CONFIRMED && geometric < 0.0 {
        Ruling::Better
    } else if geometric > CONFIRMED {
        Ruling::Worse
    } else {
        Ruling::Open
    })
}

/// V_c on the kept runs after a fit to the learnt ones.
fn held_back_variance(
    learnt: &Problem,
    kept: &Problem,
    start: &Start,
    weights: &Weights,
) -> Result<Vec<f64>, EstimateError> {
    let mut start = start.clone();
    start.initial.truncate(learnt.runs.len());
    let estimate = fit(learnt, &start, weights)?.estimate;
    let effects: Vec<Placed> = estimate.placed().cloned().collect();
    Ok(fit_initial_states(kept, &effects, weights)?.variance)
}
