//! Records in stretches, each of which begins anew: multiple shooting.
//!
//! Over a whole record a simulation that is a little off parts from the machine: the objective has a valley for
//! every lap that one is ahead of the other, and for every blow that one receives alone. In a stretch that begins
//! as it was measured both stay together for longer, and there are fewer valleys. What is found there is the start
//! of a fit to stretches four times as long, and so on to whole records; the stretches are tied together by the values they
//! share alone.
//!
//! Reference: \[Bock1983\].

use std::ops::Range;

use rayon::prelude::*;
use simgap_effects::Placed;
use simgap_estimate::{
    ASTRAY, EstimateError, Fit, FitOptions, Problem, Start, fit, fit_initial_states_from,
};
use simgap_model::Location;

/// Samples of the stretches that a fit begins with, at the least, and how many there are of a record at the most.
const SHORTEST: usize = 64;
const MOST_STRETCHES: usize = 40;
/// Stretches that become one where sets are fitted to longer ones.
const JOINED: usize = 4;
/// Steps of these fits: the valley is narrow.
const STEPS: usize = 80;

/// A set without effects fitted to whole records or, where these leave so much that the right valley may be another, to stretches of them
/// first, whichever leaves less.
///
/// # Errors
/// [`EstimateError`] when the model cannot be propagated from the start.
pub fn recalibrate(
    problem: &Problem,
    start: &Start,
    weights: &FitOptions,
) -> Result<Fit, EstimateError> {
    let whole = fit(problem, start, weights)?;
    let cut = Cut::of(problem);
    if cut.is_whole() || start.nominal.is_empty() || !may_be_astray(problem, &whole) {
        return Ok(whole);
    }
    let in_stretches = || {
        let begun = cut.begin(problem, &start.nominal, weights)?;
        fit(&cut.apply(problem), &begun.estimate, weights)
    };
    // Where stretches cannot be simulated, nothing is found in them.
    let Ok(fitted) = in_stretches() else {
        return Ok(whole);
    };
    let by_stretches = cut.lengthen(problem, fitted.estimate, weights);
    let better = by_stretches.filter(|fit| fit.objective < whole.objective);
    Ok(better.unwrap_or(whole))
}

/// Whether a fit may have ended in a valley beside the right one, in some channel.
fn may_be_astray(problem: &Problem, fit: &Fit) -> bool {
    let std = problem.output_std();
    let mut channels = fit.variance.iter().zip(&std);
    // A channel that does not move says nothing.
    channels.any(|(left, std)| *left > (ASTRAY * std).powi(2))
}

/// Sets fitted in as many steps as it takes. A start from which the plant runs away is no hypothesis.
pub(crate) fn fit_long(problem: &Problem, starts: &[Start], weights: &FitOptions) -> Vec<Fit> {
    let weights = FitOptions {
        most_steps: STEPS,
        ..weights.clone()
    };
    let fits = starts
        .par_iter()
        .filter_map(|start| fit(problem, start, &weights).ok());
    fits.collect()
}

/// The samples of every stretch of every record.
pub(crate) struct Cut(Vec<Vec<Range<usize>>>);

impl Cut {
    pub(crate) fn of(problem: &Problem) -> Cut {
        let most = if problem.may_cut() { MOST_STRETCHES } else { 1 };
        let runs = problem.runs.iter();
        Cut(runs.map(|run| bounds(run.len, SHORTEST, most)).collect())
    }

    pub(crate) fn is_whole(&self) -> bool {
        self.0.iter().all(|stretches| stretches.len() < 2)
    }

    /// The records of a problem in stretches.
    pub(crate) fn apply(&self, problem: &Problem) -> Problem {
        let runs = problem.runs.iter().zip(&self.0);
        let cut = runs.flat_map(|(run, stretches)| {
            let each = stretches.iter();
            each.map(|samples| run.slice(samples.clone()))
        });
        problem.with_runs(cut.collect())
    }

    /// Nominal parameters at given values, each stretch with the initial state that suits it.
    pub(crate) fn begin(
        &self,
        problem: &Problem,
        nominal: &[Placed],
        weights: &FitOptions,
    ) -> Result<Fit, EstimateError> {
        let cut = self.apply(problem);
        let initial = begin(&cut, self, nominal, weights)?;
        let mut begun = fit_initial_states_from(&cut, nominal, initial, weights)?;
        begun.estimate.nominal = nominal.to_vec();
        Ok(begun)
    }

