//! A fit, linearised once for all that is tried on top of it.

use std::sync::Arc;

use faer::linalg::solvers::{PartialPivLu, Solve};
use faer::{Mat, Side};
use simgap_effects::Placed;
use simgap_simulate::{Job, Simulator};

use crate::fit::{Known, fit_with};
use crate::gram::{Gram, grams};
use crate::layout::{Freedom, Layout};
use crate::linearise::{Linearised, discrepancy, linearise};
use crate::merit::Merit;
use crate::normal::normal_equations;
use crate::products::{inner, inner_products};
use crate::reach::Reach;
use crate::signals::Signals;
use crate::{Candidate, EstimateError, Fit, FitOptions, Problem, Start};

/// Columns that keep less than this of their energy past the nuisance are explained by it: a trial is not small enough
/// to be linear beyond that.
const HIDDEN: f64 = 1e-6;
/// Down to this share it may still be a column of its own (an offset beside a large sag), where it explains more than
/// [`TELLS`]: rounding leaves less.
const NEARLY_HIDDEN: f64 = 1e-9;
/// bᵀâ that chance does not reach, twice the fall of the objective.
const TELLS: f64 = 12.0;

/// A fit, linearised once for the score of many effects.
pub struct Base<'a> {
    pub(crate) problem: &'a Problem,
    pub(crate) fit: &'a Fit,
    pub(crate) layout: Layout,
    pub(crate) at: Linearised,
    /// Products of its sensitivities, run by run.
    grams: Vec<Gram>,
    reach: Reach,
    /// Of each run; trials begin where these have settled.
    simulators: Vec<Arc<Simulator>>,
    pub(crate) weights: Vec<f64>,
    /// Of H; without where nothing may be adjusted.
    factor: Option<PartialPivLu<f64>>,
    pub(crate) gradient: Vec<f64>,
    /// Independent observations that what the fit leaves counts as.
    pub(crate) observations: f64,
    /// rᵀWr of (2) of [`score`](crate::score()).
    pub(crate) energy: f64,
}

/// An instance of a candidate, and the share of its starting values that it is.
pub(crate) type Trial = (Vec<f64>, f64);

/// Inner products of trials with the sensitivities of the base, with each other and with its discrepancy.
pub(crate) struct InCommon(Vec<OfRun>);

/// The same in one run.
struct OfRun {
    /// The parameter of each sensitivity.
    rows: Vec<usize>,
    /// Of each trial (row) with the sensitivities, the trials up to it, and the discrepancy.
    products: Mat<f64>,
}

/// A column of C in (1) of [`score`](crate::score()).
#[derive(Clone, Copy)]
pub(crate) struct Regressor {
    /// The trial it is the change of.
    pub(crate) trial: usize,
    /// The run in which alone it acts, if not in all.
    pub(crate) run: Option<usize>,
}

/// Columns past what the nuisance explains of them.
pub(crate) struct Past {
    /// Energy of each column before.
    own: Vec<f64>,
    /// S of (1) of [`score`](crate::score()).
    free: Mat<f64>,
    /// b of it.
    right: Vec<f64>,
}

impl Past {
    /// Amplitudes of some of the columns and the energy bᵀâ that they explain together; `None` where the nuisance explains one of them.
    pub(crate) fn amplitudes(&self, set: &[usize]) -> Option<(Vec<f64>, f64)> {
        let keeps = |share: f64| set.iter().all(|&i| self.kept(i) > share * self.own[i]);
        if !keeps(NEARLY_HIDDEN) {
            return None;
        }
        let free = Mat::from_fn(set.len(), set.len(), |i, j| match i == j {
            true => self.kept(set[i]),
            false => self.free[(set[i], set[j])],
        });
        let right = Mat::from_fn(set.len(), 1, |i, _| self.right[set[i]]);
        let solution = free.llt(Side::Lower).ok()?.solve(&right);
        let amplitude: Vec<f64> = (0..set.len()).map(|i| solution[(i, 0)]).collect();
        let energy = amplitude.iter().zip(set).map(|(a, &i)| a * self.right[i]);
        let energy = energy.sum();
        (keeps(HIDDEN) || energy > TELLS).then_some((amplitude, energy))
    }

