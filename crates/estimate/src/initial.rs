//! How records begin: initial states, and the phases of effects that have a clock of their own.

use std::f64::consts::FRAC_PI_2;

use simgap_effects::Placed;
use simgap_simulate::Simulator;

use crate::fit::fit_with;
use crate::{EstimateError, Fit, Problem, Start, Weights};

/// Fits what a record has of its own, with everything else as given: the initial state, and of
/// effects with a clock or a hidden state the phase or the start.
///
/// The effects that have such values come back in [`Fit::estimate`].
///
/// # Errors
/// [`EstimateError`] when the model cannot be propagated.
pub fn fit_initial_states(
    problem: &Problem,
    effects: &[Placed],
    weights: &Weights,
) -> Result<Fit, EstimateError> {
    let mut fixed = problem.with_runs(problem.runs.clone());
    let of_file = std::mem::take(&mut fixed.given);
    let all = of_file.iter().chain(effects).cloned();
    let (own, given): (Vec<Placed>, Vec<Placed>) = all.partition(|p| !p.own_places().is_empty());
    fixed.given = given;
    let initial = problem.initial_guess();
    if own.is_empty() {
        let start = Start {
            effects: vec![],
            nominal: vec![],
            initial,
        };
        return fit_with(&fixed, &start, weights, true, |_, _, _| None);
    }
    // Given what they share, the records have nothing to do with each other.
    let mut whole = Start {
        effects: own.iter().map(shared_only).collect(),
        nominal: vec![],
        initial: vec![],
    };
    for (run, state) in fixed.runs.iter().zip(initial) {
        let alone = fixed.with_runs(vec![run.clone()]);
        let best = best_of(&alone, &own, state, weights)?;
        for (placed, found) in whole.effects.iter_mut().zip(&best.estimate.effects) {
            placed.of_record.extend(found.of_record.first().cloned());
        }
        whole.initial.extend(best.estimate.initial);
    }
    fit_with(&fixed, &whole, weights, true, |_, _, _| None)
}

/// The model of a problem as a fit of [`fit_initial_states`] found it in one of the runs.
///
/// # Errors
/// [`EstimateError`] when a place is not in the model.
pub fn simulator_at(problem: &Problem, fit: &Fit, run: usize) -> Result<Simulator, EstimateError> {
    let mut fixed = problem.with_runs(vec![]);
    fixed.given.retain(|placed| placed.own_places().is_empty());
    fixed.simulator(&fit.estimate.effects, run)
}

fn shared_only(placed: &Placed) -> Placed {
    Placed::new(placed.effect, placed.at.clone(), placed.values.clone())
}

/// The best fit of one run from each quarter of every clock: a sine has one best phase and one
/// worst.
fn best_of(
    alone: &Problem,
    own: &[Placed],
    state: Vec<f64>,
    weights: &Weights,
) -> Result<Fit, EstimateError> {
    let mut starts: Vec<Vec<Placed>> = vec![own.iter().map(from_rest).collect()];
    for (e, placed) in own.iter().enumerate() {
        let Some(clock) = placed.effect.clock() else {
            continue;
        };
        starts = (0..4)
            .flat_map(|quarter| {
                let turned = starts.iter().map(move |effects| {
                    let mut effects = effects.clone();
                    effects[e].values[clock.phase] = f64::from(quarter) * FRAC_PI_2;
                    effects
                });
                turned.collect::<Vec<_>>()
            })
            .collect();
    }
    let mut best: Option<Fit> = None;
    for effects in starts {
        let start = Start {
            effects,
            nominal: vec![],
            initial: vec![state.clone()],
        };
        let fit = fit_with(alone, &start, weights, true, |_, _, _| None)?;
        if best
            .as_ref()
            .is_none_or(|known| fit.objective < known.objective)
        {
            best = Some(fit);
        }
    }
    best.map_or_else(
        || {
            let start = Start {
                effects: vec![],
                nominal: vec![],
                initial: vec![state],
            };
            fit_with(alone, &start, weights, true, |_, _, _| None)
        },
        Ok,
    )
}

/// With the values that a record has of its own where they mean nothing.
fn from_rest(placed: &Placed) -> Placed {
    let mut rest = shared_only(placed);
    for place in placed.own_places() {
        rest.values[place] = placed.effect.parameters()[place].neutral.unwrap_or(0.0);
    }
    rest
}
