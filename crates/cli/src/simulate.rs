//! `simgap simulate`.

use std::path::Path;

use simgap_effects::Action;
use simgap_estimate::{FitOptions, Problem, fit_initial_states, simulator_at};
use simgap_record::write_csv_atomic;
use simgap_simulate::SimulateError;
use simgap_simulate::{Run, output_unit};

use crate::args::SimulateArgs;
use crate::error::CliError;
use crate::folder::{Folder, not_an_input};
use crate::{input, say};

pub(crate) fn run(args: &SimulateArgs) -> Result<(), CliError> {
    not_an_input(&args.out, &[&args.model, &args.record])?;
    let (folder, files) = (parent(&args.out), [args.out.clone()]);
    Folder::attempt(folder, &[], &files)?;
    let model = input::model(&args.model)?;
    let input::Input { record, notes } =
        input::record_of_inputs(&args.record, &model, &args.records)?;
    let failed = |error: SimulateError| CliError::Simulate {
        path: args.record.clone(),
        error: Box::new(error),
    };
    let mut run = Run::new(&model, &record).map_err(failed)?;
    let mut problem = Problem::new(&model, vec![run.clone()]).map_err(failed)?;
    let measured = run.measured.iter().any(Option::is_some);
    let mut all_notes = input::idle_masses(&model);
    all_notes.extend(notes);
    if !measured && !args.from_rest && !model.outputs.is_empty() {
        all_notes.push(format!(
            "{}: no column is an output of the model, so the prediction starts at rest at zero \
             displacement",
            record.name()
        ));
    }
    let mut found = None;
    if measured && !args.from_rest {
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
        return Err(CliError::RunsAway {
            record: args.record.display().to_string(),
            channel: model.outputs[channel].channel.clone(),
        });
    }
    let mut headers = vec!["t [s]".to_string()];
    let mut columns: Vec<&[f64]> = vec![record.time_s()];
    for (output, signal) in model.outputs.iter().zip(&predicted) {
        let unit = output_unit(output, &record);
        headers.push(format!("{} [{unit}]", output.channel));
        columns.push(signal);
    }
    let folder = Folder::make(folder, &[], &files)?;
    write_csv_atomic(&args.out, &headers, &columns)?;
    folder.keep();
    let notes = all_notes.iter().map(|note| format!("note: {note}\n"));
    say(&format!(
        "{}\n{}",
        args.out.display(),
        notes.collect::<String>()
    ))
}

/// The folder a file goes to.
fn parent(file: &Path) -> &Path {
    match file.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    }
}