    /// Energy that a column keeps, with a whisper on it: two that are alike can be solved for.
    fn kept(&self, i: usize) -> f64 {
        self.free[(i, i)] * (1.0 + 1e-9)
    }
}

/// The normal equations of a set at a fit of it.
pub(crate) struct LinearSystem {
    pub(crate) layout: Layout,
    pub(crate) at: Linearised,
    grams: Vec<Gram>,
    channel_weights: Vec<f64>,
    /// Independent observations that what is left counts as.
    observations: f64,
    pub(crate) hessian: Mat<f64>,
    gradient: Vec<f64>,
}

impl LinearSystem {
    pub(crate) fn at(
        problem: &Problem,
        fit: &Fit,
        weights: &FitOptions,
    ) -> Result<LinearSystem, EstimateError> {
        LinearSystem::of(problem, &fit.estimate, weights)
    }

    /// At values that need not be those of a fit.
    pub(crate) fn of(
        problem: &Problem,
        values: &Start,
        weights: &FitOptions,
    ) -> Result<LinearSystem, EstimateError> {
        let freedom = Freedom {
            nominal_std: weights.nominal_std,
            shared_held: false,
        };
        let layout = Layout::new(values, problem, freedom);
        let theta = layout.pack(values);
        let at = linearise(problem, &layout, &theta)?;
        let merit = Merit::new(problem, weights);
        let (_, variance) = merit.of(&layout, &theta, &at.discrepancy);
        let channel_weights = merit.weights(&variance);
        let grams = grams(&at.columns, variance.len(), [&[], &[]], &problem.effort);
        let (hessian, gradient) = normal_equations(&layout, &theta, &at, &grams, &channel_weights);
        Ok(LinearSystem {
            layout,
            at,
            grams,
            channel_weights,
            observations: merit.observations(&variance),
            hessian,
            gradient,
        })
    }
}

/// Prepares the score of many effects at one fit.
///
/// # Errors
/// [`EstimateError`] when the model cannot be propagated.
pub fn linearise_at<'a>(
    problem: &'a Problem,
    fit: &'a Fit,
    weights: &FitOptions,
) -> Result<Base<'a>, EstimateError> {
    let LinearSystem {
        layout,
        at,
        grams,
        channel_weights,
        observations,
        hessian,
        gradient,
    } = LinearSystem::at(problem, fit, weights)?;
    let squared = |run: &Signals| inner(run, run, &channel_weights);
    let energy = at.discrepancy.iter().map(squared).sum();
    let placed: Vec<Placed> = fit.estimate.placed().cloned().collect();
    Ok(Base {
        energy,
        problem,
        fit,
        layout,
        at,
        grams,
        reach: Reach::of(problem, &fit.estimate.effects),
        simulators: problem.simulators(&placed, &[])?,
        weights: channel_weights,
        factor: factorise(&hessian),
        gradient,
        observations,
    })
}

