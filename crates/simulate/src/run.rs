//! A record in the units of a model.

use simgap_model::{Input, InputKind, Model, Output, OutputKind};
use simgap_record::{Quantity, Record};

use crate::SimulateError;

/// A record in the units of a model: its inputs and, where measured, its outputs.
#[derive(Debug, Clone, PartialEq)]
pub struct Run {
    /// File name of the record.
    pub name: String,
    /// Time stamp of the first sample, s.
    pub start_s: f64,
    /// Sampling interval, s.
    pub time_step_s: f64,
    /// Number of samples.
    pub len: usize,
    /// Number of the first sample on the clock of the converter (see [`simgap_effects::Sampled`]).
    pub first_index: usize,
    /// One signal for each input of the model, in model units.
    pub inputs: Vec<Vec<f64>>,
    /// One signal for each output of the model, in model units; `None` where the record has no
    /// such column.
    pub measured: Vec<Option<Vec<f64>>>,
    /// Which of these samples were not measured where they stand.
    pub mended: Mended,
}

/// Which samples of a run were not measured where they stand; none by default.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Mended {
    /// For each output, whether a sample was missing and filled; empty where none was.
    pub filled: Vec<Vec<bool>>,
    /// Whether an uneven time base was resampled: single samples say nothing of the chain then.
    pub is_resampled: bool,
}

impl Mended {
    fn of(model: &Model, record: &Record) -> Mended {
        let filled = model.outputs.iter().map(|output| {
            let filled = record.filled(&output.channel);
            filled.map(<[bool]>::to_vec).unwrap_or_default()
        });
        Mended {
            filled: filled.collect(),
            is_resampled: record.is_resampled(),
        }
    }
}

impl Run {
    /// Takes from the record what the model names. Input columns are required.
    ///
    /// # Errors
    /// [`SimulateError::Record`] when an input column is missing, or a unit does not fit a
    /// quantity that has no gain.
    pub fn new(model: &Model, record: &Record) -> Result<Run, SimulateError> {
        let scaled = |channel: &str, quantity: Quantity, gain: Option<f64>| match gain {
            Some(gain) => {
                let values = &record.require(channel)?.values;
                Ok::<_, SimulateError>(values.iter().map(|value| gain * value).collect::<Vec<_>>())
            }
            None => Ok(record.si_values(channel, quantity)?.into_owned()),
        };
        let inputs = model
            .inputs
            .iter()
            .map(|input| scaled(&input.channel, input_quantity(input.kind), input.gain))
            .collect::<Result<Vec<_>, _>>()?;
        let measured = model
            .outputs
            .iter()
            .map(|output| match record.channel(&output.channel) {
                None => Ok(None),
                Some(_) => {
                    scaled(&output.channel, output_quantity(output.kind), output.gain).map(Some)
                }
            })
            .collect::<Result<Vec<_>, _>>()?;
        Ok(Run {
            name: record.name().to_string(),
            start_s: record.time_s().first().copied().unwrap_or(0.0),
            time_step_s: record.time_step_s(),
            len: record.len(),
            first_index: 0,
            inputs,
            measured,
            mended: Mended::of(model, record),
        })
    }

    /// As [`Run::new`], with every output column required as well.
    ///
    /// # Errors
    /// [`SimulateError::Record`] as above, and when an output column is missing.
    pub fn with_outputs(model: &Model, record: &Record) -> Result<Run, SimulateError> {
        for output in &model.outputs {
            record.require(&output.channel)?;
        }
        Run::new(model, record)
    }

    /// The run at a lower rate: its first sample and every `stride`-th after it.
    #[must_use]
    pub fn thinned(&self, stride: usize) -> Run {
        let thin = |values: &[f64]| values.iter().copied().step_by(stride).collect::<Vec<f64>>();
        let filled = self.mended.filled.iter();
        Run {
            time_step_s: stride as f64 * self.time_step_s,
            len: self.len.div_ceil(stride),
            inputs: self.inputs.iter().map(|input| thin(input)).collect(),
            measured: self
                .measured
                .iter()
                .map(|m| m.as_deref().map(thin))
                .collect(),
            mended: Mended {
                filled: filled
                    .map(|mask| mask.iter().copied().step_by(stride).collect())
                    .collect(),
                ..self.mended.clone()
            },
            ..self.clone()
        }
    }

    /// A stretch of the run, on the same clock.
    #[must_use]
    pub fn slice(&self, range: std::ops::Range<usize>) -> Run {
        let end = range.end.min(self.len);
        let start = range.start.min(end);
        let cut = |signal: &Vec<f64>| signal[start..end].to_vec();
        Run {
            name: self.name.clone(),
            start_s: self.start_s + start as f64 * self.time_step_s,
            time_step_s: self.time_step_s,
            len: end - start,
            first_index: self.first_index + start,
            inputs: self.inputs.iter().map(cut).collect(),
            measured: self
                .measured
                .iter()
                .map(|signal| signal.as_ref().map(cut))
                .collect(),
            mended: Mended {
                filled: self
                    .mended
                    .filled
                    .iter()
                    .map(|filled| filled.get(start..end).unwrap_or_default().to_vec())
                    .collect(),
                is_resampled: self.mended.is_resampled,
            },
        }
    }

    /// The samples of an output that were missing and filled, in rising order: they count for nothing.
    pub fn filled(&self, output: usize) -> impl DoubleEndedIterator<Item = usize> + '_ {
        let filled = self
            .mended
            .filled
            .get(output)
            .map_or(&[][..], Vec::as_slice);
        let filled = filled.iter().take(self.len).enumerate();
        filled.filter_map(|(sample, filled)| filled.then_some(sample))
    }

    /// Length, s.
    #[must_use]
    pub fn duration_s(&self) -> f64 {
        self.len as f64 * self.time_step_s
    }

    /// Time stamp of its middle, s.
    #[must_use]
    pub fn middle_s(&self) -> f64 {
        self.start_s + 0.5 * self.duration_s()
    }
}

/// What an input without a gain must measure.
#[must_use]
pub fn input_quantity(kind: InputKind) -> Quantity {
    Quantity::of_si_symbol(kind.unit())
}

/// What an output without a gain must measure.
#[must_use]
pub fn output_quantity(kind: OutputKind) -> Quantity {
    match kind {
        OutputKind::Roll => Quantity::Angle,
        OutputKind::Spool => Quantity::Share,
        kind => Quantity::of_si_symbol(kind.unit()),
    }
}

/// Unit of an output in the model: SI, as a length or as an angle according to the record's column;
/// a column with a gain is taken as a length.
#[must_use]
pub fn output_unit(output: &Output, record: &Record) -> &'static str {
    unit_of_column(&output.channel, output.gain, output.kind.unit(), record)
}

/// Unit of an input in the model, likewise.
#[must_use]
pub fn input_unit(input: &Input, record: &Record) -> &'static str {
    unit_of_column(&input.channel, input.gain, input.kind.unit(), record)
}

/// The SI unit of a column without a gain, or the one given.
fn unit_of_column(
    channel: &str,
    gain: Option<f64>,
    unit: &'static str,
    record: &Record,
) -> &'static str {
    match record.channel(channel) {
        Some(channel) if gain.is_none() => channel.unit.kind().si_symbol(),
        _ => unit,
    }
}
