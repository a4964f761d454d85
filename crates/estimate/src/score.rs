//! What a further effect would bring, without fitting it.
//!
//! At a fit with residual r and sensitivities J, the effect at a small size ε contributes columns
//! C. Projected past everything the fit may still adjust,
//!
//! ```text
//! S = CᵀWC − CᵀWJ H⁻¹ JᵀWC,   b = CᵀWr − CᵀWJ H⁻¹ g,   â = S⁻¹ b         (1)
//! gain = −½ Σ_c ρ_c N_c ln(1 − bᵀâ / rᵀWr)                               (2)
//! ```
//!
//! (1) is the score test of the effect, â the size the data ask for and the start of its fit.

use std::f64::consts::FRAC_PI_2;
use std::sync::Arc;

use faer::linalg::solvers::Solve;
use faer::{Mat, Side};
use simgap_effects::{Clock, Effect, Placed, SiteScale};
use simgap_simulate::{Job, predict_all};

use crate::fit::{Merit, fit_with, state_scale};
use crate::layout::{Freedom, Layout};
use crate::linearise::{Linearised, Signals, linearise};
use crate::normal::{inner, normal_equations};
use crate::reach::Reach;
use crate::{Candidate, EstimateError, Fit, Problem, Start, Weights};

/// Size of the trial effect as a share of its starting values: small enough to be linear.
const TRIAL: f64 = 0.02;
/// Shapes that are simulated in one batch: their columns are as long as the records.
pub(crate) const SHAPES_TOGETHER: usize = 8;
/// Columns that keep less than this of their energy past the nuisance are explained by it.
const HIDDEN: f64 = 1e-6;

/// A fit, linearised once for the score of many effects.
pub struct Base<'a> {
    pub(crate) problem: &'a Problem,
    pub(crate) fit: &'a Fit,
    pub(crate) layout: Layout,
    pub(crate) at: Linearised,
    reach: Reach,
    pub(crate) weights: Vec<f64>,
    pub(crate) hessian: Mat<f64>,
    pub(crate) gradient: Vec<f64>,
    pub(crate) independent_samples: f64,
    /// rᵀWr of (2).
    pub(crate) energy: f64,
}

/// What a further effect would bring.
#[derive(Clone)]
pub struct Score {
    /// Expected fall of the objective.
    pub gain: f64,
    /// Share of the weighted squared discrepancy it explains, bᵀâ / rᵀWr of (2).
    pub share: f64,
    /// The effect with the size the data ask for, inside its physical bounds.
    pub start: Placed,
}

/// Prepares the score of many effects at one fit.
///
/// # Errors
/// [`EstimateError`] when the model cannot be propagated.
pub fn linearise_at<'a>(
    problem: &'a Problem,
    fit: &'a Fit,
    weights: &Weights,
) -> Result<Base<'a>, EstimateError> {
    let freedom = Freedom {
        nominal_prior: weights.nominal_prior,
        shared_held: false,
    };
    let layout = Layout::new(&fit.estimate, &state_scale(problem), freedom);
    let theta = layout.pack(&fit.estimate);
    let at = linearise(problem, &layout, &theta)?;
    let merit = Merit::new(problem, weights);
    let reach = Reach::of(problem, &fit.estimate.effects);
    let channel_weights = merit.weights(&merit.variance(&at.discrepancy, &reach));
    let (hessian, gradient) = normal_equations(&layout, &theta, &at, &channel_weights);
    let count: f64 = problem.runs.iter().map(|run| run.len as f64).sum();
    let squared = |run: &Signals| inner(run, run, &channel_weights);
    let energy = at.discrepancy.iter().map(squared).sum();
    Ok(Base {
        energy,
        problem,
        fit,
        layout,
        at,
        reach,
        weights: channel_weights,
        hessian,
        gradient,
        independent_samples: count * weights.independence.iter().sum::<f64>(),
    })
}

