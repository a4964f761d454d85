//! How records begin: initial states, and the phases of effects that have a clock of their own.

use std::f64::consts::FRAC_PI_2;

use simgap_effects::{Family, Placed};
use simgap_simulate::Simulator;

use crate::drift;
use crate::fit::fit_with;
use crate::scattered::{is_astray, scattered};
use crate::{EstimateError, Fit, FitOptions, Problem, Start};

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
    weights: &FitOptions,
) -> Result<Fit, EstimateError> {
    let mut fixed = problem.with_runs(problem.runs.clone());
    // How a record begins is told by the record alone.
    fixed.state_std.clear();
    let of_file = std::mem::take(&mut fixed.given);
    let all = of_file.iter().chain(effects).cloned();
    let (own, given): (Vec<Placed>, Vec<Placed>) = all.partition(|p| !p.own_places().is_empty());
    fixed.given = given;
    let mut initial = fixed.initial_guess();
    if own.is_empty() {
        if fixed.given.iter().any(|placed| fixed.shows_travel(placed)) {
            for (run, state) in fixed.runs.iter().zip(&mut initial) {
                *state = at_its_place(&fixed.with_runs(vec![run.clone()]), state, weights);
            }
        }
        let mut best = states_from(&fixed, initial.clone(), weights)?;
        if !may_part(&fixed.given) || fixed.state_len() == 0 {
            return Ok(best);
        }
        // A part that cannot be simulated leads nowhere.
        let better = |start: Result<Vec<Vec<f64>>, EstimateError>, best: Fit| {
            let found = start.and_then(|start| states_from(&fixed, start, weights));
            let enough = best.objective - weights.converged;
            let found = found.ok().filter(|found| found.objective < enough);
            found.unwrap_or(best)
        };
        if let Some(start) = released(&fixed, &initial, weights) {
            best = better(start, best);
        }
        best = better(led(&fixed, initial.clone(), weights), best);
        if !best.discrepancy.iter().any(|left| is_astray(&fixed, left)) {
            return Ok(best);
        }
        let reach = fixed.state_std_of(&best.estimate.nominal, &best.estimate.initial)?;
        for (run, state) in initial.iter().enumerate() {
            if is_astray(&fixed, &best.discrepancy[run]) {
                let alone = fixed.with_runs(vec![fixed.runs[run].clone()]);
                let beside = scattered(&alone, (state, &reach)).unwrap_or_default();
                let mut states = best.estimate.initial.clone();
                states[run] = best_from(&alone, beside, state, weights);
                best = better(Ok(states), best);
            }
        }
        return Ok(best);
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
    fit_with(&fixed, &whole, weights, true, None)
}

/// Gives effects what they have of each record's own, as [`fit_initial_states`] found it: those of the model file and after them those that
/// it was asked for, in their order.
pub fn take_own_values<'a>(effects: impl Iterator<Item = &'a mut Placed>, found: &Fit) {
    let own = effects.filter(|placed| !placed.own_places().is_empty());
    for (placed, found) in own.zip(&found.estimate.effects) {
        placed.of_record.clone_from(&found.of_record);
    }
}

/// Fits initial states from values that are about right, with everything else as given. What the outputs do not
/// show of a state stays as it is.
///
/// # Errors
/// [`EstimateError`] when the model cannot be propagated.
pub fn fit_initial_states_from(
    problem: &Problem,
    effects: &[Placed],
    initial: Vec<Vec<f64>>,
    weights: &FitOptions,
) -> Result<Fit, EstimateError> {
    let mut fixed = problem.with_runs(problem.runs.clone());
    fixed.given.extend(effects.iter().cloned());
    states_from(&fixed, initial, weights)
}

/// An initial state of one run that begins at the right place of every wave whose travel nothing else shows: the best of
/// fits from all over a period.
fn at_its_place(alone: &Problem, state: &[f64], weights: &FitOptions) -> Vec<f64> {
    let states = drift::places(alone, alone.given.iter(), state.to_vec());
    best_from(alone, states, state, weights)
}

/// The initial state of the only run that is best fitted from one of several; `state` where none can be simulated from.
fn best_from(
    alone: &Problem,
    states: Vec<Vec<f64>>,
    state: &[f64],
    weights: &FitOptions,
) -> Vec<f64> {
    let fits = states.into_iter();
    let fits = fits.filter_map(|state| states_from(alone, vec![state], weights).ok());
    let found = best_fit(fits).and_then(|fit| fit.estimate.initial.into_iter().next());
    found.unwrap_or_else(|| state.to_vec())
}

