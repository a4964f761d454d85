//! What goes out beside the diagnosis: the corrected model, the predictions.

use simgap_effects::{Action, Family, Placed};
use simgap_estimate::{EstimateError, Fit, Problem};
use simgap_model::{Location, Model};

use crate::data::Data;
use crate::diagnosis::{ChannelSeries, CheckSeries, NamedParameter};
use crate::gap::Prediction;
use crate::units::Units;

/// A nominal parameter as the final fit has it, under its prior.
#[derive(Debug, Clone, PartialEq)]
pub struct NominalEstimate {
    /// Catalogue name of its error, such as `stiffness_error`.
    pub kind: &'static str,
    /// Where it is.
    pub at: Location,
    /// Value with its 95 % interval, relative to the value of the model file: data and prior together.
    pub parameter: NamedParameter,
    /// Relative standard deviation of the prior: the stated uncertainty.
    pub prior_std: f64,
}

/// Every nominal parameter of a fit; values that are several numbers count as their first.
pub(crate) fn nominal_estimates(
    problem: &Problem,
    fit: &Fit,
    units: &Units,
) -> Vec<NominalEstimate> {
    let nominal = fit.estimate.nominal.iter().zip(&fit.nominal_intervals);
    nominal
        .filter_map(|(placed, intervals)| {
            let parameter = placed.effect.parameters().first()?;
            let interval = intervals.first()?;
            Some(NominalEstimate {
                kind: placed.effect.kind(),
                at: placed.at.clone(),
                parameter: NamedParameter {
                    name: parameter.name.to_string(),
                    unit: units.of(placed.effect, parameter, &placed.at),
                    value: interval.value,
                    ci95: interval.ci95,
                },
                prior_std: problem.stated_std(placed),
            })
        })
        .collect()
}

/// The nominal model with its parameters changed and the effects listed.
pub(crate) fn corrected_model(nominal: &Model, placed: &[Placed]) -> Model {
    let mut model = nominal.clone();
    for effect in placed {
        if effect.effect.family() != Family::NominalParameter {
            model.effects.push(effect.to_entry());
            continue;
        }
        match (effect.action(), &effect.at) {
            (Action::Model(change), at) => change(&mut model, at),
            (_, Location::Input(channel)) => {
                let gain = model
                    .inputs
                    .iter_mut()
                    .find(|input| &input.channel == channel);
                match gain.and_then(|input| input.gain.as_mut()) {
                    Some(gain) => *gain *= effect.values[0],
                    // Without a gain every record is converted by its own unit, and stays so.
                    None => model.effects.push(effect.to_entry()),
                }
            }
            _ => {}
        }
    }
    model
}

/// Predictions of the check records, sample by sample.
pub(crate) fn series(
    check: &Problem,
    data: &Data,
    nominal: &Prediction,
    corrected: &Prediction,
) -> Result<Vec<CheckSeries>, EstimateError> {
    let mut series = Vec::with_capacity(check.runs.len());
    for (r, run) in check.runs.iter().enumerate() {
        let predicted = |p: &Prediction| p.simulators[r].predict(run, &p.initial[r]);
        let both = predicted(nominal)?.into_iter().zip(predicted(corrected)?);
        let channels = both
            .enumerate()
            .map(|(c, (nominal, corrected))| ChannelSeries {
                channel: check.model.outputs[c].channel.clone(),
                unit: data.units.of_output(c),
                nominal,
                corrected,
                measured: run.measured[c].clone().unwrap_or_default(),
            });
        series.push(CheckSeries {
            record: run.name.clone(),
            time_s: data.check_times[r].clone(),
            channels: channels.collect(),
        });
    }
    Ok(series)
}
