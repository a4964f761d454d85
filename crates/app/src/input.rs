//! Reading models and records.

use std::io::{ErrorKind, Read as _};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use simgap_effects::{Placed, own_laws};
use simgap_model::{Location, Model};
use simgap_record::{
    ChannelMap, MapFault, Mend, Quantity, ReadOptions, Reading, Record, RecordError, read_file,
};
use simgap_simulate::{input_quantity, output_quantity};

use crate::AppError;

/// No model file is longer, bytes; a record handed over as the model is refused before it fills
/// the memory.
const MAX_MODEL_BYTES: u64 = 16 << 20;

/// How the columns of records are called, and what is done about their faults.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct RecordOptions {
    /// Columns of other names than the channels of the model: `y=Pos_Mold`, `y=Pos_Mold [mm]`.
    pub map: Vec<String>,
    /// Names and units of the columns of a table of text without a header: `t [s],u [N],y [mm]`.
    pub columns: Option<String>,
    /// Missing samples are filled and uneven stamps resampled also in CSV files of the contract's own form.
    pub mend: bool,
}

impl RecordOptions {
    /// The map.
    ///
    /// # Errors
    /// [`MapFault`] when an entry is not `channel=column`.
    pub fn map(&self) -> Result<ChannelMap, MapFault> {
        ChannelMap::parse(&self.map)
    }

    /// What to read, with the names, the map and the mending that are asked for.
    ///
    /// # Errors
    /// [`MapFault`] when the map or the columns cannot be understood.
    pub fn applied_to(&self, options: ReadOptions) -> Result<ReadOptions, MapFault> {
        let options = match &self.columns {
            Some(columns) => options.with_columns(columns)?,
            None => options,
        };
        let mend = if self.mend {
            Mend::Always
        } else {
            Mend::Foreign
        };
        Ok(options.with_map(self.map()?).with_mend(mend))
    }

    /// The arguments of the command that ask for the same, each with its value.
    pub fn words(&self) -> impl Iterator<Item = (&'static str, Option<String>)> {
        let map = self.map.iter().map(|entry| ("--map", Some(entry.clone())));
        let columns = self.columns.clone().map(|names| ("--columns", Some(names)));
        map.chain(columns)
            .chain(self.mend.then_some(("--mend", None)))
    }
}

