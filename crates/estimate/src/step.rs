//! One step of a fit.
//!
//! ```text
//! θ + δ,          (H + λ diag H) δ = g                                      (1)
//! θ ⊕ (δ + ½ a),    (H + λ diag H) a = −Jᵀ W f″,    |a| < ⅜ |δ|             (2)
//! f″ = 2 (f(θ ⊕ h δ) − f(θ) − h J δ) / h²
//! θ ⊕ δ = θ e^(δ/θ) for sizes and factors, θ + δ for the rest
//! ```
//!
//! A straight step (1) is taken where it keeps what it promises. Where parameters take each other's place, the valley of the
//! objective is narrow and bent: straight steps leave it, or are so short that they go nowhere. A bent step (2) follows it to
//! second order, at the price of one more simulation; a step that bends more than that is not trusted and taken only where no other
//! lowers the objective. So a fit stays in the valley that it is in, whatever was rounded.
//!
//! A motion does not change where all forces and masses change in proportion: that valley is straight in the logarithms. A size that a step
//! takes through zero has none, and goes straight.
//!
//! Reference: \[Transtrum2012\].

use faer::Mat;
use simgap_simulate::LANES;

use crate::gram::{Gram, grams};
use crate::layout::Layout;
use crate::linearise::{Linearised, Probe, Together, discrepancies_of, probe, reach};
use crate::merit::Merit;
use crate::normal::{damped_step, normal_equations, projected};
use crate::signals::Signals;

/// The least λ, which a fit begins with: what neither data nor priors see is held by it.
pub(crate) const LEAST_DAMPING: f64 = 1e-9;
/// What λ is raised by until a bent step lowers J, and how often at the most: from the least up to steps that go nowhere.
const RAISED: f64 = 100.0;
const MOST_DAMPINGS: usize = 7;
/// Share of what a straight step promises that it has to gain.
const KEPT: f64 = 0.25;
/// h of (2), and the most that a step may bend, 2 |a| / |δ|.
const PART: f64 = 0.1;
const MOST_BENT: f64 = 0.75;

/// An accepted step.
pub(crate) struct Next {
    pub(crate) theta: Vec<f64>,
    pub(crate) objective: f64,
    pub(crate) probe: Probe,
}

/// J near a point, J − gᵀδ + ½ δᵀ H δ of a step δ.
#[derive(Clone)]
pub(crate) struct Quadratic {
    /// V_c at the point, and the weights that follow.
    pub(crate) variance: Vec<f64>,
    weights: Vec<f64>,
    pub(crate) hessian: Mat<f64>,
    gradient: Vec<f64>,
    /// Entries that are not held at a bound.
    free: Vec<usize>,
}

impl Quadratic {
    /// By how much a step lowers J, as far as J is quadratic.
    fn promised(&self, step: &[f64]) -> f64 {
        let curved = |i: usize| -> f64 {
            let row = step.iter().enumerate();
            row.map(|(j, b)| self.hessian[(i, j)] * b).sum()
        };
        let entries = step.iter().enumerate();
        entries
            .map(|(i, a)| a * (self.gradient[i] - 0.5 * curved(i)))
            .sum()
    }

    /// By how much the best step lowers J, as far as J is quadratic.
    pub(crate) fn decrement(&self) -> f64 {
        let step = self.solve(&self.gradient, LEAST_DAMPING);
        step.map_or(0.0, |step| self.promised(&step))
    }

    /// Without limits, each of which may stand at a kink: just where a sample touches it, it goes neither way.
    pub(crate) fn without_limits(&self, layout: &Layout) -> Option<Quadratic> {
        let mut free = self.free.clone();
        free.retain(|&i| !layout.is_limit[i]);
        (free.len() < self.free.len()).then(|| Quadratic {
            free,
            ..self.clone()
        })
    }

    fn solve(&self, right: &[f64], damping: f64) -> Option<Vec<f64>> {
        damped_step(&self.hessian, right, &self.free, damping)
    }

    /// The length of a step, in units of what the data see.
    fn length(&self, step: &[f64]) -> f64 {
        let entries = step.iter().enumerate();
        let square: f64 = entries.map(|(i, x)| x * x * self.hessian[(i, i)]).sum();
        square.sqrt()
    }
}

/// Where steps are searched.
pub(crate) struct Line<'a> {
    pub(crate) layout: &'a Layout,
    pub(crate) merit: &'a Merit<'a>,
    /// Products of sensitivities that are known before, run by run.
    pub(crate) known: &'a [Gram],
}

