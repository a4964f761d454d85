//! Two traces without a model: a measured one and one from an outside simulator.
//!
//! The simulated trace is the prediction of a model without dynamics: each channel a node that is
//! moved as simulated, and measured. What the catalogue knows of the measurement chain is then
//! judged by the same search, the same evidence and the same held-back samples as in a diagnosis;
//! forces and hidden dynamics have no place in such a model, and are left to the eye: where the
//! discrepancy lies, and what it looks like.
//!
//! ```text
//! measured, simulated ─ pair ─▶ a record ─▶ diagnose (chain only) ─▶ verdict, gap
//!                        └─▶ agreement, where, look
//! ```

mod agreement;
mod comparison;
mod error;
mod look;
mod motion;
mod pair;
mod request;

use simgap_effects::{Family, Placed, catalogue};
use simgap_estimate::Problem;
use simgap_model::{Input, InputKind, Model, Output, OutputKind};
use simgap_simulate::Run;

pub use comparison::{
    Agreement, ChainGap, CommonTime, Comparison, Look, MagnitudePhase, Rating, SharedInput,
};
pub use error::CompareError;
pub use request::CompareRequest;

use crate::diagnosis::{ChannelSeries, CheckSeries, Diagnosis, Status, Where};
use crate::gap::Prediction;
use crate::locate::{self, Located, Marks};
use crate::{DiagnoseError, Progress, Request, diagnose};
use agreement::agreement;
use pair::{Pairing, pair, predicted_name};

/// What two traces cannot tell.
const CAVEAT: &str = "with two traces alone, a bias, gain, delay or lag of the simulation looks the \
                      same as one of the sensor";

/// What comes out.
pub struct Compared {
    /// The answer.
    pub comparison: Comparison,
    /// The same in the form of a diagnosis, for a page: the model is the simulation.
    pub diagnosis: Diagnosis,
    /// Measured, simulated and corrected by the named faults of the chain; over the whole stretch.
    pub series: CheckSeries,
    /// Unit of each channel of the series.
    pub units: Vec<String>,
}

/// Compares a measured with a simulated trace.
///
/// # Errors
/// [`CompareError`] when the records have no columns, no units or no time in common, or too little.
pub fn compare(
    request: &CompareRequest<'_>,
    progress: Progress<'_>,
) -> Result<Compared, CompareError> {
    progress("agreement");
    let pairing = pair(request)?;
    let model = model(&pairing);
    let record = pairing.record(request.measured.name())?;
    // Only the chain has a place in such a model; inputs stand for the simulated trace here.
    let chain = |family| family == Family::Measurement;
    let others = catalogue().iter().filter(|effect| !chain(effect.family()));
    let withheld: Vec<String> = others.map(|effect| effect.kind().to_string()).collect();
    let judged = diagnose(
        &Request {
            withheld: &withheld,
            ..Request::new(&model, std::slice::from_ref(&record), &[])
        },
        progress,
    )?;
    let mut diagnosis = judged.diagnosis;
    let run = Run::with_outputs(&model, &record).map_err(DiagnoseError::from)?;
    let step = run.time_step_s;
    let problem = Problem::new(&model, vec![run]).map_err(DiagnoseError::from)?;
    let found = found(&pairing, &problem, &diagnosis);
    let looks = looks(&pairing, step);
    diagnosis.r#where = found;
    diagnosis.model = request.simulated.name().to_string();
    if diagnosis.verdict.status == Status::Unknown {
        diagnosis.verdict.description = looks.iter().flat_map(|l| l.sentences.clone()).collect();
        diagnosis.next_experiment = None;
    }
    let mut notes = pairing.notes.clone();
    notes.append(&mut diagnosis.notes);
    if diagnosis.verdict.status == Status::Effect {
        notes.push(CAVEAT.to_string());
    }
    diagnosis.notes = notes.clone();
    let series = series(&pairing, &problem, &judged.corrected, request)?;
    let gap = &diagnosis.gap;
    let comparison = Comparison {
        schema: "simgap-comparison/1",
        measured: request.measured.name().to_string(),
        simulated: request.simulated.name().to_string(),
        time: pairing.time,
        channels: pairing.traces.iter().map(agreement).collect(),
        inputs: pairing.inputs.clone(),
        gap: ChainGap {
            metric: gap.metric,
            simulated: gap.nominal,
            corrected: gap.corrected,
            noise_floor: gap.noise_floor,
            closed: gap.closed,
        },
        r#where: diagnosis.r#where.clone(),
        chain: diagnosis.verdict.clone(),
        look: looks,
        candidates: diagnosis.candidates.clone(),
        notes,
    };
    let units = pairing.traces.iter().map(|trace| trace.unit.clone());
    Ok(Compared {
        comparison,
        diagnosis,
        series,
        units: units.collect(),
    })
}

