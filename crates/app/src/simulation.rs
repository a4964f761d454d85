//! A simulation of a model from the inputs of a record.

use std::sync::Arc;

use simgap_effects::Action;
use simgap_estimate::{FitOptions, Problem, fit_initial_states, simulator_at};
use simgap_model::Model;
use simgap_simulate::{ExternalPlant, Run, SimulateError, output_unit};

use crate::AppError;
use crate::input::{Input, conversions, idle_masses};

/// What a model predicts.
pub struct Simulation {
    /// `t [s]`, then name and unit of each output.
    pub headers: Vec<String>,
    /// A column for each header, one value for each sample of the record.
    pub columns: Vec<Vec<f64>>,
    /// What a reader must know, one sentence each.
    pub notes: Vec<String>,
}

/// Predicts the outputs of a model, effects included, from the inputs of a record. The motion starts as the measured
/// outputs say, at rest at zero displacement where there are none or where that is asked for.
///
/// # Errors
/// [`AppError::Simulate`] when the record does not fit the model, [`AppError::RunsAway`] when the prediction does not stay
/// finite.
pub fn simulate(model: &Model, input: &Input, from_rest: bool) -> Result<Simulation, AppError> {
    simulate_with(model, input, from_rest, None)
}

/// As [`simulate`] for a model that may stand for a simulator of the user's.
///
/// # Errors
/// As [`simulate`].
pub fn simulate_with(
    model: &Model,
    input: &Input,
    from_rest: bool,
    plant: Option<Arc<ExternalPlant>>,
) -> Result<Simulation, AppError> {
    let Input {
        path,
        record,
        notes: read_notes,
        ..
    } = input;
    let failed = |error: SimulateError| AppError::Simulate {
        path: path.clone(),
        error: Box::new(error),
    };
    let mut run = Run::new(model, record).map_err(failed)?;
    let mut problem = Problem::new(model, vec![run.clone()]).map_err(failed)?;
    problem.plant = plant;
    let measured = run.measured.iter().any(Option::is_some);
    let mut notes = conversions(record, model);
    notes.extend(idle_masses(model));
    notes.extend(read_notes.iter().cloned());
    if !measured && !from_rest && !model.outputs.is_empty() {
        notes.push(format!(
            "{}: no column is an output of the model, so the prediction starts at rest at zero \
             displacement",
            record.name()
        ));
    }
    let mut found = None;
    if measured && !from_rest {
        // The record need not start at rest, nor with the even half of an alternation: its outputs
        // say how it starts.
        let weights = FitOptions::white(model.outputs.len());
        let mut best = fit_initial_states(&problem, &[], &weights).map_err(failed)?;
        if problem
            .given
            .iter()
            .any(|placed| matches!(placed.action(), Action::Sampling(_)))
        {
            let mut other_half = run.clone();
            other_half.first_index += 1;
            let other = problem.with_runs(vec![other_half.clone()]);
            let fit = fit_initial_states(&other, &[], &weights).map_err(failed)?;
            if fit.objective < best.objective {
                (run, problem, best) = (other_half, other, fit);
            }
        }
        found = Some(best);
    }
    let (simulator, initial) = match &found {
        Some(fit) => (
            simulator_at(&problem, fit, 0),
            fit.estimate.initial.first().cloned().unwrap_or_default(),
        ),
        None => (problem.simulator(&[], 0), vec![]),
    };
    let simulator = simulator.map_err(failed)?;
    let predicted = simulator.predict(&run, &initial).map_err(failed)?;
    let finite = |signal: &Vec<f64>| signal.iter().all(|value| value.is_finite());
    if let Some(channel) = predicted.iter().position(|signal| !finite(signal)) {
        return Err(AppError::RunsAway {
            record: path.display().to_string(),
            channel: model.outputs[channel].channel.clone(),
        });
    }
    let mut headers = vec!["t [s]".to_string()];
    headers.extend(model.outputs.iter().map(|output| {
        let unit = output_unit(output, record);
        format!("{} [{unit}]", output.channel)
    }));
    let mut columns = vec![record.time_s().to_vec()];
    columns.extend(predicted);
    Ok(Simulation {
        headers,
        columns,
        notes,
    })
}
