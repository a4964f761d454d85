//! Output-error least squares with unknown noise levels.
//!
//! ```text
//! J(θ) = ½ Σ_c ρ_c N_c ln(V_c(θ) + ε_c²) − Σ_i ln p(θ_i)                   (1)
//! V_c = Σ r_c² / N_c,   r_c = measured − predicted, channel c             (2)
//! w_c = ρ_c / (V_c + ε_c²)                                                (3)
//! (Jᵀ W J + P + λ diag) δ = Jᵀ W r + ∂ Σ ln p / ∂θ                        (4)
//! ```
//!
//! (1) is the likelihood with the noise variance of each channel concentrated out, ρ_c the share
//! of independent samples; the sum of (2) is over the samples that the effects say anything about
//! (`reach`); (4) its Gauss-Newton step, damped after Levenberg and Marquardt.
//! Entries at a physical bound that the step would push further out are held there.
//!
//! References: \[Ljung1999\], chapter 7; \[Nocedal2006\], section 10.3.

use simgap_simulate::LANES;

use crate::curvature::Curvature;
use crate::layout::{Freedom, Layout};
use crate::linearise::{Column, Linearised, Probe, complete, discrepancies_of, probe, reach};
use crate::normal::{damped_step, normal_equations, variances};
use crate::products::dot;
use crate::reach::Reach;
use crate::signals::Signals;
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
}

/// Two-sided 95 % point of the normal distribution.
pub const NORMAL_95: f64 = 1.959_964;
/// λ of (4) at the start, and how often it is raised before a step is given up.
const FIRST_DAMPING: f64 = 1e-4;
const MOST_DAMPINGS: usize = 8;
/// Factor on the squared discrepancy beyond which the sensitivities of a fit are no longer kept.
const STALE: f64 = 2.0;

/// Fits a set of effects, the nominal parameters under their prior, and the initial states.
///
/// # Errors
/// [`EstimateError`] when the model cannot be propagated from the start.
pub fn fit(problem: &Problem, start: &Start, weights: &FitOptions) -> Result<Fit, EstimateError> {
    fit_with(problem, start, weights, false, None)
}

/// Sensitivities that are known before a fit.
pub(crate) struct Known<'a> {
    /// The objective where they were taken.
    pub(crate) objective: f64,
    /// By layout, run and place.
    pub(crate) column: &'a dyn Fn(&Layout, usize, usize) -> Option<Column>,
}

/// As [`fit`], with sensitivities that are known already. Where a step with them does not come near the objective of
/// where they were taken, the next takes its own.
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
            let column = |place| (known.as_ref()?.column)(&layout, run, place);
            places.map(column).collect()
        })
        .collect();
    let unknown = |run: usize, place: usize| columns[run][place].is_none();
    let first = probe(problem, &layout, &theta, unknown)?;
    let (mut objective, _) = merit.of(&layout, &theta, &first.discrepancy);
    let mut at = complete(problem, &layout, &theta, first, |run, place| {
        columns[run][place].clone()
    })?;
    let stale = merit.of_a_factor(STALE);
    let fresh = |at: Linearised, theta: &[f64]| {
        // Those of the effects belong to their point always.
        let known = Probe::of_linearised(at, |place| !layout.is_nuisance(place));
        complete(problem, &layout, theta, known, |_, _| None)
    };
    let search = Line {
        layout: &layout,
        merit: &merit,
    };
    let along = |_: usize, place: usize| !(weights.keep_nuisance && layout.is_nuisance(place));
    let base = known.map_or(objective, |known| known.objective);
    if objective - base > stale {
        // So far from where they were taken, known sensitivities lead astray, or past what those of the start run into:
        // whichever step goes further.
        let own = fresh(at.clone(), &theta)?;
        let reached = |at: &Linearised| {
            let next = search.step(&theta, objective, at, &mut FIRST_DAMPING.clone(), along);
            next.map_or(objective, |next| next.objective)
        };
        if reached(&own) < reached(&at) {
            at = own;
        }
    }
    // Whether every sensitivity belongs to this point.
    let mut exact = !weights.keep_nuisance;
    // Objective where the kept sensitivities were taken, or that of a better start.
    let mut taken_at = objective.min(base);
    let mut damping = FIRST_DAMPING;
    let mut iterations = 0;
    while iterations < weights.most_steps {
        iterations += 1;
        let Some(next) = search.step(&theta, objective, &at, &mut damping, along) else {
            if exact {
                break;
            }
            // The kept sensitivities mislead: one more try with all of them fresh.
            at = fresh(at, &theta)?;
            (exact, damping, taken_at) = (true, FIRST_DAMPING, objective);
            continue;
        };
        let gain = objective - next.objective;
        (theta, objective) = (next.theta, next.objective);
        let is_far = (taken_at - objective).abs() > stale;
        if is_far {
            taken_at = objective;
        }
        let keep = weights.keep_nuisance && !is_far;
        let kept = at.columns;
        at = complete(problem, &layout, &theta, next.probe, |run, place| {
            (keep && layout.is_nuisance(place)).then(|| kept[run][place].clone())
        })?;
        if gain >= weights.converged {
            exact = !keep;
        } else if exact {
            break;
        } else {
            // A small gain along kept sensitivities does not say that there is no larger one.
            at = fresh(at, &theta)?;
            (exact, taken_at) = (true, objective);
        }
    }
    Ok(finish(&layout, &merit, &theta, at, iterations))
}

