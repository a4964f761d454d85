//! What goes out beside the diagnosis: the corrected model, the predictions.

use simgap_effects::{Action, Family, Placed};
use simgap_estimate::{EstimateError, Problem};
use simgap_model::{Location, Model};

use crate::data::Data;
use crate::diagnosis::{ChannelSeries, CheckSeries};
use crate::gap::Prediction;

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
                unit: data.output_units[c],
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
