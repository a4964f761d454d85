//! The integrand of ln Z as the theory page states it, evaluated by simulation.
//!
//! ```text
//! ln L = −½ Σ_c n_c ∫ q_c(x) dx/x,   x up to V_c + ε_c²,   n_c = share_c · N         (1)
//! q_c(x) = ζ + (1 − ζ) min(1, s_c/x)                                      (2)
//! ```
//!
//! s_c is the variance of noise, the accuracy of the simulation with it; ζ is 1 where all that is left counts alike.
//! V_c is the mean square of measured minus predicted over the samples that count. The priors are those of the catalogue, of
//! the stated uncertainties, and for an initial state a normal one about zero that is as wide as the motion goes. Each
//! value is a rising function of a coordinate that is even over 0 to 1.

use std::f64::consts::TAU;
use std::ops::Range;

use faer::linalg::solvers::Solve;
use faer::{Mat, Side};
use simgap_effects::{Placed, SiteScale, most_beyond};
use simgap_estimate::{Coordinate, EstimateError, FitOptions, Owner, Problem, Start};
use simgap_inference::CandidateModel;
use simgap_simulate::{Job, predict_all};

use crate::prior::{Law, Marginal};

/// Where values are drawn from; initial states are drawn about their estimates in any case.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Draws {
    FromPrior,
    AboutEstimate,
}

/// The integrand of one set of effects.
pub(crate) struct Integrand<'a> {
    problem: &'a Problem,
    set: &'a CandidateModel,
    coordinates: Vec<(Owner, Marginal)>,
    scale_at: &'a dyn Fn(&Placed) -> SiteScale,
    /// n_c and ε_c² of (1).
    weight: Vec<f64>,
    floor: Vec<f64>,
    /// s_c and ζ of (2).
    noise: Vec<f64>,
    exponent: f64,
}