    /// What was fitted to these stretches, fitted to longer ones and then to whole records.
    fn lengthen(self, problem: &Problem, found: Start, weights: &FitOptions) -> Option<Fit> {
        let mut cut = self;
        let mut found = cut.of_joined(&found);
        loop {
            cut = cut.joined();
            let fit = fit_long(&cut.apply(problem), &[found], weights).pop()?;
            if cut.is_whole() {
                return Some(fit);
            }
            found = cut.of_joined(&fit.estimate);
        }
    }

    /// With every few stretches of a record as one.
    pub(crate) fn joined(&self) -> Cut {
        let join = |few: &[Range<usize>]| few[0].start..few[few.len() - 1].end;
        let of_record =
            |stretches: &Vec<Range<usize>>| stretches.chunks(JOINED).map(join).collect();
        Cut(self.0.iter().map(of_record).collect())
    }

    /// What was fitted to stretches, as each of the joined ones begins.
    pub(crate) fn of_joined(&self, start: &Start) -> Start {
        let mut firsts = vec![];
        let mut next = 0;
        for stretches in &self.0 {
            firsts.extend((next..next + stretches.len()).step_by(JOINED));
            next += stretches.len();
        }
        let of_firsts = |list: &[Vec<f64>]| {
            firsts
                .iter()
                .filter_map(|k| list.get(*k).cloned())
                .collect()
        };
        let effects = start.effects.iter().map(|placed| Placed {
            of_record: of_firsts(&placed.of_record),
            ..placed.clone()
        });
        Start {
            effects: effects.collect(),
            nominal: start.nominal.clone(),
            initial: of_firsts(&start.initial),
        }
    }
}

/// Initial states of the stretches: each begins where the model left the one before, and is moved to where it was
/// measured. What the outputs do not show, like a position where velocities are measured, goes on.
fn begin(
    cut: &Problem,
    stretches: &Cut,
    nominal: &[Placed],
    weights: &FitOptions,
) -> Result<Vec<Vec<f64>>, EstimateError> {
    let guess = cut.initial_guess();
    let mut states: Vec<Vec<f64>> = Vec::with_capacity(cut.runs.len());
    for of_record in &stretches.0 {
        let mut next = None;
        for _ in of_record {
            let k = states.len();
            let alone = cut.with_runs(vec![cut.runs[k].clone()]);
            let from = next.unwrap_or_else(|| guess[k].clone());
            let fit = fit_initial_states_from(&alone, nominal, vec![from], weights)?;
            let state = fit.estimate.initial.into_iter().next().unwrap_or_default();
            next = Some(end(&alone, nominal, &state)?);
            states.push(state);
        }
    }
    Ok(states)
}

/// The state one step after the last sample of the only run.
fn end(alone: &Problem, nominal: &[Placed], initial: &[f64]) -> Result<Vec<f64>, EstimateError> {
    let simulator = alone.simulator(nominal, 0)?;
    let run = &alone.runs[0];
    let masses = alone.model.masses.iter();
    let ends = masses.map(|mass| {
        let path = simulator.path(run, initial, &Location::Mass(mass.name.clone()))?;
        let last = |values: &[f64]| values.last().copied().unwrap_or(0.0);
        let velocity = last(&path.velocity);
        Ok([
            last(&path.displacement) + run.time_step_s * velocity,
            velocity,
        ])
    });
    let ends = ends.collect::<Result<Vec<[f64; 2]>, EstimateError>>()?;
    let part = |i: usize| ends.iter().map(move |end| end[i]);
    Ok(part(0).chain(part(1)).collect())
}

/// The samples of each stretch of a record, of `shortest` or more and `most` stretches or fewer.
#[must_use]
pub fn bounds(len: usize, shortest: usize, most: usize) -> Vec<Range<usize>> {
    let count = (len / shortest).clamp(1, most);
    let bound = |k: usize| k * len / count;
    (0..count).map(|k| bound(k)..bound(k + 1)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn joined_stretches_begin_where_the_first_of_them_did() {
        let cut = Cut(vec![vec![0..2, 2..5, 5..6, 6..8, 8..9], vec![0..4, 4..7]]);
        let longer = cut.joined();
        assert_eq!(longer.0.concat(), [0..8, 8..9, 0..7]);
        assert!(!longer.is_whole() && longer.joined().is_whole());
        let start = Start {
            effects: vec![],
            nominal: vec![],
            initial: (0..7).map(|k| vec![f64::from(k)]).collect(),
        };
        assert_eq!(cut.of_joined(&start).initial, [[0.0], [4.0], [5.0]]);
    }
}
