//! Numeric arrays of a workspace, as MATLAB saves it, to columns.

use std::collections::HashMap;

use crate::MIN_ROWS;
use crate::base::{Base, Uniform};
use crate::note::Note;
use crate::raw::{Raw, RawColumn};
use crate::time_names::is_time_name;

/// A matrix of more channels than this is no table.
const MOST_CHANNELS: usize = 256;
/// What a scalar that holds the sample time is called, and one that holds the sample rate.
const STEPS: [&str; 4] = ["dt", "ts", "sample_time", "sampletime"];
const RATES: [&str; 5] = ["fs", "f_s", "sample_rate", "samplerate", "sampling_rate"];
/// And one that holds the time of the first sample.
const STARTS: [&str; 6] = ["t0", "t_0", "tstart", "t_start", "start_time", "starttime"];

/// A numeric array: values column by column.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Array {
    /// `log.Weg` for a field.
    pub(crate) path: String,
    /// Empty if the file has none.
    pub(crate) unit: String,
    pub(crate) rows: usize,
    pub(crate) columns: usize,
    pub(crate) values: Vec<f64>,
    /// What the values are counted from.
    pub(crate) origin: f64,
}

/// The variables of a file.
#[derive(Debug, Default)]
pub(crate) struct Workspace {
    pub(crate) arrays: Vec<Array>,
    /// Texts by their paths: names and units may be among them.
    pub(crate) texts: HashMap<String, String>,
}

/// Vectors become columns under their names, matrices one column for each channel: `data(:,2)`,
/// or `data(2,:)` where the rows are the channels. The name of a field stands alone where no other
/// has it.
pub(crate) fn to_raw(workspace: Workspace, notes: &mut Vec<Note>) -> Raw {
    let Workspace { mut arrays, texts } = workspace;
    for array in &mut arrays {
        name_by_text(array, &texts);
    }
    let uniform = sampled(&arrays);
    let mut columns: Vec<RawColumn> = Vec::new();
    for array in arrays {
        columns_of(array, &mut columns);
    }
    shorten(&mut columns);
    let timed = |column: &RawColumn| is_time_name(&column.name);
    let mut raw = Raw {
        columns,
        ..Raw::default()
    };
    let longest = raw.columns.iter().map(|column| column.values.len()).max();
    if let (Some(sampling), Some(rows)) = (uniform, longest)
        && !raw.columns.iter().any(timed)
    {
        notes.push(Note::TimeChosen {
            column: sampling.scalar,
            because: "it is the only word on time in the file, and names the sampling",
        });
        let start_s = sampling.start.as_ref().map_or(0.0, |(_, start_s)| *start_s);
        if let Some((column, _)) = sampling.start {
            notes.push(Note::TimeChosen {
                column,
                because: "it stands beside the sampling, and is the time of the first sample",
            });
        }
        raw.bases.push(Base::Even(Uniform {
            start_s,
            step_s: sampling.step_s,
            rows,
        }));
    }
    raw
}

/// What loggers call the numbers of a signal in a structure, and the texts beside them: dSPACE
/// (`Y(1).Data`, `.Name`, `.Unit`), Simulink (`signals(1).values`, `.label`).
const NUMBERS: [&str; 5] = ["data", "values", "value", "signal", "samples"];
const NAMES: [&str; 6] = [
    "name",
    "label",
    "signalname",
    "channelname",
    "blockname",
    "title",
];
const UNITS: [&str; 4] = ["unit", "units", "unit_string", "dimension"];

/// Takes name and unit of a signal from the texts beside its numbers.
fn name_by_text(array: &mut Array, texts: &HashMap<String, String>) {
    let Some((parent, field)) = array.path.rsplit_once('.') else {
        return;
    };
    if !NUMBERS.contains(&field.to_ascii_lowercase().as_str()) {
        return;
    }
    let beside = |words: &[&str]| {
        let mut found = words.iter().filter_map(|word| {
            texts.iter().find_map(|(path, text)| {
                let own = path.strip_prefix(parent)?.strip_prefix('.')?;
                let text = text.replace(['"', '\0'], "");
                (own.eq_ignore_ascii_case(word) && !text.trim().is_empty()).then_some(text)
            })
        });
        found.next()
    };
    if let Some(unit) = beside(&UNITS) {
        array.unit = unit;
    }
    match beside(&NAMES) {
        // A point would cut the name short.
        Some(name) => array.path = name.replace('.', "_"),
        None if last_name(parent) == "X" => "time".clone_into(&mut array.path),
        None => {}
    }
}

/// Scalars that tell the sampling.
struct Sampling {
    /// Name of the one that tells the step.
    scalar: String,
    step_s: f64,
    /// Name of the one that tells the first stamp, and it, s.
    start: Option<(String, f64)>,
}

fn sampled(arrays: &[Array]) -> Option<Sampling> {
    let scalars = || {
        arrays.iter().filter_map(|array| {
            let [value] = array.values[..] else {
                return None;
            };
            let name = last_name(&array.path).to_ascii_lowercase();
            value.is_finite().then_some((name, array, value))
        })
    };
    let (scalar, step_s) = scalars().find_map(|(name, array, value)| {
        let step = match name.as_str() {
            name if STEPS.contains(&name) => value,
            name if RATES.contains(&name) => 1.0 / value,
            _ => return None,
        };
        (step.is_finite() && step > 0.0).then(|| (array.path.clone(), step))
    })?;
    let start = scalars().find(|(name, ..)| STARTS.contains(&name.as_str()));
    Some(Sampling {
        scalar,
        step_s,
        start: start.map(|(_, array, value)| (array.path.clone(), value)),
    })
}

fn columns_of(array: Array, columns: &mut Vec<RawColumn>) {
    let Array {
        path,
        unit,
        rows,
        columns: across,
        values,
        origin,
    } = array;
    if rows.max(across) < MIN_ROWS {
        return;
    }
    let mut push = |name: String, values: Vec<f64>| {
        columns.push(RawColumn {
            name,
            unit: unit.clone(),
            values,
            origin,
            base: None,
        });
    };
    if rows.min(across) == 1 {
        push(path, values);
    } else if rows >= across && across <= MOST_CHANNELS {
        for (k, column) in values.chunks_exact(rows).enumerate() {
            push(format!("{path}(:,{})", k + 1), column.to_vec());
        }
    } else if rows <= MOST_CHANNELS {
        for k in 0..rows {
            let row = values.iter().skip(k).step_by(rows).copied();
            push(format!("{path}({},:)", k + 1), row.collect());
        }
    }
}

fn last_name(path: &str) -> &str {
    path.rsplit_once('.').map_or(path, |(_, name)| name)
}

/// Drops the names of structures where the fields tell themselves apart.
fn shorten(columns: &mut [RawColumn]) {
    let mut seen = std::collections::HashMap::new();
    for column in columns.iter() {
        *seen.entry(last_name(&column.name).to_owned()).or_insert(0) += 1;
    }
    for column in columns {
        let short = last_name(&column.name);
        if seen.get(short) == Some(&1) {
            column.name = short.to_owned();
        }
    }
}