/// The fit with the least objective, the first of equals.
fn best_fit(fits: impl Iterator<Item = Fit>) -> Option<Fit> {
    fits.reduce(|best, fit| {
        if fit.objective < best.objective {
            fit
        } else {
            best
        }
    })
}

/// Whether motions that begin alike may part: then the objective of an initial state has many valleys.
#[must_use]
pub fn may_part(effects: &[Placed]) -> bool {
    let mut effects = effects.iter();
    effects.any(|placed| placed.effect.family() == Family::Force)
}

/// Initial states fitted without what can hold a member still: from rest, no small change of them moves it. `None`
/// where nothing can.
fn released(
    fixed: &Problem,
    initial: &[Vec<f64>],
    weights: &FitOptions,
) -> Option<Result<Vec<Vec<f64>>, EstimateError>> {
    let mut free = fixed.with_runs(fixed.runs.clone());
    free.given.retain(|placed| !placed.action().is_dry());
    (free.given.len() < fixed.given.len()).then(|| {
        let fit = states_from(&free, initial.to_vec(), weights)?;
        Ok(fit.estimate.initial)
    })
}

/// Parts of a record, from its beginning, that an initial state is fitted to one after the other, and the samples
/// of each at the least: over a short one, motions that begin nearly alike stay together.
const LEADS: [f64; 3] = [1.0 / 64.0, 1.0 / 16.0, 1.0 / 4.0];
const SHORTEST: usize = 32;

/// Initial states fitted to longer and longer parts of every record.
fn led(
    fixed: &Problem,
    initial: Vec<Vec<f64>>,
    weights: &FitOptions,
) -> Result<Vec<Vec<f64>>, EstimateError> {
    let mut led = Vec::with_capacity(initial.len());
    for (run, mut state) in fixed.runs.iter().zip(initial) {
        let parts = LEADS.map(|part| (part * run.len as f64) as usize);
        for len in parts.into_iter().filter(|len| *len >= SHORTEST) {
            let part = fixed.with_runs(vec![run.slice(0..len)]);
            let fit = states_from(&part, vec![state.clone()], weights)?;
            state = fit.estimate.initial.into_iter().next().unwrap_or(state);
        }
        led.push(state);
    }
    Ok(led)
}

fn states_from(
    fixed: &Problem,
    initial: Vec<Vec<f64>>,
    weights: &FitOptions,
) -> Result<Fit, EstimateError> {
    let start = Start {
        effects: vec![],
        nominal: vec![],
        initial,
    };
    fit_with(fixed, &start, weights, true, None)
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

/// Values of an effect of which a fit finds those of a record's own: from each quarter of a clock, since a sine has one best phase and
/// one worst.
fn turned(placed: &Placed) -> Vec<Vec<f64>> {
    let rest = from_rest(placed);
    let Some(clock) = placed.effect.clock() else {
        return placed.effect.own_starts(&rest.values);
    };
    let quarter = |quarter: i32| {
        let mut values = rest.values.clone();
        values[clock.phase] = f64::from(quarter) * FRAC_PI_2;
        values
    };
    (0..4).map(quarter).collect()
}

/// The best fit of one run from all that an effect may begin it with.
fn best_of(
    alone: &Problem,
    own: &[Placed],
    state: Vec<f64>,
    weights: &FitOptions,
) -> Result<Fit, EstimateError> {
    let mut starts: Vec<Vec<Placed>> = vec![own.iter().map(from_rest).collect()];
    for (e, placed) in own.iter().enumerate() {
        let begun = turned(placed);
        starts = starts
            .iter()
            .flat_map(|effects| {
                begun.iter().map(|values| {
                    let mut effects = effects.clone();
                    effects[e].values.clone_from(values);
                    effects
                })
            })
            .collect();
    }
    let states = drift::places(alone, alone.given.iter().chain(own), state.clone());
    let from = states
        .iter()
        .flat_map(|state| starts.iter().map(move |effects| (effects, state)));
    let fits = from.map(|(effects, state)| {
        let start = Start {
            effects: effects.clone(),
            nominal: vec![],
            initial: vec![state.clone()],
        };
        fit_with(alone, &start, weights, true, None)
    });
    let fits = fits.collect::<Result<Vec<Fit>, EstimateError>>()?;
    best_fit(fits.into_iter()).map_or_else(|| states_from(alone, vec![state], weights), Ok)
}

/// With the values that a record has of its own where they mean nothing.
fn from_rest(placed: &Placed) -> Placed {
    let mut rest = shared_only(placed);
    for place in placed.own_places() {
        rest.values[place] = placed.effect.parameters()[place].neutral.unwrap_or(0.0);
    }
    rest
}
