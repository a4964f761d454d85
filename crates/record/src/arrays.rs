//! Numeric arrays of a workspace, as MATLAB saves it, to columns.

use crate::MIN_ROWS;
use crate::note::Note;
use crate::raw::{Raw, RawColumn, Uniform};

/// A matrix of more channels than this is no table.
const MOST_CHANNELS: usize = 256;
/// What a scalar that holds the sample time is called, and one that holds the sample rate.
const STEPS: [&str; 4] = ["dt", "ts", "sample_time", "sampletime"];
const RATES: [&str; 4] = ["fs", "f_s", "sample_rate", "samplerate"];
/// What time is called in a workspace beside `t` and `time`.
const TIMES: [&str; 4] = ["t", "time", "tout", "zeit"];

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
}

/// Vectors become columns under their names, matrices one column for each channel: `data(:,2)`,
/// or `data(2,:)` where the rows are the channels. The name of a field stands alone where no other
/// has it.
pub(crate) fn to_raw(arrays: Vec<Array>, notes: &mut Vec<Note>) -> Raw {
    let uniform = sampled(&arrays);
    let mut columns: Vec<RawColumn> = Vec::new();
    for array in arrays {
        columns_of(array, &mut columns);
    }
    shorten(&mut columns);
    let timed = |column: &RawColumn| TIMES.iter().any(|t| column.name.eq_ignore_ascii_case(t));
    let mut raw = Raw {
        uniform: None,
        columns,
    };
    let longest = raw.columns.iter().map(|column| column.values.len()).max();
    if let (Some((scalar, step_s)), Some(rows)) = (uniform, longest)
        && !raw.columns.iter().any(timed)
    {
        notes.push(Note::TimeChosen {
            column: scalar,
            because: "it is the only word on time in the file, and names the sampling",
        });
        raw.uniform = Some(Uniform {
            start_s: 0.0,
            step_s,
            rows,
        });
    }
    raw
}

/// A scalar that tells the sampling, and the step it tells.
fn sampled(arrays: &[Array]) -> Option<(String, f64)> {
    arrays.iter().find_map(|array| {
        let [value] = array.values[..] else {
            return None;
        };
        let name = last_name(&array.path).to_ascii_lowercase();
        let step = match name.as_str() {
            name if STEPS.contains(&name) => value,
            name if RATES.contains(&name) => 1.0 / value,
            _ => return None,
        };
        (step.is_finite() && step > 0.0).then(|| (array.path.clone(), step))
    })
}

fn columns_of(array: Array, columns: &mut Vec<RawColumn>) {
    let Array {
        path,
        unit,
        rows,
        columns: across,
        values,
    } = array;
    if rows.max(across) < MIN_ROWS {
        return;
    }
    let mut push = |name: String, values: Vec<f64>| {
        columns.push(RawColumn {
            name,
            unit: unit.clone(),
            values,
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