/// An accepted step.
struct Next {
    theta: Vec<f64>,
    objective: f64,
    probe: Probe,
}

/// Where steps are searched.
struct Line<'a> {
    layout: &'a Layout,
    merit: &'a Merit<'a>,
}

impl Line<'_> {
    /// One accepted step of (4), or `None` when no damping finds an improvement. The first trial is mostly
    /// taken: the sensitivities that the next step wants are simulated along with it.
    fn step(
        &self,
        theta: &[f64],
        objective: f64,
        at: &Linearised,
        damping: &mut f64,
        along: impl Fn(usize, usize) -> bool,
    ) -> Option<Next> {
        let layout = self.layout;
        let (_, variance) = self.merit.of(layout, theta, &at.discrepancy);
        let weights = self.merit.weights(&variance);
        let (hessian, gradient) = normal_equations(layout, theta, at, &weights);
        let free: Vec<usize> = (0..layout.len())
            .filter(|&i| {
                let outward = (theta[i] <= layout.lower[i] && gradient[i] < 0.0)
                    || (theta[i] >= layout.upper[i] && gradient[i] > 0.0);
                !outward
            })
            .collect();
        // One trial is mostly enough; where it is not, further ones cost little side by side.
        let together = (LANES / self.merit.problem.runs.len().max(1)).max(1);
        let mut tried = 0;
        while tried < MOST_DAMPINGS {
            let count = if tried == 0 { 1 } else { together };
            let count = count.min(MOST_DAMPINGS - tried);
            let mut trials: Vec<(f64, Vec<f64>)> = Vec::with_capacity(count);
            for _ in 0..count {
                if let Some(step) = damped_step(&hessian, &gradient, &free, *damping) {
                    let mut next: Vec<f64> = (0..theta.len())
                        .map(|i| theta[i] + step[i] * layout.scale[i])
                        .collect();
                    layout.make_physical(&mut next);
                    trials.push((*damping, next));
                }
                *damping *= 10.0;
            }
            let first = (tried == 0).then_some(&along);
            tried += count;
            if let Some((used, next)) = self.first_better(objective, trials, first) {
                *damping = (used * 0.1).max(1e-9);
                return Some(next);
            }
        }
        None
    }

    /// The first of several trials, in their order, that lowers the objective.
    fn first_better(
        &self,
        objective: f64,
        trials: Vec<(f64, Vec<f64>)>,
        along: Option<&impl Fn(usize, usize) -> bool>,
    ) -> Option<(f64, Next)> {
        let (problem, layout) = (self.merit.problem, self.layout);
        let (dampings, thetas): (Vec<f64>, Vec<Vec<f64>>) = trials.into_iter().unzip();
        let all: Vec<Result<Probe, EstimateError>> = match along {
            Some(along) => {
                let each = thetas.iter();
                each.map(|theta| probe(problem, layout, theta, along))
                    .collect()
            }
            None => discrepancies_of(problem, layout, &thetas)
                .into_iter()
                .map(|signals| Ok(Probe::new(layout, signals?)))
                .collect(),
        };
        for ((damping, theta), probe) in dampings.into_iter().zip(thetas).zip(all) {
            let Ok(probe) = probe else {
                continue;
            };
            let (value, _) = self.merit.of(layout, &theta, &probe.discrepancy);
            if value < objective {
                let next = Next {
                    theta,
                    objective: value,
                    probe,
                };
                return Some((damping, next));
            }
        }
        None
    }
}

