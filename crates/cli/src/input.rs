//! Reading models and records.

use std::io::{ErrorKind, Read as _};
use std::path::Path;

use simgap_effects::Placed;
use simgap_model::{Location, Model};
use simgap_record::{Mend, Quantity, ReadOptions, Reading, Record, RecordError, read_file};
use simgap_simulate::{input_quantity, output_quantity};

use crate::error::CliError;
use crate::record_args::RecordArgs;

/// No model file is longer, bytes; a record handed over as the model is refused before it fills
/// the memory.
const MAX_MODEL_BYTES: u64 = 16 << 20;

/// Reads a model file, the effects it lists included.
pub(crate) fn model(path: &Path) -> Result<Model, CliError> {
    let unreadable = |found: String| CliError::ModelFile {
        path: path.into(),
        found,
    };
    let refused = |error: std::io::Error| {
        unreadable(match error.kind() {
            ErrorKind::NotFound => "no such file".to_string(),
            ErrorKind::IsADirectory => "is a directory".to_string(),
            _ => format!("cannot be read ({error})"),
        })
    };
    let file = std::fs::File::open(path).map_err(refused)?;
    let mut text = String::new();
    file.take(MAX_MODEL_BYTES + 1)
        .read_to_string(&mut text)
        .map_err(refused)?;
    if text.len() as u64 > MAX_MODEL_BYTES {
        return Err(unreadable(format!("longer than {MAX_MODEL_BYTES} bytes")));
    }
    let model = Model::from_toml(&text).map_err(|error| CliError::Model {
        path: path.into(),
        error,
    })?;
    for entry in &model.effects {
        Placed::from_entry(&model, entry).map_err(|error| CliError::Effect {
            path: path.into(),
            error,
        })?;
    }
    Ok(model)
}

/// A record of what a model names, and what was guessed or changed to read it, one sentence each.
pub(crate) struct Input {
    pub(crate) record: Record,
    pub(crate) notes: Vec<String>,
}

/// Reads of a record what the model names, inputs and outputs; other columns may hold anything.
pub(crate) fn record(path: &Path, model: &Model, args: &RecordArgs) -> Result<Input, CliError> {
    let names = inputs(model).chain(outputs(model));
    read(path, model, args, ReadOptions::channels(names, [""; 0]))
}

/// As [`record`], of a record that need not hold the outputs.
pub(crate) fn record_of_inputs(
    path: &Path,
    model: &Model,
    args: &RecordArgs,
) -> Result<Input, CliError> {
    let options = ReadOptions::channels(inputs(model), outputs(model));
    read(path, model, args, options)
}

/// Reads every column of a record that holds numbers.
pub(crate) fn table(path: &Path, args: &RecordArgs) -> Result<Input, CliError> {
    let options = args
        .applied_to(ReadOptions::all())
        .map_err(RecordError::from)?;
    Ok(told(read_file(path, &options)?))
}

/// As [`table`], of what a simulator wrote: its columns as they are called, its steps as it took
/// them.
pub(crate) fn simulated(path: &Path) -> Result<Input, CliError> {
    let options = ReadOptions::all().with_mend(Mend::Always);
    Ok(told(read_file(path, &options)?))
}

fn told(reading: Reading) -> Input {
    let name = reading.record.name();
    let notes = reading.notes.iter().map(|note| format!("{name}: {note}"));
    Input {
        notes: notes.collect(),
        record: reading.record,
    }
}

fn read(
    path: &Path,
    model: &Model,
    args: &RecordArgs,
    options: ReadOptions,
) -> Result<Input, CliError> {
    let map = args.map().map_err(RecordError::from)?;
    let channels: Vec<&str> = inputs(model).chain(outputs(model)).collect();
    map.check_channels(&channels).map_err(RecordError::from)?;
    let options = args.applied_to(options).map_err(RecordError::from)?;
    let Input { record, notes } = told(read_file(path, &options)?);
    let record = checked(path, model, record)?;
    Ok(Input { record, notes })
}

fn inputs(model: &Model) -> impl Iterator<Item = &str> {
    model.inputs.iter().map(|input| input.channel.as_str())
}

fn outputs(model: &Model) -> impl Iterator<Item = &str> {
    model.outputs.iter().map(|output| output.channel.as_str())
}

/// Masses that nothing joins, drives or measures, one sentence each: such a mass is legal and does
/// nothing, so it is most likely a member that was forgotten.
pub(crate) fn idle_masses(model: &Model) -> Vec<String> {
    let between = |pair: &[String; 2], name: &str| pair.iter().any(|node| node == name);
    let used = |name: &str| {
        model.springs.iter().any(|s| between(&s.between, name))
            || model.dampers.iter().any(|d| between(&d.between, name))
            || model.inputs.iter().any(|input| input.at == name)
            || model.pendulums.iter().any(|pendulum| pendulum.at == name)
            || model.outputs.iter().any(|output| {
                output.at.as_deref() == Some(name)
                    || output
                        .between
                        .as_ref()
                        .is_some_and(|pair| between(pair, name))
            })
            || model.effects.iter().any(|effect| match &effect.at {
                Location::Between(pair) => between(pair, name),
                Location::Mass(mass) => mass == name,
                _ => false,
            })
    };
    // Of a body, its points may be used instead; beams, cylinders and blocks join by themselves.
    let own = |name: &str| model.body_of(name).is_some() || model.is_beam_coordinate(name);
    let beams = model.beams.iter().map(|beam| &beam.between);
    let cylinders = model.cylinders.iter().map(|cylinder| &cylinder.between);
    let joined: Vec<&String> = beams.chain(cylinders).flatten().collect();
    let is_idle = |name: &String| {
        !(used(name) || own(name) || model.is_internal(name) || joined.contains(&name))
    };
    let masses = model.masses.iter().filter(|mass| is_idle(&mass.name));
    masses
        .map(|mass| {
            format!(
                "nothing joins, drives or measures mass '{}': is a spring or a damper missing?",
                mass.name
            )
        })
        .collect()
}

/// What each column without a gain must measure.
fn quantities(model: &Model) -> Vec<(&str, Quantity)> {
    let inputs = model.inputs.iter().filter(|input| input.gain.is_none());
    let outputs = model.outputs.iter().filter(|output| output.gain.is_none());
    inputs
        .map(|input| (input.channel.as_str(), input_quantity(input.kind)))
        .chain(outputs.map(|output| (output.channel.as_str(), output_quantity(output.kind))))
        .collect()
}

/// Refuses units that do not fit here, where the whole path is known.
fn checked(path: &Path, model: &Model, record: Record) -> Result<Record, CliError> {
    for (name, quantity) in quantities(model) {
        let Some(channel) = record.channel(name) else {
            continue;
        };
        channel
            .si_values(quantity)
            .map_err(|source| RecordError::InRecord {
                file: path.display().to_string(),
                source: Box::new(source),
            })?;
    }
    Ok(record)
}

/// How units of a record are converted for the model, one sentence each.
pub(crate) fn conversions(record: &Record, model: &Model) -> Vec<String> {
    record
        .conversions_to(&quantities(model))
        .iter()
        .map(|conversion| format!("{}: {conversion}", record.name()))
        .collect()
}
