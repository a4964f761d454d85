//! Residuals and their sensitivities at one point.

use rayon::prelude::*;
use simgap_simulate::{Job, LANES, Simulator, predict_all};

use crate::layout::Layout;
use crate::reach::Reach;
use crate::{EstimateError, Problem};

/// Relative size of a finite-difference step: the square root of the accuracy of a simulation
/// (1e-8 to 1e-10 with sticking friction), so that truncation and rounding errors balance.
const DIFFERENCE: f64 = 1e-4;

/// Signals of one run: one vector for each channel.
pub(crate) type Signals = Vec<Vec<f64>>;

/// Discrepancies (measured minus predicted) and the sensitivities of the predictions.
pub(crate) struct Linearised {
    /// For each run and channel, measured minus predicted.
    pub(crate) discrepancy: Vec<Signals>,
    /// For each run, for each shared entry of θ and then each entry of the run's own initial
    /// state, the derivative of the prediction by θ / scale.
    pub(crate) columns: Vec<Vec<Signals>>,
}

/// A run to be simulated with a packed vector.
struct Point<'a> {
    theta: Vec<f64>,
    run: usize,
    /// Without what moves in steps.
    smooth: bool,
    layout: &'a Layout,
}

impl Point<'_> {
    fn simulator(&self, problem: &Problem) -> Result<Simulator, EstimateError> {
        let start = self.layout.unpack(&self.theta);
        let effects: Vec<_> = start.effects.into_iter().chain(start.nominal).collect();
        problem.simulator(&effects, self.run)
    }
}

