//! Output-error least squares with unknown noise levels.
//!
//! ```text
//! J(θ) = ½ Σ_c ρ_c N_c ∫ q_c(x) dx/x − Σ_i ln p(θ_i),   x to V_c(θ) + ε_c²   (1)
//! V_c = Σ r_c² / N_c,   r_c = measured − predicted, channel c             (2)
//! w_c = ρ_c q_c / (V_c + ε_c²),   q_c(x) = ζ + (1 − ζ) min(1, (σ_c² + ε_c²)/x),   ζ = α/(α + Σ ρ_c N_c)   (3)
//! (Jᵀ W J + P + λ diag) δ = Jᵀ W r + ∂ Σ ln p / ∂θ                        (4)
//! ```
//!
//! (1) is the likelihood with the noise variance of each channel concentrated out, ρ_c the share
//! of independent samples. Of what is left, noise σ² counts in full. What a model misses beyond it, of which samples are no independent
//! observations, counts as α of them at the most ([`Discrepancy`](crate::Discrepancy); q = 1 and ln(V + ε²) without one): the coarsened
//! likelihood of \[Miller2019\]. The sum of (2) is over the samples that the effects say anything about
//! (`reach`); (4) its Gauss-Newton step, damped after Levenberg and Marquardt.
//! Entries at a physical bound that the step would push further out are held there. How far a step goes is told in `step.rs`.
//!
//! References: \[Ljung1999\], chapter 7; \[Nocedal2006\], section 10.3.

use crate::curvature::Curvature;
use crate::gram::Gram;
use crate::layout::{Freedom, Layout};
use crate::linearise::{Column, Linearised, Probe, complete, probe};
use crate::merit::Merit;
use crate::normal::variances;
use crate::signals::Signals;
use crate::step::{LEAST_DAMPING, Line, Quadratic};
use crate::{EstimateError, FitOptions, Problem, Start};

/// A parameter value with its 95 % interval.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Interval {
    /// Estimate.
    pub value: f64,
    /// Lower and upper end; infinite where the data do not see the parameter.
    pub ci95: [f64; 2],
}

/// What the data say about one set of effects.
#[derive(Clone)]
pub struct Fit {
    /// Estimated effects, nominal parameters and initial states.
    pub estimate: Start,
    /// J of (1): lower is better; differences are in units of log-likelihood.
    pub objective: f64,
    /// Mean square discrepancy of each channel, V_c.
    pub variance: Vec<f64>,
    /// Intervals of the effects' parameters, effect by effect.
    pub intervals: Vec<Vec<Interval>>,
    /// Intervals of the nominal parameters, one after the other: what data and prior together say of them.
    pub nominal_intervals: Vec<Vec<Interval>>,
    /// The first sum of (1): minus the log-likelihood, but for a constant that all sets share.
    pub misfit: f64,
    /// How the data curve the log-likelihood at the estimate.
    pub curvature: Curvature,
    /// Discrepancies of each run and channel at the estimate.
    pub discrepancy: Vec<Signals>,
    /// Steps taken.
    pub iterations: usize,
    /// Whether no further step would have gained enough, so that it was not ended by the limit of steps.
    pub is_finished: bool,
}

/// Two-sided 95 % point of the normal distribution.
pub const NORMAL_95: f64 = 1.959_964;

/// Fits a set of effects, the nominal parameters under their prior, and the initial states.
///
/// # Errors
/// [`EstimateError`] when the model cannot be propagated from the start.
pub fn fit(problem: &Problem, start: &Start, weights: &FitOptions) -> Result<Fit, EstimateError> {
    fit_with(problem, start, weights, false, None)
}

/// What is known of sensitivities before a fit.
#[derive(Clone, Copy)]
pub(crate) struct Known<'a> {
    /// Them, by layout, run and place.
    pub(crate) column: &'a dyn Fn(&Layout, usize, usize) -> Option<Column>,
    /// Their products, run by run.
    pub(crate) grams: &'a [Gram],
}