impl Line<'_> {
    /// J about a point. `last` are the products of the sensitivities of the point before, and of this one afterwards.
    pub(crate) fn quadratic(
        &self,
        theta: &[f64],
        at: &Linearised,
        last: &mut Vec<Gram>,
    ) -> Quadratic {
        let layout = self.layout;
        let (_, variance) = self.merit.of(layout, theta, &at.discrepancy);
        let weights = self.merit.weights(&variance);
        let effort = &self.merit.problem.effort;
        *last = grams(&at.columns, weights.len(), [last, self.known], effort);
        let (hessian, gradient) = normal_equations(layout, theta, at, last, &weights);
        let is_free = |i: &usize| {
            let outward = (theta[*i] <= layout.lower[*i] && gradient[*i] < 0.0)
                || (theta[*i] >= layout.upper[*i] && gradient[*i] > 0.0);
            !outward
        };
        Quadratic {
            free: (0..layout.len()).filter(is_free).collect(),
            variance,
            weights,
            hessian,
            gradient,
        }
    }

    /// The straight step where it lowers J, and whether it keeps what it promises. The sensitivities that the next step wants are
    /// simulated along with it.
    pub(crate) fn straight(
        &self,
        (theta, objective): (&[f64], f64),
        quadratic: &Quadratic,
        damping: f64,
        along: impl Fn(usize, usize) -> bool,
    ) -> Option<(Next, bool)> {
        let step = quadratic.solve(&quadratic.gradient, damping)?;
        let next = self.moved(theta, &step);
        let promised = quadratic.promised(&self.between(theta, &next));
        // A simulator of the user's has no lanes: what the next step wants waits until the point is taken.
        let has_lanes = !self.merit.problem.model.is_external();
        let along = |run, place| has_lanes && along(run, place);
        let probe = probe(self.merit.problem, self.layout, &next, along).ok()?;
        let next = self.judged(next, probe);
        let gain = objective - next.objective;
        (gain > 0.0).then_some((next, gain >= KEPT * promised))
    }

    /// The bent step that lowers J most, of the first few dampings with which one does, and the damping; steps that are trusted first.
    pub(crate) fn bent(
        &self,
        (theta, objective): (&[f64], f64),
        (quadratic, at): (&Quadratic, &Linearised),
        damping: f64,
    ) -> Option<(Next, f64)> {
        let problem = self.merit.problem;
        // Beside the point itself, for all lanes cost hardly more than one.
        let together = (LANES / problem.runs.len().max(1)).saturating_sub(1).max(1);
        let powers: Vec<usize> = (0..MOST_DAMPINGS).collect();
        powers.chunks(together).find_map(|powers| {
            let dampings = powers
                .iter()
                .map(|power| damping * RAISED.powi(*power as i32));
            let steps: Vec<Bent> = dampings
                .filter_map(|damping| {
                    let step = quadratic.solve(&quadratic.gradient, damping)?;
                    Some(Bent::new(self.layout, theta, step, damping))
                })
                .collect();
            let bent = self.bend(theta, (quadratic, at), &steps);
            let thetas: Vec<Vec<f64>> = bent.iter().map(|bent| bent.theta.clone()).collect();
            let all = discrepancies_of(problem, self.layout, &thetas, Together::Apart).into_iter();
            let tried = bent.into_iter().zip(all).filter_map(|(bent, signals)| {
                let next = self.judged(bent.theta, Probe::new(self.layout, signals.ok()?));
                (next.objective < objective).then_some((bent.is_trusted, next, bent.damping))
            });
            let best = tried.min_by(|a, b| {
                let trusted_first = b.0.cmp(&a.0);
                trusted_first.then(a.1.objective.total_cmp(&b.1.objective))
            });
            best.map(|(_, next, damping)| (next, damping))
        })
    }

    /// Where steps lead: bent as in (2), those that would bend too much as they are.
    fn bend(
        &self,
        theta: &[f64],
        (quadratic, at): (&Quadratic, &Linearised),
        steps: &[Bent],
    ) -> Vec<Trial> {
        let layout = self.layout;
        let near = steps
            .iter()
            .map(|bent| bent.along(layout, theta, &scaled(&bent.step, PART)));
        let thetas: Vec<Vec<f64>> = [theta.to_vec()].into_iter().chain(near).collect();
        let mut there =
            discrepancies_of(self.merit.problem, layout, &thetas, Together::NearTheFirst)
                .into_iter();
        let Some(Ok(here)) = there.next() else {
            return vec![];
        };
        let own_reach = reach(self.merit.problem, layout, theta);
        let bent = steps.iter().zip(thetas.iter().skip(1)).zip(there);
        bent.filter_map(|((bent, near), there)| {
            let mut second = there.ok()?;
            let near_reach = reach(self.merit.problem, layout, near);
            for (run, second) in second.iter_mut().enumerate() {
                self.second_derivative(run, (&here[run], at), &bent.step, second);
                own_reach.keep(run, second);
                near_reach.keep(run, second);
            }
            let pull = projected(layout, at, &second, &quadratic.weights);
            let bend = quadratic.solve(&scaled(&pull, -0.5), bent.damping)?;
            // This is half of a.
            let most = 0.25 * MOST_BENT * quadratic.length(&bent.step);
            let is_trusted = quadratic.length(&bend) < most;
            let mut whole = bent.step.clone();
            if is_trusted {
                whole.iter_mut().zip(&bend).for_each(|(d, a)| *d += a);
            }
            let mut next = bent.along(layout, theta, &whole);
            layout.make_physical(&mut next);
            Some(Trial {
                damping: bent.damping,
                theta: next,
                is_trusted,
            })
        })
        .collect()
    }

    /// f″ of (2) in a run, in the place of what is left at θ + h δ.
    fn second_derivative(
        &self,
        run: usize,
        (here, at): (&Signals, &Linearised),
        step: &[f64],
        there: &mut Signals,
    ) {
        let factor = 2.0 / (PART * PART);
        for (c, second) in there.iter_mut().enumerate() {
            for (second, here) in second.iter_mut().zip(&here[c]) {
                *second = factor * (here - *second);
            }
            for (place, entry) in self.layout.entries(run).enumerate() {
                let share = factor * PART * step[entry];
                let column = &at.columns[run][place][c];
                if share != 0.0 {
                    let each = second.iter_mut().zip(column);
                    each.for_each(|(second, column)| *second -= share * column);
                }
            }
        }
    }

    fn judged(&self, theta: Vec<f64>, probe: Probe) -> Next {
        let (objective, _) = self.merit.of(self.layout, &theta, &probe.discrepancy);
        Next {
            theta,
            objective,
            probe,
        }
    }

    /// A packed vector a straight step further, as far as that is physical.
    fn moved(&self, theta: &[f64], step: &[f64]) -> Vec<f64> {
        let entries = theta.iter().zip(step).zip(&self.layout.scale);
        let mut next: Vec<f64> = entries.map(|((x, step), scale)| x + step * scale).collect();
        self.layout.make_physical(&mut next);
        next
    }

    /// The straight step from one packed vector to another, in units of the scales.
    fn between(&self, from: &[f64], to: &[f64]) -> Vec<f64> {
        let entries = from.iter().zip(to).zip(&self.layout.scale);
        entries
            .map(|((from, to), scale)| (to - from) / scale)
            .collect()
    }
}