impl<'a> Integrand<'a> {
    pub(crate) fn new(
        problem: &'a Problem,
        options: &FitOptions,
        set: &'a CandidateModel,
        scale_at: &'a dyn Fn(&Placed) -> SiteScale,
        draws: Draws,
    ) -> Integrand<'a> {
        let coordinates = set.fit.curvature.coordinates.iter().zip(spread(set));
        let coordinates = coordinates
            .filter(|(coordinate, _)| !coordinate.is_held)
            .map(|(coordinate, spread)| {
                let law = law(coordinate, set, scale_at);
                // The prior of a state is hundreds of times as wide as what the data leave of it.
                let marginal = match draws == Draws::FromPrior && coordinate.owner != Owner::State {
                    true => Marginal::from_prior(law, coordinate.value),
                    false => Marginal::about(law, coordinate.value, spread),
                };
                (coordinate.owner, marginal)
            })
            .collect();
        let count: f64 = problem.runs.iter().map(|run| run.len as f64).sum();
        let std = problem.output_std();
        let weight: Vec<f64> = options
            .effective_share
            .iter()
            .map(|share| share * count)
            .collect();
        let (exponent, noise) = match &options.discrepancy {
            Some(discrepancy) => {
                let observations = discrepancy.observations;
                let exponent = observations / (observations + weight.iter().sum::<f64>());
                (exponent, discrepancy.noise.clone())
            }
            None => (1.0, vec![1.0; std.len()]),
        };
        let of_std = |shares: &[f64]| -> Vec<f64> {
            let channels = std.iter().zip(shares);
            channels.map(|(std, share)| (std * share).powi(2)).collect()
        };
        Integrand {
            problem,
            set,
            coordinates,
            scale_at,
            weight,
            floor: of_std(&options.floor),
            noise: of_std(&noise),
            exponent,
        }
    }

    pub(crate) fn dim(&self) -> usize {
        self.coordinates.len()
    }

    /// ln L π/q at points of the unit cube.
    pub(crate) fn log_likelihood(&self, points: &[Vec<f64>]) -> Vec<f64> {
        let starts: Vec<Option<Start>> = points.iter().map(|point| self.start(point)).collect();
        let values = self.of_starts(&starts).into_iter().zip(points);
        values
            .map(|(value, point)| value + self.log_weight(point))
            .collect()
    }

    /// ln L π at points in the coordinates u, on the side of the estimate where a size has two.
    pub(crate) fn log_joint(&self, points: &[Vec<f64>]) -> Vec<f64> {
        let at = |point: &Vec<f64>| -> (Vec<f64>, Vec<f64>) {
            let each = self.coordinates.iter().zip(point);
            each.map(|((_, marginal), u)| marginal.at(*u)).unzip()
        };
        let (values, log_densities): (Vec<_>, Vec<_>) = points.iter().map(at).unzip();
        let starts: Vec<Option<Start>> =
            values.iter().map(|values| self.start_at(values)).collect();
        let logs = self.of_starts(&starts).into_iter().zip(log_densities);
        logs.map(|(log, densities)| log + densities.iter().sum::<f64>())
            .collect()
    }

    /// û of every coordinate, H of the fit in these coordinates, and the precision of every prior.
    pub(crate) fn quadratic(&self) -> (Vec<f64>, Mat<f64>, Vec<f64>) {
        let curvature = &self.set.fit.curvature;
        let count = curvature.coordinates.len();
        let free: Vec<usize> = (0..count)
            .filter(|&i| !curvature.coordinates[i].is_held)
            .collect();
        let local = self
            .coordinates
            .iter()
            .map(|(_, marginal)| marginal.coordinate());
        let (centre, slopes): (Vec<f64>, Vec<f64>) = local.map(|[u, slope]| (u, slope)).unzip();
        let scales = free.iter().map(|&i| curvature.coordinates[i].scale);
        let per_u: Vec<f64> = scales
            .zip(slopes)
            .map(|(scale, slope)| 1.0 / (slope * scale))
            .collect();
        let hessian = Mat::from_fn(free.len(), free.len(), |i, j| {
            curvature.hessian[(free[i], free[j])] * per_u[i] * per_u[j]
        });
        let precision = self
            .coordinates
            .iter()
            .map(|(_, marginal)| marginal.std().powi(-2));
        (centre, hessian, precision.collect())
    }

    /// The estimate of every value.
    pub(crate) fn estimates(&self) -> Vec<f64> {
        let each = self.coordinates.iter();
        each.map(|(_, marginal)| marginal.estimate()).collect()
    }

    /// xᵀAx of other values; infinite on the other side of where a size vanishes.
    pub(crate) fn apart_from(&self, values: &[f64]) -> f64 {
        let (_, hessian, precision) = self.quadratic();
        let each = self.coordinates.iter().zip(values);
        let steps: Vec<f64> = each
            .map(|((_, marginal), value)| marginal.step_to(*value))
            .collect();
        let mut square = 0.0;
        for (i, a) in steps.iter().enumerate() {
            let row = steps.iter().enumerate().map(|(j, b)| hessian[(i, j)] * b);
            square += a * (row.sum::<f64>() + precision[i] * a);
        }
        square
    }

    /// δ of every coordinate that the data do not see and that is not where its prior would have it.
    pub(crate) fn unseen(&self) -> Vec<f64> {
        let (centre, hessian, _) = self.quadratic();
        let each = self
            .coordinates
            .iter()
            .enumerate()
            .filter(|(i, _)| hessian[(*i, *i)] == 0.0);
        each.map(|(i, (_, marginal))| marginal.apart(centre[i]))
            .collect()
    }

    /// Samples of the records, and those of them that V_c is the mean over.
    pub(crate) fn sample_counts(&self) -> (f64, f64) {
        let runs = self.problem.runs.iter().map(|run| run.len);
        let all: usize = runs.clone().sum();
        (
            all as f64,
            runs.map(|len| counted(len).len()).sum::<usize>() as f64,
        )
    }

    /// n of the only channel.
    pub(crate) fn effective_samples(&self) -> f64 {
        assert_eq!(self.weight.len(), 1, "one channel");
        self.weight[0]
    }

    fn log_weight(&self, point: &[f64]) -> f64 {
        let each = self.coordinates.iter().zip(point);
        each.map(|((_, marginal), below)| marginal.draw(*below).1)
            .sum()
    }

    /// ln L at the estimate of the fit.
    pub(crate) fn at_estimate(&self) -> f64 {
        self.of_starts(&[Some(self.set.fit.estimate.clone())])[0]
    }

    fn of_starts(&self, starts: &[Option<Start>]) -> Vec<f64> {
        let runs = 0..self.problem.runs.len();
        let simulators: Vec<Option<Vec<_>>> = starts
            .iter()
            .map(|start| {
                let placed: Vec<Placed> = start.as_ref()?.placed().cloned().collect();
                runs.clone()
                    .map(|run| self.problem.simulator(&placed, run).ok())
                    .collect()
            })
            .collect();
        let mut jobs = vec![];
        for (start, simulators) in starts.iter().zip(&simulators) {
            let (Some(start), Some(simulators)) = (start, simulators) else {
                continue;
            };
            jobs.extend(simulators.iter().enumerate().map(|(run, simulator)| Job {
                simulator,
                run: &self.problem.runs[run],
                initial: &start.initial[run],
                smooth: false,
            }));
        }
        let mut predicted = predict_all(&jobs).into_iter();
        let of_start = |simulators: &Option<Vec<_>>| match simulators {
            Some(simulators) => self.log_of(
                &predicted
                    .by_ref()
                    .take(simulators.len())
                    .collect::<Vec<_>>(),
            ),
            None => f64::NEG_INFINITY,
        };
        simulators.iter().map(of_start).collect()
    }

    /// (1), of what every run is predicted to show.
    fn log_of(&self, predicted: &[Result<Vec<Vec<f64>>, EstimateError>]) -> f64 {
        let of_channel = |c: usize| {
            let (mut squares, mut count) = (0.0, 0);
            for (run, predicted) in self.problem.runs.iter().zip(predicted) {
                let (Ok(predicted), Some(measured)) = (predicted, &run.measured[c]) else {
                    return f64::NEG_INFINITY;
                };
                let counted = counted(run.len);
                count += counted.len();
                let pairs = measured[counted.clone()].iter().zip(&predicted[c][counted]);
                squares += pairs.map(|(m, p)| (m - p).powi(2)).sum::<f64>();
            }
            let variance = squares / count as f64;
            let value = -0.5 * self.weight[c] * self.size(variance + self.floor[c], self.noise[c]);
            if value.is_nan() {
                f64::NEG_INFINITY
            } else {
                value
            }
        };
        (0..self.weight.len()).map(of_channel).sum()
    }

    /// The integral of (1) over ln x, by parts: noise up to s, and beyond it a discrepancy with what noise there is in it.
    fn size(&self, left: f64, noise: f64) -> f64 {
        if left <= noise {
            return left.ln();
        }
        let beyond = left / noise;
        noise.ln() + self.exponent * beyond.ln() + (1.0 - self.exponent) * (1.0 - 1.0 / beyond)
    }

    /// 1 − ζ of (2).
    pub(crate) fn coarsened(&self) -> f64 {
        1.0 - self.exponent
    }

    /// The values at a point of the unit cube; none where the prior has no density.
    fn start(&self, point: &[f64]) -> Option<Start> {
        let values = self
            .coordinates
            .iter()
            .zip(point)
            .map(|((_, marginal), below)| marginal.draw(*below).0);
        self.start_at(&values.collect::<Vec<_>>())
    }

    /// A start with these values; none where the prior has no density.
    fn start_at(&self, values: &[f64]) -> Option<Start> {
        let mut start = self.set.fit.estimate.clone();
        let mut shared = vec![];
        let mut of_run: Vec<f64> = vec![];
        for ((owner, _), &value) in self.coordinates.iter().zip(values) {
            match *owner {
                Owner::Effect(e, i) if start.effects[e].effect.parameters()[i].per_record => {
                    of_run.push(value)
                }
                Owner::Effect(e, i) => {
                    let parameter = &start.effects[e].effect.parameters()[i];
                    shared.push((parameter.lower..=parameter.upper).contains(&value));
                    start.effects[e].values[i] = value;
                }
                Owner::Nominal(n, i) => {
                    shared.push(value > 0.0);
                    start.nominal[n].values[i] = value;
                }
                Owner::State => of_run.push(value),
            }
        }
        // What a run has of its own: values of the effects, then its state.
        let mut next = of_run.into_iter();
        let runs = self.problem.runs.iter().zip(&mut start.initial);
        for (number, (run, state)) in runs.enumerate() {
            for placed in &mut start.effects {
                let clock = placed.effect.clock();
                for (own, place) in placed.own_places().into_iter().enumerate() {
                    let mut value = next.next()?;
                    // A phase is even whenever it is taken; in the middle of a run it is known best.
                    if let Some(clock) = clock.filter(|clock| clock.phase == place) {
                        value -= TAU * placed.values[clock.frequency] * run.middle_s();
                    }
                    placed.of_record[number][own] = value;
                    if number == 0 {
                        placed.values[place] = value;
                    }
                }
            }
            state
                .iter_mut()
                .for_each(|x| *x = next.next().unwrap_or(f64::NAN));
        }
        let has_support = |placed: &Placed| {
            let mut physical = placed.values.clone();
            placed.effect.make_physical(&mut physical);
            physical == placed.values
                && placed
                    .effect
                    .has_support(&placed.values, &(self.scale_at)(placed))
        };
        (shared.into_iter().all(|inside| inside) && start.effects.iter().all(has_support))
            .then_some(start)
    }
}