/// Scores one candidate from each of its starting shapes, best first. Shapes that would need a
/// size outside the physical bounds are left out.
///
/// # Errors
/// [`EstimateError`] when the model cannot be propagated.
pub fn score(
    base: &Base<'_>,
    candidate: &Candidate,
    scale: &SiteScale,
) -> Result<Vec<Score>, EstimateError> {
    let shapes = candidate.effect.starts(scale);
    let mut scores = Vec::new();
    for few in shapes.chunks(SHAPES_TOGETHER) {
        let wanted: Vec<Vec<Trial>> = few.iter().map(|shape| trials(candidate, shape)).collect();
        let mut columns = base.columns(candidate, &wanted.concat())?.into_iter();
        for (shape, wanted) in few.iter().zip(wanted) {
            let own: Vec<Vec<Signals>> = columns.by_ref().take(wanted.len()).collect();
            scores.extend(base.score_shape(candidate, shape, own));
        }
    }
    scores.sort_by(|a: &Score, b: &Score| b.gain.total_cmp(&a.gain));
    Ok(scores)
}

/// An instance of a candidate, and the share of its starting values that it is.
pub(crate) type Trial = (Vec<f64>, f64);

/// How the instances of a shape are scored.
enum Way {
    /// By each size alone (places of the parameters): the prediction is linear in them.
    BySize(Vec<usize>),
    /// By the whole of what it does: it has no size to grow from (a limit).
    AsItStands,
    /// By a sine and a cosine.
    ByClock(Clock),
}

fn way(candidate: &Candidate, shape: &[f64]) -> Way {
    if let Some(clock) = candidate.effect.clock() {
        return Way::ByClock(clock);
    }
    let parameters = candidate.effect.parameters();
    // What a record has of its own is left to the fit.
    let sizes: Vec<usize> = (0..parameters.len())
        .filter(|&i| !parameters[i].per_record)
        .filter(|&i| parameters[i].neutral.is_some_and(f64::is_finite))
        .collect();
    let stepped = candidate.effect.action(shape).is_stepped();
    // A limit, or a map that moves in steps, does not grow in proportion to anything.
    let grows = candidate.effect.grows_in_proportion();
    if sizes.is_empty() || stepped || !grows {
        Way::AsItStands
    } else {
        Way::BySize(sizes)
    }
}

/// What has to be simulated to score a shape.
fn trials(candidate: &Candidate, shape: &[f64]) -> Vec<Trial> {
    match way(candidate, shape) {
        Way::BySize(sizes) => sizes
            .into_iter()
            .map(|k| (sized(candidate.effect, shape, Some(k), TRIAL), TRIAL))
            .collect(),
        Way::AsItStands => vec![(shape.to_vec(), 1.0)],
        Way::ByClock(clock) => [0.0, FRAC_PI_2]
            .map(|phase| {
                let mut values = shape.to_vec();
                values[clock.amplitude] *= TRIAL;
                values[clock.phase] = phase;
                (values, TRIAL)
            })
            .into(),
    }
}

/// The values of a shape with its k-th sized parameter at a share of its start and the other sized
/// parameters at the values where the effect vanishes; `None` for all sized parameters together.
pub(crate) fn sized(
    effect: &dyn Effect,
    shape: &[f64],
    only: Option<usize>,
    share: f64,
) -> Vec<f64> {
    let sized = effect.parameters().iter().zip(shape).enumerate();
    sized
        .map(|(i, (parameter, &value))| match parameter.neutral {
            // A limit of a shape stays where it is.
            Some(neutral) if !neutral.is_finite() || parameter.per_record => value,
            Some(neutral) if only.is_none_or(|k| k == i) => neutral + share * (value - neutral),
            Some(neutral) => neutral,
            None => value,
        })
        .collect()
}