/// The model without dynamics: each channel is a node that moves as simulated.
fn model(pairing: &Pairing) -> Model {
    let mut model = Model {
        name: "simulation".to_string(),
        ..Model::default()
    };
    for trace in &pairing.traces {
        let node = predicted_name(&trace.channel);
        // The values are in SI units already, of whatever they measure.
        let gain = Some(1.0);
        model.inputs.push(Input {
            channel: node.clone(),
            kind: InputKind::Displacement,
            at: node.clone(),
            gain,
            uncertainty: None,
            between_samples: None,
        });
        model.outputs.push(Output {
            channel: trace.channel.clone(),
            kind: OutputKind::Displacement,
            at: Some(node),
            between: None,
            gain,
            uncertainty: None,
        });
    }
    model
}

/// Where the discrepancy lies, over the whole stretch.
fn found(pairing: &Pairing, problem: &Problem, diagnosis: &Diagnosis) -> Where {
    let step = pairing.time.time_step_s;
    let off = |trace: &pair::Trace| -> Vec<f64> {
        let pairs = trace.measured.iter().zip(&trace.simulated);
        pairs.map(|(m, s)| m - s).collect()
    };
    let discrepancy: Vec<Vec<f64>> = pairing.traces.iter().map(off).collect();
    let std = problem.output_std();
    let rms = |d: &[f64]| (d.iter().map(|v| v * v).sum::<f64>() / d.len().max(1) as f64).sqrt();
    let prediction = Prediction {
        nrmse: discrepancy
            .iter()
            .zip(&std)
            .map(|(d, s)| rms(d) / s)
            .collect(),
        simulators: vec![],
        discrepancy: vec![discrepancy],
        initial: vec![vec![]],
        own: vec![],
    };
    let rate = 1.0 / step;
    let driven = pairing.drives.iter().find_map(|u| look::main_line(u, rate));
    let moved = || {
        pairing
            .traces
            .iter()
            .find_map(|t| look::main_line(&t.measured, rate))
    };
    let main = match driven {
        Some(line) => Some((line, "the excitation")),
        None => moved().map(|line| (line, "the main line of the motion")),
    };
    let channels = diagnosis.gap.channels.iter();
    let floors: Vec<f64> = channels.map(|c| c.noise_floor).collect();
    let located = Located::new(problem, &prediction, &floors);
    let energy = located.energy.concat();
    let states = pairing.traces.iter().flat_map(|trace| {
        let motion = motion::motion(trace, step);
        motion::states(trace, motion.as_ref(), &energy)
    });
    Where {
        channels: locate::channels(&located),
        locations: diagnosis.r#where.locations.clone(),
        bands: locate::bands_marked(&located, |_| Marks {
            main,
            natural_hz: vec![],
            sample_rate_hz: rate,
        }),
        times: locate::times(&located),
        states: locate::ranked(states.collect()),
        records: locate::records(&located),
    }
}

fn looks(pairing: &Pairing, time_step_s: f64) -> Vec<Look> {
    let traces = pairing.traces.iter();
    traces
        .map(|trace| {
            let motion = motion::motion(trace, time_step_s);
            look::look(trace, time_step_s, motion.as_ref())
        })
        .collect()
}

/// Measured, simulated and corrected traces.
fn series(
    pairing: &Pairing,
    problem: &Problem,
    corrected: &Model,
    request: &CompareRequest<'_>,
) -> Result<CheckSeries, CompareError> {
    let placed = corrected
        .effects
        .iter()
        .map(|entry| Placed::from_entry(&problem.model, entry))
        .collect::<Result<Vec<_>, _>>()
        .map_err(|error| DiagnoseError::from(simgap_simulate::SimulateError::from(error)))?;
    let simulator = problem.simulator(&placed, 0).map_err(DiagnoseError::from)?;
    let predicted = simulator
        .predict(&problem.runs[0], &[])
        .map_err(DiagnoseError::from)?;
    let channels = pairing.traces.iter().zip(predicted);
    Ok(CheckSeries {
        record: request.measured.name().to_string(),
        time_s: pairing.time_s.clone(),
        channels: channels
            .map(|(trace, corrected)| ChannelSeries {
                channel: trace.channel.clone(),
                unit: trace.kind.si_symbol(),
                measured: trace.measured.clone(),
                nominal: trace.simulated.clone(),
                corrected,
            })
            .collect(),
    })
}
