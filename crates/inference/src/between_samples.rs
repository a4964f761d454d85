//! What inputs do between their samples.
//!
//! A record holds samples; a machine is driven by what is between them, too. What was measured follows a smooth curve; what a
//! converter puts out keeps each value until the next sample (zero-order hold), which a plant sees half an interval later; what was
//! computed may go in straight lines (first-order hold). A signal may be smooth in one record and a square wave in the next: it is
//! stepped, a smooth curve with jumps. Where the model file states none and a signal goes in jumps in a record, the
//! records decide: the likelihood of the model with re-estimated parameters under each, equally likely before any data.

use simgap_effects::Placed;
use simgap_estimate::{Cancel, EstimateError, FitOptions, Problem, Start, fit_initial_states};
use simgap_model::{BetweenSamples, InputKind, Model};
use simgap_simulate::{Run, lone_changes};

use crate::{RECALIBRATION_STD, recalibrate};

/// A signal goes in jumps where more than this share of its way lies in changes that stand alone.
const IN_JUMPS: f64 = 0.5;

/// The model with inputs that are read as the records say.
///
/// # Errors
/// [`EstimateError`] when the model cannot be propagated, or the work was cancelled.
pub fn read_inputs(model: &Model, runs: &[Run], cancel: &Cancel) -> Result<Model, EstimateError> {
    let mut read = model.clone();
    let in_jumps = |i: usize| runs.iter().map(move |run| goes_in_jumps(&run.inputs[i]));
    let asked: Vec<usize> = (0..model.inputs.len())
        .filter(|&i| {
            let input = &model.inputs[i];
            // What an input of a simulator is between the samples, the simulator decides.
            let is_open = input.between_samples.is_none()
                && input.may_jump()
                && input.kind != InputKind::Signal;
            is_open && in_jumps(i).any(|is_in_jumps| is_in_jumps)
        })
        .collect();
    if asked.is_empty() {
        return Ok(read);
    }
    let mut least = misfit(&read, runs, cancel)?;
    for i in asked {
        let mut readings = vec![BetweenSamples::Linear, BetweenSamples::Held];
        // What goes in jumps in every record is held between them.
        if !in_jumps(i).all(|is_in_jumps| is_in_jumps) {
            readings.push(BetweenSamples::Stepped);
        }
        for reading in readings {
            let before = read.inputs[i].between_samples.replace(reading);
            let left = misfit(&read, runs, cancel)?;
            match left < least {
                true => least = left,
                false => read.inputs[i].between_samples = before,
            }
        }
    }
    Ok(read)
}

/// Minus the log-likelihood of a model with re-estimated parameters.
fn misfit(model: &Model, runs: &[Run], cancel: &Cancel) -> Result<f64, EstimateError> {
    let mut problem = Problem::new(model, runs.to_vec())?;
    problem.leaves_out_ends = true;
    problem.cancel = cancel.clone();
    let options = FitOptions::white(model.outputs.len());
    let start = Start {
        effects: vec![],
        nominal: problem
            .nominal_parameters()
            .into_iter()
            .map(|candidate| {
                let values = vec![1.0; candidate.effect.parameters().len()];
                Placed::new(candidate.effect, candidate.at, values)
            })
            .collect(),
        initial: fit_initial_states(&problem, &[], &options)?
            .estimate
            .initial,
    };
    let loose = FitOptions {
        nominal_std: Some(RECALIBRATION_STD),
        ..options
    };
    Ok(recalibrate(&problem, &start, &loose)?.misfit)
}

/// Whether most of the way that a signal goes lies in changes that stand alone: it pauses before and after them.
fn goes_in_jumps(signal: &[f64]) -> bool {
    let way = |changes: &mut dyn Iterator<Item = f64>| changes.map(f64::abs).sum::<f64>();
    let all = way(&mut signal.windows(2).map(|pair| pair[1] - pair[0]));
    way(&mut lone_changes(signal).into_iter()) > IN_JUMPS * all
}

#[cfg(test)]
mod tests {
    use super::goes_in_jumps;

    #[test]
    fn verify_what_goes_in_jumps() {
        let held: Vec<f64> = (0..100)
            .map(|i| if i / 7 % 2 == 0 { 1.0 } else { -1.0 })
            .collect();
        assert!(goes_in_jumps(&held));
        // It sets in gently.
        let gently: Vec<f64> = held
            .iter()
            .enumerate()
            .map(|(i, v)| v * (i as f64 / 20.0).min(1.0))
            .collect();
        assert!(goes_in_jumps(&gently));
        let smooth: Vec<f64> = (0..100).map(|i| (0.3 * f64::from(i)).sin()).collect();
        let ramps: Vec<f64> = (0..100).map(|i| f64::from((i % 40).min(10))).collect();
        for signal in [smooth, ramps, vec![0.0; 50], vec![1.0], vec![]] {
            assert!(!goes_in_jumps(&signal));
        }
    }
}