impl Base<'_> {
    /// Fits a set that shares nominal parameters and initial states with the base, starting from
    /// the sensitivities known here.
    ///
    /// # Errors
    /// [`EstimateError`] when the model cannot be propagated from the start.
    pub fn fit(&self, start: &Start, weights: &Weights) -> Result<Fit, EstimateError> {
        fit_with(self.problem, start, weights, false, |layout, run, place| {
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
        })
    }

    /// Scores a shape from the columns of its trials.
    fn score_shape(
        &self,
        candidate: &Candidate,
        shape: &[f64],
        columns: Vec<Vec<Signals>>,
    ) -> Option<Score> {
        match way(candidate, shape) {
            Way::BySize(sizes) => self.score_sizes(candidate, shape, &sizes, &columns),
            Way::AsItStands => self.score_as_it_stands(candidate, shape, &columns),
            Way::ByClock(clock) => self.score_clock(candidate, shape, clock, columns),
        }
    }

    fn score_sizes(
        &self,
        candidate: &Candidate,
        shape: &[f64],
        sizes: &[usize],
        columns: &[Vec<Signals>],
    ) -> Option<Score> {
        let parameters = candidate.effect.parameters();
        let (amplitude, energy) = self.amplitudes(columns)?;
        let mut values = shape.to_vec();
        let mut absent = false;
        for (&k, a) in sizes.iter().zip(&amplitude) {
            let neutral = parameters[k].neutral.unwrap_or(0.0);
            let wanted = neutral + a * (shape[k] - neutral);
            values[k] = wanted.clamp(parameters[k].lower, parameters[k].upper);
            if values[k] == neutral || !wanted.is_finite() {
                absent = true;
            }
        }
        if absent && sizes.len() == 1 {
            return None;
        }
        candidate.effect.make_physical(&mut values);
        Some(self.scored(candidate, values, energy))
    }

    pub(crate) fn scored(&self, candidate: &Candidate, values: Vec<f64>, energy: f64) -> Score {
        let share = (energy / self.energy).clamp(0.0, 1.0 - 1e-9);
        Score {
            gain: -0.5 * self.independent_samples * (1.0 - share).ln(),
            share,
            start: Placed::new(candidate.effect, candidate.at.clone(), values),
        }
    }

    /// An effect without a size to grow from (a limit): scored by the whole of what it does.
    fn score_as_it_stands(
        &self,
        candidate: &Candidate,
        shape: &[f64],
        columns: &[Vec<Signals>],
    ) -> Option<Score> {
        match self.amplitudes(columns) {
            Some((amplitude, energy)) if amplitude[0] > 0.0 => {
                Some(self.scored(candidate, shape.to_vec(), energy))
            }
            _ => None,
        }
    }

    /// An effect with a clock: a sine and a cosine of its own for each run.
    fn score_clock(
        &self,
        candidate: &Candidate,
        shape: &[f64],
        clock: Clock,
        phases: Vec<Vec<Signals>>,
    ) -> Option<Score> {
        let runs = self.problem.runs.len();
        let mut columns = Vec::new();
        for together in phases {
            for run in 0..runs {
                let alone = together.iter().enumerate().map(|(r, signals)| {
                    let kept = |signal: &Vec<f64>| {
                        if r == run {
                            signal.clone()
                        } else {
                            vec![0.0; signal.len()]
                        }
                    };
                    signals.iter().map(kept).collect()
                });
                columns.push(alone.collect());
            }
        }
        let (parts, energy) = self.amplitudes(&columns)?;
        let size = |run: usize| parts[run].hypot(parts[runs + run]);
        let mean = ((0..runs).map(|r| size(r).powi(2)).sum::<f64>() / runs as f64).sqrt();
        let mut values = shape.to_vec();
        values[clock.amplitude] *= mean;
        if !values.iter().all(|value| value.is_finite()) || mean == 0.0 {
            return None;
        }
        let mut score = self.scored(candidate, values, energy);
        let own = score.start.own_places();
        score.start.of_record = (0..runs)
            .map(|run| {
                let phase = parts[runs + run].atan2(parts[run]);
                let value = |place: &usize| match *place {
                    place if place == clock.phase => phase,
                    place => shape[place],
                };
                own.iter().map(value).collect()
            })
            .collect();
        Some(score)
    }

    /// Change of the prediction of every run by each trial, divided by its share.
    pub(crate) fn columns(
        &self,
        candidate: &Candidate,
        trials: &[Trial],
    ) -> Result<Vec<Vec<Signals>>, EstimateError> {
        let estimate = &self.fit.estimate;
        let runs = self.problem.runs.len();
        let mut simulators = Vec::with_capacity(trials.len() * runs);
        for (values, _) in trials {
            let trial = Placed::new(candidate.effect, candidate.at.clone(), values.clone());
            let known = estimate.effects.iter().chain(&estimate.nominal);
            let effects: Vec<Placed> = known.chain([&trial]).cloned().collect();
            for run in 0..runs {
                simulators.push(self.problem.simulator(&effects, run)?);
            }
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
        let mut predicted = predict_all(&jobs).into_iter();
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
        for (c, signal) in predicted.iter_mut().enumerate() {
            let before = &self.at.discrepancy[run][c];
            match &self.problem.runs[run].measured[c] {
                Some(measured) => {
                    for (i, p) in signal.iter_mut().enumerate() {
                        *p = (*p - (measured[i] - before[i])) / share;
                    }
                }
                None => signal.fill(0.0),
            }
        }
        self.reach.keep(run, &mut predicted);
        predicted
    }

    /// Solves (1): amplitudes and the energy bᵀâ they explain.
    pub(crate) fn amplitudes(&self, columns: &[Vec<Signals>]) -> Option<(Vec<f64>, f64)> {
        let (k, len) = (columns.len(), self.layout.len());
        let mut cross = Mat::<f64>::zeros(len, k);
        let mut own = Mat::<f64>::zeros(k, k);
        let mut right = vec![0.0; k];
        for run in 0..self.at.discrepancy.len() {
            for (j, column) in columns.iter().enumerate() {
                right[j] += inner(&column[run], &self.at.discrepancy[run], &self.weights);
                for (row, nuisance) in self.layout.entries(run).zip(&self.at.columns[run]) {
                    cross[(row, j)] += inner(nuisance, &column[run], &self.weights);
                }
                for (i, other) in columns.iter().enumerate() {
                    own[(i, j)] += inner(&other[run], &column[run], &self.weights);
                }
            }
        }
        let projected = self.past_nuisance(&cross);
        let free = Mat::from_fn(k, k, |i, j| {
            let taken: f64 = (0..len).map(|l| cross[(l, i)] * projected[(l, j)]).sum();
            let value = own[(i, j)] - taken;
            if i == j { value * (1.0 + 1e-9) } else { value }
        });
        let seen = |i: usize| free[(i, i)] > HIDDEN * own[(i, i)];
        if !(0..k).all(seen) {
            return None;
        }
        let b: Vec<f64> = (0..k)
            .map(|j| {
                let taken: f64 = (0..len).map(|l| projected[(l, j)] * self.gradient[l]).sum();
                right[j] - taken
            })
            .collect();
        let solution = free
            .llt(Side::Lower)
            .ok()?
            .solve(Mat::from_fn(k, 1, |i, _| b[i]));
        let amplitude: Vec<f64> = (0..k).map(|i| solution[(i, 0)]).collect();
        let energy = amplitude.iter().zip(&b).map(|(a, b)| a * b).sum();
        Some((amplitude, energy))
    }

    /// H⁻¹ times columns of JᵀW.
    fn past_nuisance(&self, right: &Mat<f64>) -> Mat<f64> {
        let len = self.layout.len();
        if len == 0 {
            return Mat::zeros(0, right.ncols());
        }
        let ridged = Mat::from_fn(len, len, |i, j| {
            let value = self.hessian[(i, j)];
            if i == j {
                value * (1.0 + 1e-10) + f64::MIN_POSITIVE
            } else {
                value
            }
        });
        ridged.full_piv_lu().solve(right)
    }
}