impl Base<'_> {
    /// Fits a set that shares nominal parameters and initial states with the base, starting from
    /// the sensitivities known here.
    ///
    /// # Errors
    /// [`EstimateError`] when the model cannot be propagated from the start.
    pub fn fit(&self, start: &Start, weights: &FitOptions) -> Result<Fit, EstimateError> {
        let column = |layout: &Layout, run: usize, place: usize| {
            if !layout.is_nuisance(place) {
                return None;
            }
            let shared = layout.shared_len();
            if place >= shared {
                // Initial states keep their order and scale.
                let state = place - shared - layout.own_len();
                let own = self.layout.shared_len() + self.layout.own_len() + state;
                return self.at.columns[run].get(own).cloned();
            }
            let (placed, value) = layout.shared().nth(place)?;
            let twin = self.layout.shared().position(|(p, v)| {
                v == value && p.effect.kind() == placed.effect.kind() && p.at == placed.at
            })?;
            let factor = layout.scale[place] / self.layout.scale[twin];
            let mut column = self.at.columns[run][twin].clone();
            if factor != 1.0 {
                let values = Arc::make_mut(&mut column).iter_mut().flatten();
                values.for_each(|x| *x *= factor);
            }
            Some(column)
        };
        let known = Known {
            column: &column,
            grams: &self.grams,
        };
        fit_with(self.problem, start, weights, false, Some(known))
    }

    /// Change of the prediction of every run by each trial, divided by its share; in the place of an effect of the set, if one is given.
    pub(crate) fn columns(
        &self,
        candidate: &Candidate,
        trials: &[Trial],
        in_place_of: Option<usize>,
    ) -> Result<Vec<Vec<Signals>>, EstimateError> {
        let estimate = &self.fit.estimate;
        let runs = self.problem.runs.len();
        let mut simulators = Vec::with_capacity(trials.len() * runs);
        let stay = estimate.placed().enumerate();
        let stay = stay.filter(|(i, _)| in_place_of != Some(*i));
        let stay: Vec<&Placed> = stay.map(|(_, placed)| placed).collect();
        for (values, _) in trials {
            let trial = Placed::new(candidate.effect, candidate.at.clone(), values.clone());
            let effects = stay.iter().copied().chain([&trial]);
            let effects: Vec<Placed> = effects.cloned().collect();
            simulators.extend(self.problem.simulators(&effects, &self.simulators)?);
        }
        let jobs: Vec<Job<'_>> = simulators
            .iter()
            .enumerate()
            .map(|(k, simulator)| Job {
                simulator,
                run: &self.problem.runs[k % runs],
                initial: &estimate.initial[k % runs],
                smooth: false,
            })
            .collect();
        let mut predicted = self.problem.predict_all(&jobs).into_iter();
        trials
            .iter()
            .map(|(_, share)| {
                let of_trial = predicted.by_ref().take(runs).enumerate();
                of_trial
                    .map(|(run, signals)| Ok(self.change(run, signals?, *share)))
                    .collect()
            })
            .collect()
    }

    /// Change of the prediction of a run, divided by the share.
    fn change(&self, run: usize, mut predicted: Signals, share: f64) -> Signals {
        let before = &self.at.discrepancy[run];
        if self.problem.is_whitened() {
            predicted = discrepancy(self.problem, run, predicted);
            for (signal, before) in predicted.iter_mut().zip(before) {
                let each = signal.iter_mut().zip(before);
                each.for_each(|(after, before)| *after = (before - *after) / share);
            }
        } else {
            // Without a filter, rounded less than by way of another discrepancy.
            let measured = &self.problem.runs[run].measured;
            for ((signal, measured), before) in predicted.iter_mut().zip(measured).zip(before) {
                let Some(measured) = measured else {
                    signal.fill(0.0);
                    continue;
                };
                let each = signal.iter_mut().zip(measured).zip(before);
                each.for_each(|((p, m), before)| *p = (*p - (m - before)) / share);
            }
        }
        self.reach.keep(run, &mut predicted);
        predicted
    }

    /// What trials have in common with the base and with each other: all at once, as the sensitivities of the base are
    /// larger than any cache.
    pub(crate) fn in_common(&self, trials: &[Vec<Signals>]) -> InCommon {
        let of_run = |run: usize| {
            let trials: Vec<&Signals> = trials.iter().map(|trial| &trial[run]).collect();
            let nuisance = self.at.columns[run].iter().map(AsRef::as_ref);
            let rows: Vec<usize> = self.layout.entries(run).take(nuisance.len()).collect();
            let others: Vec<&Signals> = nuisance
                .chain(trials.iter().copied())
                .chain([&self.at.discrepancy[run]])
                .collect();
            let (first, last) = (rows.len(), rows.len() + trials.len());
            let is_wanted = |j: usize, other: usize| other <= first + j || other == last;
            let products = inner_products(&trials, &others, &self.weights, is_wanted);
            OfRun { rows, products }
        };
        InCommon((0..self.at.discrepancy.len()).map(of_run).collect())
    }

    /// Solves (1) of [`score`](crate::score()): amplitudes and the energy bᵀâ they explain.
    pub(crate) fn amplitudes(
        &self,
        in_common: &InCommon,
        columns: &[Regressor],
    ) -> Option<(Vec<f64>, f64)> {
        let all: Vec<usize> = (0..columns.len()).collect();
        self.past(in_common, columns).amplitudes(&all)
    }

    /// What columns keep past the nuisance: solved for once, for all sets of some of them.
    pub(crate) fn past(&self, in_common: &InCommon, columns: &[Regressor]) -> Past {
        let (k, len) = (columns.len(), self.layout.len());
        let mut cross = Mat::<f64>::zeros(len, k);
        let mut own = Mat::<f64>::zeros(k, k);
        let mut right = vec![0.0; k];
        for (run, OfRun { rows, products }) in in_common.0.iter().enumerate() {
            let (first, last) = (rows.len(), products.ncols() - 1);
            let acts = |column: &Regressor| column.run.is_none_or(|only| only == run);
            let acting = columns
                .iter()
                .enumerate()
                .filter(|(_, column)| acts(column));
            for (j, &Regressor { trial, .. }) in acting.clone() {
                right[j] += products[(trial, last)];
                for (place, &row) in rows.iter().enumerate() {
                    cross[(row, j)] += products[(trial, place)];
                }
                for (i, &Regressor { trial: other, .. }) in acting.clone() {
                    own[(i, j)] += products[(trial.max(other), first + trial.min(other))];
                }
            }
        }
        let projected = self.past_nuisance(&cross);
        let free = &own - cross.transpose() * &projected;
        for (j, right) in right.iter_mut().enumerate() {
            *right -= (0..len)
                .map(|l| projected[(l, j)] * self.gradient[l])
                .sum::<f64>();
        }
        Past {
            own: (0..k).map(|i| own[(i, i)]).collect(),
            free,
            right,
        }
    }

    /// H⁻¹ times columns of JᵀW.
    fn past_nuisance(&self, right: &Mat<f64>) -> Mat<f64> {
        match &self.factor {
            Some(factor) => factor.solve(right),
            None => Mat::zeros(0, right.ncols()),
        }
    }
}