fn finish(
    layout: &Layout,
    merit: &Merit<'_>,
    theta: &[f64],
    at: Linearised,
    iterations: usize,
) -> Fit {
    let (objective, variance) = merit.of(layout, theta, &at.discrepancy);
    let (hessian, _) = normal_equations(layout, theta, &at, &merit.weights(&variance));
    let all: Vec<usize> = (0..layout.len()).collect();
    let curvature = Curvature::of(layout, theta, &hessian);
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
        variance,
        intervals,
        nominal_intervals,
        misfit,
        curvature,
        discrepancy: at.discrepancy,
        iterations,
    }
}

/// The objective (1) and the weights (3).
pub(crate) struct Merit<'a> {
    problem: &'a Problem,
    effective_share: Vec<f64>,
    floor: Vec<f64>,
    /// Samples of all runs, and those of each channel that were filled.
    count: f64,
    filled: Vec<f64>,
}

impl<'a> Merit<'a> {
    pub(crate) fn new(problem: &'a Problem, weights: &FitOptions) -> Merit<'a> {
        let std = problem.output_std();
        Merit {
            problem,
            effective_share: weights.effective_share.clone(),
            floor: std
                .iter()
                .zip(&weights.floor)
                .map(|(s, floor)| (floor * s).powi(2).max(f64::MIN_POSITIVE))
                .collect(),
            count: problem.runs.iter().map(|run| run.len as f64).sum(),
            filled: (0..std.len()).map(|c| problem.filled_count(c)).collect(),
        }
    }

    /// What a factor on the squared discrepancy of every channel changes in J.
    pub(crate) fn of_a_factor(&self, factor: f64) -> f64 {
        0.5 * self.effective_share.iter().sum::<f64>() * self.count * factor.ln()
    }

    /// V_c, over the samples within reach.
    pub(crate) fn variance(&self, discrepancy: &[Signals], reach: &Reach) -> Vec<f64> {
        (0..self.floor.len())
            .map(|c| {
                let square = |run: &Signals| dot(&run[c], &run[c]);
                discrepancy.iter().map(square).sum::<f64>() / reach.count(c).max(1.0)
            })
            .collect()
    }

    /// J and V_c; J is infinite when a simulation ran away.
    pub(crate) fn of(
        &self,
        layout: &Layout,
        theta: &[f64],
        discrepancy: &[Signals],
    ) -> (f64, Vec<f64>) {
        let reach = reach(self.problem, layout, theta);
        let variance = self.variance(discrepancy, &reach);
        let fit: f64 = variance
            .iter()
            .zip(&self.floor)
            .zip(self.effective_share.iter().zip(&self.filled))
            .map(|((v, floor), (rho, filled))| 0.5 * rho * (self.count - filled) * (v + floor).ln())
            .sum();
        let value = fit + self.prior(layout, theta);
        (if value.is_nan() { f64::INFINITY } else { value }, variance)
    }

    /// The second sum of (1).
    pub(crate) fn prior(&self, layout: &Layout, theta: &[f64]) -> f64 {
        let entries = theta.iter().enumerate();
        entries
            .map(|(i, value)| layout.prior_at(i, *value)[0])
            .sum()
    }

    pub(crate) fn weights(&self, variance: &[f64]) -> Vec<f64> {
        let floor = self.floor.iter().zip(&self.effective_share);
        variance
            .iter()
            .zip(floor)
            .map(|(v, (floor, rho))| rho / (v + floor))
            .collect()
    }
}