/// As [`fit`], with sensitivities that are known already, as long as steps along them keep what they promise.
pub(crate) fn fit_with(
    problem: &Problem,
    start: &Start,
    weights: &FitOptions,
    shared_held: bool,
    known: Option<Known<'_>>,
) -> Result<Fit, EstimateError> {
    let freedom = Freedom {
        nominal_std: weights.nominal_std,
        shared_held,
    };
    let layout = Layout::new(start, problem, freedom);
    let merit = Merit::new(problem, weights);
    let mut theta = layout.pack(start);
    layout.make_physical(&mut theta);
    let columns: Vec<Vec<Option<Column>>> = (0..problem.runs.len())
        .map(|run| {
            let places = 0..layout.entries(run).count();
            let column = |place| (known?.column)(&layout, run, place);
            places.map(column).collect()
        })
        .collect();
    let unknown = |run: usize, place: usize| columns[run][place].is_none();
    let first = probe(problem, &layout, &theta, unknown)?;
    let (mut objective, _) = merit.of(&layout, &theta, &first.discrepancy);
    let mut at = complete(problem, &layout, &theta, first, |run, place| {
        columns[run][place].clone()
    })?;
    let fresh = |at: Linearised, theta: &[f64]| {
        // Those of the effects belong to their point always.
        let known = Probe::of_linearised(at, |place| !layout.is_nuisance(place));
        complete(problem, &layout, theta, known, |_, _| None)
    };
    let search = Line {
        layout: &layout,
        merit: &merit,
        known: known.map_or(&[], |known| known.grams),
    };
    let mut grams = vec![];
    let along = |_: usize, place: usize| !(weights.keep_nuisance && layout.is_nuisance(place));
    // Whether every sensitivity belongs to this point.
    let mut exact = known.is_none() && !weights.keep_nuisance;
    let mut damping = LEAST_DAMPING;
    let (mut iterations, mut is_finished) = (0, false);
    while !is_finished && iterations < weights.most_steps {
        let here = (theta.as_slice(), objective);
        let quadratic = search.quadratic(&theta, &at, &mut grams);
        let straight = search.straight(here, &quadratic, damping, along);
        let is_straight = matches!(straight, Some((_, true)));
        let (next, keep) = match straight {
            Some((next, true)) => (next, weights.keep_nuisance),
            _ if !exact => {
                // The kept sensitivities mislead: one more try with all of them fresh.
                at = fresh(at, &theta)?;
                exact = true;
                continue;
            }
            straight => {
                let held = || {
                    let held = quadratic.without_limits(&layout)?;
                    search.bent(here, (&held, &at), LEAST_DAMPING)
                };
                let bent = search.bent(here, (&quadratic, &at), damping).or_else(held);
                let straight = straight.map(|(next, _)| (next, damping));
                let all = bent.into_iter().chain(straight);
                let least = all.min_by(|a, b| a.0.objective.total_cmp(&b.0.objective));
                let Some((next, used)) = least else {
                    is_finished = true;
                    continue;
                };
                damping = used;
                (next, false)
            }
        };
        iterations += 1;
        damping = (0.1 * damping).max(LEAST_DAMPING);
        let gain = objective - next.objective;
        (theta, objective) = (next.theta, next.objective);
        let kept = at.columns;
        at = complete(problem, &layout, &theta, next.probe, |run, place| {
            (keep && layout.is_nuisance(place)).then(|| kept[run][place].clone())
        })?;
        // A straight step with much damping may gain little where much is to be gained.
        let least = weights.converged * merit.share(&quadratic.variance);
        let is_short = is_straight && quadratic.decrement() >= least;
        if gain >= least || (exact && is_short) {
            exact = !keep;
        } else if exact {
            is_finished = true;
        } else {
            // A small gain along kept sensitivities does not say that there is no larger one.
            at = fresh(at, &theta)?;
            exact = true;
        }
    }
    let last = search.quadratic(&theta, &at, &mut grams);
    let ended = (iterations, is_finished);
    Ok(finish(&search, (&theta, objective), (at, last), ended))
}

fn finish(
    Line { layout, merit, .. }: &Line<'_>,
    (theta, objective): (&[f64], f64),
    (at, last): (Linearised, Quadratic),
    (iterations, is_finished): (usize, bool),
) -> Fit {
    let all: Vec<usize> = (0..layout.len()).collect();
    let curvature = Curvature::of(layout, theta, &last.hessian);
    let spread = variances(&curvature.with_fixed_priors(), &all);
    let misfit = objective - merit.prior(layout, theta);
    let estimate = layout.unpack(theta);
    let interval = |entry: Option<usize>, value: f64| {
        let Some(entry) = entry else {
            return Interval {
                value,
                ci95: [f64::NEG_INFINITY, f64::INFINITY],
            };
        };
        let half = NORMAL_95 * layout.variance(entry, &spread).sqrt();
        Interval {
            value,
            ci95: [
                (value - half).max(layout.lower[entry]),
                (value + half).min(layout.upper[entry]),
            ],
        }
    };
    let effects = estimate.effects.iter().enumerate();
    let intervals = effects
        .map(|(e, placed)| {
            let values = placed.values.iter().enumerate();
            let of = |(i, &value)| interval(layout.entry(e, i), value);
            values.map(of).collect()
        })
        .collect();
    // They stand behind the shared values of the effects, in their order.
    let mut next = layout.effect_len()..;
    let nominal = estimate.nominal.iter();
    let nominal_intervals = nominal
        .map(|placed| {
            let values = placed.values.iter();
            values.map(|&value| interval(next.next(), value)).collect()
        })
        .collect();
    Fit {
        estimate,
        objective,
        variance: last.variance,
        intervals,
        nominal_intervals,
        misfit,
        curvature,
        discrepancy: at.discrepancy,
        iterations,
        is_finished,
    }
}