/// The samples of a run that count for every set ([`Problem::leaves_out_ends`]).
fn counted(len: usize) -> Range<usize> {
    most_beyond(len)..len - most_beyond(len)
}

/// Standard deviation of every coordinate by the curvature at the estimate, values of effects within about their size.
fn spread(set: &CandidateModel) -> Vec<f64> {
    let curvature = &set.fit.curvature;
    let mut information = curvature.hessian.clone();
    for (i, coordinate) in curvature.coordinates.iter().enumerate() {
        information[(i, i)] += match coordinate.owner {
            Owner::Nominal(..) | Owner::State => (coordinate.scale / coordinate.prior_std).powi(2),
            Owner::Effect(..) => 1.0,
        };
    }
    let len = information.nrows();
    let inverse = information
        .llt(Side::Lower)
        .unwrap()
        .solve(Mat::<f64>::identity(len, len));
    let each = curvature.coordinates.iter().enumerate();
    each.map(|(i, coordinate)| inverse[(i, i)].sqrt() * coordinate.scale)
        .collect()
}

fn law(
    coordinate: &Coordinate,
    set: &CandidateModel,
    scale_at: &dyn Fn(&Placed) -> SiteScale,
) -> Law {
    match coordinate.owner {
        Owner::State => Law::Normal {
            mean: 0.0,
            std: coordinate.prior_std,
        },
        Owner::Nominal(..) => Law::Normal {
            mean: 1.0,
            std: coordinate.prior_std,
        },
        Owner::Effect(e, i) => {
            let placed = &set.effects()[e];
            let prior = placed.effect.prior(i, &scale_at(placed));
            Law::OfEffect(prior, placed.effect.parameters()[i])
        }
    }
}