/// Reads a model file, the effects it lists included.
///
/// # Errors
/// [`AppError`] when the file cannot be read or holds no valid model.
pub fn model(path: &Path) -> Result<Model, AppError> {
    let unreadable = |found: String| AppError::ModelFile {
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
    model_of(&text, path)
}

/// A model from its text, the effects it lists included; `path` names it in messages.
///
/// # Errors
/// [`AppError`] when the text holds no valid model.
pub fn model_of(text: &str, path: &Path) -> Result<Model, AppError> {
    let model = Model::from_toml(text).map_err(|error| AppError::Model {
        path: path.into(),
        error,
    })?;
    let refused = |error| AppError::Effect {
        path: path.into(),
        error,
    };
    own_laws(&model).map_err(refused)?;
    for entry in &model.effects {
        Placed::from_entry(&model, entry).map_err(refused)?;
    }
    Ok(model)
}

/// A record of what a model names, and what was guessed or changed to read it, one sentence each.
#[derive(Debug, Clone)]
pub struct Input {
    /// The file, or the name of a record that comes from none: how messages call it.
    pub path: PathBuf,
    /// Whether it is read from a file.
    pub is_file: bool,
    /// The record; shared, because a record may be large.
    pub record: Arc<Record>,
    /// One sentence each.
    pub notes: Vec<String>,
}

impl Input {
    /// A record that was made from numbers.
    #[must_use]
    pub fn made(record: Arc<Record>) -> Input {
        Input {
            path: record.name().into(),
            is_file: false,
            notes: vec![],
            record,
        }
    }

    /// The record with the channels that a model names and no others, as files are read for it: other
    /// columns may hold anything, and nothing is said of them.
    ///
    /// # Errors
    /// [`AppError::Record`] when a channel is missing or its unit does not fit.
    pub fn of_model(&self, model: &Model) -> Result<Input, AppError> {
        self.needing(
            model,
            &inputs(model).chain(outputs(model)).collect::<Vec<_>>(),
        )
    }

    /// As [`Input::of_model`], of a record that need not hold the outputs.
    ///
    /// # Errors
    /// As [`Input::of_model`].
    pub fn of_inputs(&self, model: &Model) -> Result<Input, AppError> {
        self.needing(model, &inputs(model).collect::<Vec<_>>())
    }

    fn needing(&self, model: &Model, needed: &[&str]) -> Result<Input, AppError> {
        for name in needed {
            self.record.require(name)?;
        }
        checked(&self.path, model, &self.record)?;
        let is_named = |name: &str| inputs(model).chain(outputs(model)).any(|n| n == name);
        let all = self.record.channels().iter();
        let record = if all.clone().all(|channel| is_named(&channel.name)) {
            Arc::clone(&self.record)
        } else {
            Arc::new(self.record.with_channels(is_named))
        };
        Ok(Input {
            record,
            ..self.clone()
        })
    }
}

/// Reads of a record what the model names, inputs and outputs; other columns may hold anything.
///
/// # Errors
/// [`AppError::Record`] when the file cannot be read or does not fit the model.
pub fn record(path: &Path, model: &Model, args: &RecordOptions) -> Result<Input, AppError> {
    let names = inputs(model).chain(outputs(model));
    read(path, model, args, ReadOptions::channels(names, [""; 0]))
}

/// As [`record`], of a record that need not hold the outputs.
///
/// # Errors
/// As [`record`].
pub fn record_of_inputs(
    path: &Path,
    model: &Model,
    args: &RecordOptions,
) -> Result<Input, AppError> {
    let options = ReadOptions::channels(inputs(model), outputs(model));
    read(path, model, args, options)
}

/// Reads every column of a record that holds numbers.
///
/// # Errors
/// [`AppError::Record`] when the file cannot be read.
pub fn table(path: &Path, args: &RecordOptions) -> Result<Input, AppError> {
    let options = args
        .applied_to(ReadOptions::all())
        .map_err(RecordError::from)?;
    Ok(told(path, read_file(path, &options)?))
}

/// As [`table`], of what a simulator wrote: its columns as they are called, its steps as it took
/// them.
///
/// # Errors
/// [`AppError::Record`] when the file cannot be read.
pub fn simulated(path: &Path) -> Result<Input, AppError> {
    let options = ReadOptions::all().with_mend(Mend::Always);
    Ok(told(path, read_file(path, &options)?))
}

fn told(path: &Path, reading: Reading) -> Input {
    let name = reading.record.name();
    let notes = reading.notes.iter().map(|note| format!("{name}: {note}"));
    Input {
        path: path.into(),
        is_file: true,
        notes: notes.collect(),
        record: Arc::new(reading.record),
    }
}

fn read(
    path: &Path,
    model: &Model,
    args: &RecordOptions,
    options: ReadOptions,
) -> Result<Input, AppError> {
    let map = args.map().map_err(RecordError::from)?;
    let channels: Vec<&str> = inputs(model).chain(outputs(model)).collect();
    map.check_channels(&channels).map_err(RecordError::from)?;
    let options = args.applied_to(options).map_err(RecordError::from)?;
    let input = told(path, read_file(path, &options)?);
    checked(path, model, &input.record)?;
    Ok(input)
}

fn inputs(model: &Model) -> impl Iterator<Item = &str> {
    model.inputs.iter().map(|input| input.channel.as_str())
}

fn outputs(model: &Model) -> impl Iterator<Item = &str> {
    model.outputs.iter().map(|output| output.channel.as_str())
}

/// Masses that nothing joins, drives or measures, one sentence each: such a mass is legal and does
/// nothing, so it is most likely a member that was forgotten.
#[must_use]
pub fn idle_masses(model: &Model) -> Vec<String> {
    let between = |pair: &[String; 2], name: &str| pair.iter().any(|node| node == name);
    let joined = model.joined();
    let used = |name: &str| {
        joined.iter().any(|pair| between(pair, name))
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
    // Coordinates of elements are theirs to use.
    let is_idle = |name: &String| !used(name) && model.coordinate_kind(name).is_none();
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
fn checked(path: &Path, model: &Model, record: &Record) -> Result<(), AppError> {
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
    Ok(())
}

/// How units of a record are converted for the model, one sentence each.
#[must_use]
pub fn conversions(record: &Record, model: &Model) -> Vec<String> {
    record
        .conversions_to(&quantities(model))
        .iter()
        .map(|conversion| format!("{}: {conversion}", record.name()))
        .collect()
}
