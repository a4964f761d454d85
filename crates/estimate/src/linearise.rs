//! Residuals and their sensitivities at one point.

use std::sync::Arc;

use rayon::prelude::*;
use simgap_simulate::{Job, LANES};

use crate::layout::Layout;
use crate::points::{Point, Simulators};
use crate::reach::Reach;
use crate::signals::Signals;
use crate::{EstimateError, Problem};

/// Relative size of a finite-difference step. A difference to one side is off by half of it times the curvature, 5e-4
/// for a stiffness at 1e-4: where parameters nearly stand in for each other, steps along sensitivities so far off go
/// nowhere. Rounding takes as little as 1e-7 of it, and with sticking friction not more.
const DIFFERENCE: f64 = 1e-6;

/// The same for a simulator of the user's, whose solver has a tolerance of its own.
const DIFFERENCE_OUTSIDE: f64 = 1e-4;

/// The sensitivity of the signals of one run to one entry of θ; as long as the record, and shared by all
/// fits that start at one point.
pub(crate) type Column = Arc<Signals>;

/// Discrepancies (measured minus predicted) and the sensitivities of the predictions.
#[derive(Clone)]
pub(crate) struct Linearised {
    /// For each run and channel, measured minus predicted.
    pub(crate) discrepancy: Vec<Signals>,
    /// For each run, for each shared entry of θ and then each entry of the run's own initial
    /// state, the derivative of the prediction by θ / scale.
    pub(crate) columns: Vec<Vec<Column>>,
}

/// Measured minus predicted at every point, in as many batches as there are threads to march them.
fn simulate(problem: &Problem, points: &[Point]) -> Vec<Result<Signals, EstimateError>> {
    let share = points.len().div_ceil(rayon::current_num_threads().max(1));
    let batches = points.par_chunks(share.next_multiple_of(LANES).max(LANES));
    batches.flat_map_iter(|few| batch(problem, few)).collect()
}

/// Measured minus predicted at every point, in one batch.
fn batch(problem: &Problem, points: &[Point]) -> Vec<Result<Signals, EstimateError>> {
    let jobs = points.iter().map(|point| Job {
        simulator: &point.simulator,
        run: &problem.runs[point.run],
        initial: &point.initial,
        smooth: point.smooth,
    });
    let predictions = problem.predict_all(&jobs.collect::<Vec<_>>());
    let subtracted = predictions
        .into_iter()
        .zip(points)
        .map(|(predicted, point)| Ok(discrepancy(problem, point.run, predicted?)));
    subtracted.collect()
}

/// How vectors are simulated together.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Together {
    /// Each by itself.
    Apart,
    /// Near the first of them, without what moves in steps.
    NearTheFirst,
}

/// Measured minus predicted, for every run and channel, at several vectors at once.
pub(crate) fn discrepancies_of(
    problem: &Problem,
    layout: &Layout,
    thetas: &[Vec<f64>],
    together: Together,
) -> Vec<Result<Vec<Signals>, EstimateError>> {
    let mut simulators = Simulators::new(problem, layout);
    let mut ready = vec![];
    let mut points = vec![];
    let is_near = together == Together::NearTheFirst;
    for theta in thetas {
        let of_theta = (0..problem.runs.len()).map(|run| {
            let first = match (is_near, thetas.first()) {
                (true, Some(first)) => Some(simulators.of(first, run, None)?),
                _ => None,
            };
            simulators.point(theta, run, is_near, first.as_ref())
        });
        let of_theta: Result<Vec<Point>, EstimateError> = of_theta.collect();
        ready.push(of_theta.map(|of_theta| points.extend(of_theta)));
    }
    let mut signals = simulate(problem, &points).into_iter();
    let of_theta = |(theta, ready): (&Vec<f64>, Result<(), EstimateError>)| {
        ready?;
        let reach = reach(problem, layout, theta);
        let runs = signals.by_ref().take(problem.runs.len()).enumerate();
        // All are taken, whatever happened to one.
        let runs: Vec<_> = runs.collect();
        let within = runs.into_iter().map(|(run, signals)| {
            let mut signals = signals?;
            reach.keep(run, &mut signals);
            Ok(signals)
        });
        within.collect()
    };
    thetas.iter().zip(ready).map(of_theta).collect()
}

/// The samples that the effects of a packed vector say anything about.
pub(crate) fn reach(problem: &Problem, layout: &Layout, theta: &[f64]) -> Reach {
    Reach::of(problem, &layout.unpack(theta).effects)
}

/// Measured minus predicted in a run, filtered.
pub(crate) fn discrepancy(problem: &Problem, run: usize, mut predicted: Signals) -> Signals {
    let measured = &problem.runs[run].measured;
    for (signal, measured) in predicted.iter_mut().zip(measured) {
        match measured {
            Some(measured) => signal
                .iter_mut()
                .zip(measured)
                .for_each(|(p, m)| *p = m - *p),
            None => signal.fill(0.0),
        }
    }
    problem.whiten(run, &mut predicted);
    predicted
}