/// Measured minus predicted at every point, in as many batches as there are threads to march them.
fn simulate(problem: &Problem, points: &[Point<'_>]) -> Vec<Result<Signals, EstimateError>> {
    let share = points.len().div_ceil(rayon::current_num_threads().max(1));
    let batches = points.par_chunks(share.next_multiple_of(LANES).max(LANES));
    batches.flat_map_iter(|few| batch(problem, few)).collect()
}

/// Measured minus predicted at every point, in one batch.
fn batch(problem: &Problem, points: &[Point<'_>]) -> Vec<Result<Signals, EstimateError>> {
    let simulators: Vec<_> = points.iter().map(|p| p.simulator(problem)).collect();
    let ready = simulators
        .iter()
        .zip(points)
        .filter_map(|(simulator, point)| {
            Some(Job {
                simulator: simulator.as_ref().ok()?,
                run: &problem.runs[point.run],
                initial: point.layout.state(&point.theta, point.run),
                smooth: point.smooth,
            })
        });
    let mut predictions = predict_all(&ready.collect::<Vec<_>>()).into_iter();
    let mut results = Vec::with_capacity(points.len());
    for (simulator, point) in simulators.into_iter().zip(points) {
        let predicted = match simulator {
            Ok(_) => predictions.next().unwrap_or_else(|| Ok(vec![])),
            Err(error) => Err(error),
        };
        results.push(predicted.map(|p| subtract(&problem.runs[point.run].measured, p)));
    }
    results
}

/// Measured minus predicted, for every run and channel.
pub(crate) fn discrepancies(
    problem: &Problem,
    layout: &Layout,
    theta: &[f64],
) -> Result<Vec<Signals>, EstimateError> {
    let mut all = discrepancies_of(problem, layout, &[theta.to_vec()]);
    all.pop().unwrap_or_else(|| Ok(vec![]))
}

/// As [`discrepancies`], for several vectors at once.
pub(crate) fn discrepancies_of(
    problem: &Problem,
    layout: &Layout,
    thetas: &[Vec<f64>],
) -> Vec<Result<Vec<Signals>, EstimateError>> {
    let runs = problem.runs.len();
    let points: Vec<Point<'_>> = thetas
        .iter()
        .flat_map(|theta| {
            (0..runs).map(|run| Point {
                theta: theta.clone(),
                run,
                smooth: false,
                layout,
            })
        })
        .collect();
    let mut signals = simulate(problem, &points).into_iter();
    thetas
        .iter()
        .map(|theta| {
            let reach = reach(problem, layout, theta);
            let of_theta = signals.by_ref().take(runs).enumerate();
            let within = of_theta.map(|(run, signals)| {
                let mut signals = signals?;
                reach.keep(run, &mut signals);
                Ok(signals)
            });
            within.collect()
        })
        .collect()
}

/// The samples that the effects of a packed vector say anything about.
pub(crate) fn reach(problem: &Problem, layout: &Layout, theta: &[f64]) -> Reach {
    Reach::of(problem, &layout.unpack(theta).effects)
}

fn subtract(measured: &[Option<Vec<f64>>], mut predicted: Signals) -> Signals {
    for (signal, measured) in predicted.iter_mut().zip(measured) {
        match measured {
            Some(measured) => signal
                .iter_mut()
                .zip(measured)
                .for_each(|(p, m)| *p = m - *p),
            None => signal.fill(0.0),
        }
    }
    predicted
}

/// The size of the step that entry is differentiated with.
fn difference(layout: &Layout, theta: &[f64], entry: usize) -> f64 {
    let step = DIFFERENCE * layout.scale[entry];
    if theta[entry] + step > layout.upper[entry] {
        -step
    } else {
        step
    }
}

/// Discrepancies and all sensitivities at θ.
pub(crate) fn linearise(
    problem: &Problem,
    layout: &Layout,
    theta: &[f64],
) -> Result<Linearised, EstimateError> {
    let discrepancy = discrepancies(problem, layout, theta)?;
    let columns = vec![vec![]; problem.runs.len()];
    let known = Linearised {
        discrepancy,
        columns,
    };
    refresh(problem, layout, theta, known, |_, _| None)
}

/// Sensitivities at θ, where `known` holds its discrepancies and `stale` may hand over a column of
/// a run (run, place in the run's list) from another point instead of computing it.
///
/// All that is missing, of all runs, is simulated in one batch.
pub(crate) fn refresh(
    problem: &Problem,
    layout: &Layout,
    theta: &[f64],
    known: Linearised,
    mut stale: impl FnMut(usize, usize) -> Option<Signals>,
) -> Result<Linearised, EstimateError> {
    let discrepancy = known.discrepancy;
    let at = |theta: Vec<f64>, run: usize| Point {
        theta,
        run,
        smooth: true,
        layout,
    };
    let mut columns: Vec<Vec<Option<Signals>>> = Vec::with_capacity(discrepancy.len());
    let mut points = Vec::new();
    let mut stepped = Vec::new();
    for (run, own) in discrepancy.iter().enumerate() {
        let mut list = Vec::new();
        for (place, entry) in layout.entries(run).enumerate() {
            list.push(stale(run, place).or_else(|| {
                let zero = |signal: &Vec<f64>| vec![0.0; signal.len()];
                layout
                    .is_held(entry)
                    .then(|| own.iter().map(zero).collect())
            }));
            if list[place].is_none() {
                let mut moved = theta.to_vec();
                moved[entry] += difference(layout, theta, entry);
                points.push(at(moved, run));
            }
        }
        columns.push(list);
        let here = at(theta.to_vec(), run);
        stepped.push(here.simulator(problem)?.is_stepped());
    }
    // What moves in steps is left out at both ends of a difference.
    let bases = (0..stepped.len()).filter(|&run| stepped[run]);
    let mut smooth = simulate(
        problem,
        &bases.map(|run| at(theta.to_vec(), run)).collect::<Vec<_>>(),
    )
    .into_iter();
    let mut changes = simulate(problem, &points).into_iter();
    let mut all = Vec::with_capacity(columns.len());
    let reach = reach(problem, layout, theta);
    for (run, list) in columns.into_iter().enumerate() {
        let smooth = if stepped[run] {
            smooth.next().transpose()?
        } else {
            None
        };
        let own = smooth.as_ref().unwrap_or(&discrepancy[run]);
        let mut filled = Vec::with_capacity(list.len());
        for (column, entry) in list.into_iter().zip(layout.entries(run)) {
            filled.push(match column {
                Some(column) => column,
                None => {
                    let moved = changes.next().unwrap_or_else(|| Ok(vec![]))?;
                    let factor = layout.scale[entry] / difference(layout, theta, entry);
                    let mut column = derivative(moved, own, factor);
                    reach.keep(run, &mut column);
                    column
                }
            });
        }
        all.push(filled);
    }
    Ok(Linearised {
        discrepancy,
        columns: all,
    })
}

/// Change of the prediction between two discrepancies, times a factor.
fn derivative(mut moved: Signals, own: &Signals, factor: f64) -> Signals {
    for (signal, base) in moved.iter_mut().zip(own) {
        signal
            .iter_mut()
            .zip(base)
            .for_each(|(after, before)| *after = (before - *after) * factor);
    }
    moved
}
