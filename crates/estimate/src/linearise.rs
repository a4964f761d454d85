//! Residuals and their sensitivities at one point.

use crate::layout::Layout;
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

/// Predicts a run with a packed vector.
pub(crate) fn predict(
    problem: &Problem,
    layout: &Layout,
    theta: &[f64],
    run: usize,
) -> Result<Signals, EstimateError> {
    let start = layout.unpack(theta);
    let effects: Vec<_> = start.effects.into_iter().chain(start.nominal).collect();
    problem
        .simulator(&effects, run)?
        .predict(&problem.runs[run], layout.state(theta, run))
}

/// As [`predict`], without what moves in steps where there is such; `None` where there is not.
fn predict_smooth(
    problem: &Problem,
    layout: &Layout,
    theta: &[f64],
    run: usize,
) -> Result<Option<Signals>, EstimateError> {
    let start = layout.unpack(theta);
    let effects: Vec<_> = start.effects.into_iter().chain(start.nominal).collect();
    let simulator = problem.simulator(&effects, run)?;
    if !simulator.is_stepped() {
        return Ok(None);
    }
    let smooth = simulator.predict_smooth(&problem.runs[run], layout.state(theta, run))?;
    Ok(Some(subtract(&problem.runs[run].measured, smooth)))
}

/// Measured minus predicted, for every run and channel.
pub(crate) fn discrepancies(
    problem: &Problem,
    layout: &Layout,
    theta: &[f64],
) -> Result<Vec<Signals>, EstimateError> {
    (0..problem.runs.len())
        .map(|run| {
            let predicted = predict(problem, layout, theta, run)?;
            Ok(subtract(&problem.runs[run].measured, predicted))
        })
        .collect()
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

/// Derivative of the prediction of a run by one entry of θ / scale, given its discrepancy at θ.
fn column(
    problem: &Problem,
    layout: &Layout,
    theta: &[f64],
    run: usize,
    entry: usize,
    discrepancy: &Signals,
) -> Result<Signals, EstimateError> {
    if layout.is_held(entry) {
        let zero = |signal: &Vec<f64>| vec![0.0; signal.len()];
        return Ok(discrepancy.iter().map(zero).collect());
    }
    let mut moved = theta.to_vec();
    let mut step = DIFFERENCE * layout.scale[entry];
    if theta[entry] + step > layout.upper[entry] {
        step = -step;
    }
    moved[entry] += step;
    let mut change = match predict_smooth(problem, layout, &moved, run)? {
        Some(change) => change,
        None => {
            let predicted = predict(problem, layout, &moved, run)?;
            subtract(&problem.runs[run].measured, predicted)
        }
    };
    let factor = layout.scale[entry] / step;
    for (signal, base) in change.iter_mut().zip(discrepancy) {
        signal
            .iter_mut()
            .zip(base)
            .for_each(|(after, before)| *after = (before - *after) * factor);
    }
    Ok(change)
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
pub(crate) fn refresh(
    problem: &Problem,
    layout: &Layout,
    theta: &[f64],
    known: Linearised,
    mut stale: impl FnMut(usize, usize) -> Option<Signals>,
) -> Result<Linearised, EstimateError> {
    let discrepancy = known.discrepancy;
    let mut columns = Vec::with_capacity(problem.runs.len());
    for (run, own) in discrepancy.iter().enumerate() {
        let mut list = Vec::new();
        let smooth = predict_smooth(problem, layout, theta, run)?;
        let own = smooth.as_ref().unwrap_or(own);
        for (place, entry) in layout.entries(run).enumerate() {
            list.push(match stale(run, place) {
                Some(column) => column,
                None => column(problem, layout, theta, run, entry, own)?,
            });
        }
        columns.push(list);
    }
    Ok(Linearised {
        discrepancy,
        columns,
    })
}