/// Where a step leads.
struct Trial {
    damping: f64,
    theta: Vec<f64>,
    /// Whether it is as much bent as it should be.
    is_trusted: bool,
}

/// A step that is to be bent.
struct Bent {
    damping: f64,
    /// δ, as far as that is physical.
    step: Vec<f64>,
    /// Which entries go along a straight line in the logarithm.
    is_multiplied: Vec<bool>,
}

impl Bent {
    fn new(layout: &Layout, theta: &[f64], step: Vec<f64>, damping: f64) -> Bent {
        let relative = |i: usize| step[i] * layout.scale[i] / theta[i];
        let goes_on = |i: usize| layout.is_size[i] && relative(i) > -1.0 && relative(i).is_finite();
        let mut bent = Bent {
            damping,
            is_multiplied: (0..theta.len()).map(goes_on).collect(),
            step,
        };
        let mut to = bent.along(layout, theta, &bent.step);
        layout.make_physical(&mut to);
        let entries = theta.iter().zip(&to).zip(&bent.is_multiplied);
        let physical = entries.map(|((from, to), is_multiplied)| match is_multiplied {
            true => from * (to / from).ln(),
            false => to - from,
        });
        let step: Vec<f64> = physical.zip(&layout.scale).map(|(by, s)| by / s).collect();
        if step.iter().all(|by| by.is_finite()) {
            bent.step = step;
        }
        bent
    }

    /// θ ⊕ δ of (2).
    fn along(&self, layout: &Layout, theta: &[f64], step: &[f64]) -> Vec<f64> {
        let by = step.iter().zip(&layout.scale).map(|(step, s)| step * s);
        let entries = theta.iter().zip(by).zip(&self.is_multiplied);
        entries
            .map(|((x, by), is_multiplied)| match is_multiplied {
                true => x * (by / x).exp(),
                false => x + by,
            })
            .collect()
    }
}

fn scaled(values: &[f64], factor: f64) -> Vec<f64> {
    values.iter().map(|value| factor * value).collect()
}