/// The size of the step that entry is differentiated with.
fn difference(problem: &Problem, layout: &Layout, theta: &[f64], entry: usize) -> f64 {
    let outside = problem.model.is_external();
    let step = [DIFFERENCE, DIFFERENCE_OUTSIDE][usize::from(outside)] * layout.scale[entry];
    if theta[entry] + step > layout.upper[entry] {
        -step
    } else {
        step
    }
}

/// A point as far as it has been simulated.
pub(crate) struct Probe {
    /// For each run and channel, measured minus predicted.
    pub(crate) discrepancy: Vec<Signals>,
    /// For each run, the sensitivities as in [`Linearised`], where they are known.
    pub(crate) columns: Vec<Vec<Option<Result<Column, EstimateError>>>>,
}

impl Probe {
    /// Discrepancies alone.
    pub(crate) fn new(layout: &Layout, discrepancy: Vec<Signals>) -> Probe {
        let nothing = |run| layout.entries(run).map(|_| None).collect();
        Probe {
            columns: (0..discrepancy.len()).map(nothing).collect(),
            discrepancy,
        }
    }

    /// What is known of a linearised point, but for the sensitivities at the places that are not kept.
    pub(crate) fn of_linearised(at: Linearised, keeps: impl Fn(usize) -> bool) -> Probe {
        let kept = |(place, column)| keeps(place).then_some(Ok(column));
        Probe {
            discrepancy: at.discrepancy,
            columns: at
                .columns
                .into_iter()
                .map(|list| list.into_iter().enumerate().map(kept).collect())
                .collect(),
        }
    }
}

/// What is simulated of one run at a point.
#[derive(Clone, Copy)]
enum Part {
    /// The run as it is.
    Whole,
    /// Without what moves in steps: the other end of differences that leave it out too.
    Smooth,
    /// With an entry of θ moved: by place in the run's list, and by number.
    Moved(usize, usize),
}

/// Discrepancies at θ and the sensitivities that `wants` names by run and place, in one batch: for all its
/// lanes it takes hardly longer than for one.
///
/// # Errors
/// When a run cannot be simulated at θ itself; of a sensitivity the error is kept beside it.
pub(crate) fn probe(
    problem: &Problem,
    layout: &Layout,
    theta: &[f64],
    wants: impl Fn(usize, usize) -> bool,
) -> Result<Probe, EstimateError> {
    probe_from(problem, layout, theta, None, wants)
}

fn probe_from(
    problem: &Problem,
    layout: &Layout,
    theta: &[f64],
    known: Option<Probe>,
    wants: impl Fn(usize, usize) -> bool,
) -> Result<Probe, EstimateError> {
    let mut simulators = Simulators::new(problem, layout);
    let mut parts: Vec<(usize, Part)> = vec![];
    let mut points = vec![];
    let mut moved = vec![];
    let mut next = theta.to_vec();
    for run in 0..problem.runs.len() {
        let entries = layout.entries(run).enumerate();
        let wanted: Vec<(usize, usize)> = entries
            .filter(|&(place, entry)| !layout.is_held(entry) && wants(run, place))
            .collect();
        let whole = simulators.point(theta, run, false, None)?;
        let here = Arc::clone(&whole.simulator);
        // What moves in steps is left out at both ends of a difference.
        if !wanted.is_empty() && whole.simulator.is_stepped() {
            parts.push((run, Part::Smooth));
            points.push(simulators.point(theta, run, true, None)?);
        }
        if known.is_none() {
            parts.push((run, Part::Whole));
            points.push(whole);
        }
        for (place, entry) in wanted {
            next[entry] += difference(problem, layout, theta, entry);
            match simulators.point(&next, run, true, Some(&here)) {
                Ok(point) => {
                    parts.push((run, Part::Moved(place, entry)));
                    points.push(point);
                }
                Err(error) => moved.push((run, place, entry, Err(error))),
            }
            next[entry] = theta[entry];
        }
    }
    let mut whole = vec![];
    let mut smooth: Vec<Option<Signals>> = problem.runs.iter().map(|_| None).collect();
    let reach = reach(problem, layout, theta);
    for ((run, part), signals) in parts.into_iter().zip(simulate(problem, &points)) {
        match part {
            Part::Whole => {
                let mut signals = signals?;
                reach.keep(run, &mut signals);
                whole.push(signals);
            }
            Part::Smooth => smooth[run] = Some(signals?),
            Part::Moved(place, entry) => moved.push((run, place, entry, signals)),
        }
    }
    let mut probe = known.unwrap_or_else(|| Probe::new(layout, whole));
    for (run, place, entry, signals) in moved {
        let own = smooth[run].as_ref().unwrap_or(&probe.discrepancy[run]);
        let factor = layout.scale[entry] / difference(problem, layout, theta, entry);
        probe.columns[run][place] = Some(signals.map(|signals| {
            let mut column = derivative(signals, own, factor);
            reach.keep(run, &mut column);
            Arc::new(column)
        }));
    }
    Ok(probe)
}