/// Of H with a whisper on its diagonal: what the data do not see must not end in a division by zero. (The full pivoting of
/// faer 0.24 takes a wrong pivot in blocks of zeros, as they stand between the records, and returns no numbers.)
fn factorise(hessian: &Mat<f64>) -> Option<PartialPivLu<f64>> {
    let len = hessian.nrows();
    let ridged = Mat::from_fn(len, len, |i, j| {
        let value = hessian[(i, j)];
        if i == j {
            value * (1.0 + 1e-10) + f64::MIN_POSITIVE
        } else {
            value
        }
    });
    (len > 0).then(|| ridged.partial_piv_lu())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What the initial states of two records leave of each other: nothing.
    #[test]
    fn verify_a_hessian_of_records_apart_is_factorised() {
        let block = [
            [13451.0, 12750.0, -20.0, -29.5],
            [12750.0, 17210.0, 86.8, 135.5],
            [-20.0, 86.8, 871.3, 994.6],
            [-29.5, 135.5, 994.6, 1220.8],
        ];
        let hessian = Mat::from_fn(8, 8, |i, j| match (i / 4, j / 4) {
            (0, 0) => block[i][j],
            (1, 1) => 0.8 * block[i - 4][j - 4],
            _ => 0.0,
        });
        let right = Mat::from_fn(8, 1, |i, _| 1.0 + i as f64);
        let found = factorise(&hessian).map(|factor| factor.solve(&right));
        let back = found.map(|found| &hessian * found);
        for i in 0..8 {
            let given = back.as_ref().map_or(f64::NAN, |back| back[(i, 0)]);
            assert!((given - right[(i, 0)]).abs() < 1e-6, "{given}");
        }
    }

    #[test]
    fn what_no_record_sees_stays_where_it_is() {
        let hessian = Mat::from_fn(3, 3, |i, j| if i == j && i != 1 { 4.0 } else { 0.0 });
        let right = Mat::from_fn(3, 1, |i, _| if i == 1 { 0.0 } else { 8.0 });
        let found = factorise(&hessian).map(|factor| factor.solve(&right));
        let values: Option<Vec<f64>> = found.map(|x| (0..3).map(|i| x[(i, 0)]).collect());
        assert!(values.is_some_and(|x| x[1] == 0.0 && (x[0] - 2.0).abs() < 1e-9));
    }
}
