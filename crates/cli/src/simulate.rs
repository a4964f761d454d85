//! `simgap simulate`.

use simgap_estimate::{Problem, Weights, fit_initial_states};
use simgap_model::OutputKind;
use simgap_record::write_csv_atomic;
use simgap_simulate::Run;

use crate::args::SimulateArgs;
use crate::error::CliError;
use crate::input;

pub(crate) fn run(args: &SimulateArgs) -> Result<(), CliError> {
    let model = input::model(&args.model)?;
    let record = input::record(&args.record, &model)?;
    let failed = |error| CliError::Simulate {
        path: args.record.clone(),
        error,
    };
    let run = Run::new(&model, &record).map_err(failed)?;
    let problem = Problem::new(&model, vec![run.clone()]).map_err(failed)?;
    let measured = run.measured.iter().any(Option::is_some);
    let initial = if measured && !args.from_rest {
        // The record need not start at rest: its outputs say how it starts.
        let weights = Weights::independent(model.outputs.len());
        let fit = fit_initial_states(&problem, &[], &weights).map_err(failed)?;
        fit.estimate.initial.into_iter().next().unwrap_or_default()
    } else {
        vec![]
    };
    let simulator = problem.simulator(&[]).map_err(failed)?;
    let predicted = simulator.predict(&run, &initial).map_err(failed)?;
    if predicted.iter().flatten().any(|value| !value.is_finite()) {
        return Err(CliError::RunsAway { record: run.name });
    }
    let mut headers = vec!["t [s]".to_string()];
    let mut columns: Vec<&[f64]> = vec![record.time_s()];
    for (output, signal) in model.outputs.iter().zip(&predicted) {
        let unit = match output.kind {
            OutputKind::Displacement => "m",
            OutputKind::Velocity => "m/s",
            OutputKind::Acceleration => "m/s^2",
            OutputKind::Force => "N",
        };
        headers.push(format!("{} [{unit}]", output.channel));
        columns.push(signal);
    }
    write_csv_atomic(&args.out, &headers, &columns)?;
    println!("{}", args.out.display());
    Ok(())
}