/// Discrepancies and all sensitivities at θ.
pub(crate) fn linearise(
    problem: &Problem,
    layout: &Layout,
    theta: &[f64],
) -> Result<Linearised, EstimateError> {
    let all = probe(problem, layout, theta, |_, _| true)?;
    complete(problem, layout, theta, all, |_, _| None)
}

/// All sensitivities at θ, where `known` holds its discrepancies and those that were simulated along with
/// them, and `stale` may hand over a column of a run (run, place) from another point.
///
/// What is missing then, of all runs, is simulated in one batch.
pub(crate) fn complete(
    problem: &Problem,
    layout: &Layout,
    theta: &[f64],
    mut known: Probe,
    stale: impl Fn(usize, usize) -> Option<Column>,
) -> Result<Linearised, EstimateError> {
    for run in 0..problem.runs.len() {
        for (place, entry) in layout.entries(run).enumerate() {
            let own = &known.discrepancy[run];
            let column = &mut known.columns[run][place];
            if column.is_none() {
                let still = || {
                    let zero = |signal: &Vec<f64>| vec![0.0; signal.len()];
                    let is_held = layout.is_held(entry);
                    is_held.then(|| Arc::new(own.iter().map(zero).collect()))
                };
                *column = stale(run, place).or_else(still).map(Ok);
            }
        }
    }
    let missing: Vec<Vec<bool>> = known
        .columns
        .iter()
        .map(|list| list.iter().map(Option::is_none).collect())
        .collect();
    if missing.iter().flatten().any(|missing| *missing) {
        let wants = |run: usize, place: usize| missing[run][place];
        known = probe_from(problem, layout, theta, Some(known), wants)?;
    }
    let all = |list: Vec<Option<_>>| list.into_iter().flatten().collect();
    Ok(Linearised {
        discrepancy: known.discrepancy,
        columns: known
            .columns
            .into_iter()
            .map(all)
            .collect::<Result<_, _>>()?,
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

#[cfg(test)]
mod tests {
    use simgap_effects::{Placed, find};
    use simgap_model::{Location, Model};
    use simgap_simulate::Run;

    use super::*;
    use crate::Start;
    use crate::layout::Freedom;

    const OSCILLATOR: &str = r#"schema = "simgap-model/1"
name = "oscillator"
[[mass]]
name = "block"
value = 2.0
[[spring]]
name = "k"
between = ["block", "ground"]
stiffness = 800.0
[[damper]]
name = "c"
between = ["block", "ground"]
damping = 1.0
[[input]]
channel = "u"
kind = "force"
at = "block"
[[output]]
channel = "y"
kind = "displacement"
at = "block"
"#;

    /// Against differences to both sides, extrapolated: their error is of fourth order.
    #[test]
    fn verify_sensitivities_to_a_hundred_thousandth() {
        let model = Model::from_toml(OSCILLATOR).unwrap();
        let run = Run {
            first_index: 0,
            name: "made here".into(),
            start_s: 0.0,
            time_step_s: 0.01,
            len: 400,
            inputs: vec![(0..400).map(|k| (0.13 * f64::from(k)).sin()).collect()],
            measured: vec![Some(vec![0.0; 400])],
            mended: simgap_simulate::Mended::default(),
        };
        let problem = Problem::new(&model, vec![run]).unwrap();
        let at = Location::Between(["block".into(), "ground".into()]);
        let placed = |kind, value| Placed::new(find(kind).unwrap(), at.clone(), vec![value]);
        let freedom = Freedom {
            nominal_std: None,
            shared_held: false,
        };
        for friction in [0.0, 0.2] {
            let start = Start {
                effects: vec![placed("coulomb_friction", friction)],
                nominal: vec![placed("stiffness_error", 1.0)],
                initial: vec![vec![0.003, 0.1]],
            };
            let layout = Layout::new(&start, &problem, freedom);
            let theta = layout.pack(&start);
            let found = linearise(&problem, &layout, &theta).unwrap();
            for (entry, column) in found.columns[0].iter().enumerate().skip(1) {
                let moved = |h: f64| {
                    let mut theta = theta.clone();
                    theta[entry] += h * layout.scale[entry];
                    let moved = discrepancies_of(&problem, &layout, &[theta], Together::Apart)
                        .swap_remove(0);
                    moved.unwrap().swap_remove(0).swap_remove(0)
                };
                let h = 1e-3;
                let near = moved(-h).into_iter().zip(moved(h));
                let far = moved(-2.0 * h).into_iter().zip(moved(2.0 * h));
                let exact = near
                    .zip(far)
                    .map(|(near, far)| (8.0 * (near.0 - near.1) - (far.0 - far.1)) / (12.0 * h));
                let exact: Vec<f64> = exact.collect();
                let off = column[0].iter().zip(&exact).map(|(a, b)| (a - b).powi(2));
                let size: f64 = exact.iter().map(|b| b * b).sum();
                let off = (off.sum::<f64>() / size).sqrt();
                // Where friction holds and lets go, the reference is no finer.
                let least = if friction > 0.0 { 1e-3 } else { 1e-5 };
                assert!(off < least, "{off} of entry {entry} with {friction} N");
            }
        }
    }
}
