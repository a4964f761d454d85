//! Columns as a file of a measurement program holds them, on the way to a record.

use crate::error::{Place, RecordError, name_list};
use crate::faults::{FormatFault, SelectionFault};
use crate::logger::heading;
use crate::mend::{Columns, finish};
use crate::note::Note;
use crate::record::Origin;
use crate::select::{Heading, ReadOptions, Reading, select, time_column, time_unit};
use crate::{Channel, MAX_ROWS, MIN_ROWS, Unit, UnitKind};

/// A column that only looks like time is even to this share of its step.
const EVEN: f64 = 1e-3;

/// No file is read that holds more numbers: they take 1 GiB.
pub(crate) const MOST_VALUES: usize = 1 << 27;

/// Refuses more numbers than are read.
pub(crate) fn within_limit(values: u64) -> Result<(), FormatFault> {
    if values > MOST_VALUES as u64 {
        return Err(FormatFault::TooMuch {
            most: MOST_VALUES as u64,
            what: "numbers",
        });
    }
    Ok(())
}

/// A column of numbers.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct RawColumn {
    pub(crate) name: String,
    /// Empty if the file has none.
    pub(crate) unit: String,
    pub(crate) values: Vec<f64>,
}

/// A time base that is no column.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Uniform {
    pub(crate) start_s: f64,
    pub(crate) step_s: f64,
    pub(crate) rows: usize,
}

/// What a file holds.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Raw {
    pub(crate) columns: Vec<RawColumn>,
    pub(crate) uniform: Option<Uniform>,
}

/// Makes a record of what is wanted.
pub(crate) fn assemble(
    file: &str,
    name: String,
    raw: Raw,
    options: &ReadOptions,
    mend: bool,
    mut notes: Vec<Note>,
) -> Result<Reading, RecordError> {
    let headings: Vec<Heading> = raw.columns.iter().map(headed).collect();
    let time = time_base(file, &raw, &headings, options, &mut notes)?;
    let mut picks = select(file, &headings, time.column, options, &mut notes)?;
    if options.wanted.is_none() {
        picks.retain(|pick| {
            let (found, needed) = (raw.columns[pick.column].values.len(), time.stamps.len());
            if found != needed {
                notes.push(Note::LeftOut {
                    column: pick.channel.clone(),
                    because: format!("it has {found} values, the time base {needed}"),
                });
            }
            found == needed
        });
    }
    let channels = picks.into_iter().map(|pick| Channel {
        name: pick.channel,
        unit: pick.unit,
        values: raw.columns[pick.column].values.clone(),
    });
    let columns = Columns {
        channels: channels.collect(),
        time: time.stamps,
        time_unit: time.unit,
    };
    let origin = Origin {
        file,
        time_name: &time.name,
        header: Place::Names,
        row: &Place::Row,
    };
    let record = finish(name, &origin, columns, mend, &mut notes)?;
    Ok(Reading { record, notes })
}

/// Name and unit; a unit may stand in the name as in the header of a table.
fn headed(column: &RawColumn) -> Heading {
    if column.unit.is_empty() {
        return heading(&column.name);
    }
    Heading::new(&column.name, &column.unit)
}

struct TimeBase {
    column: Option<usize>,
    name: String,
    stamps: Vec<f64>,
    unit: Unit,
}

fn time_base(
    file: &str,
    raw: &Raw,
    headings: &[Heading],
    options: &ReadOptions,
    notes: &mut Vec<Note>,
) -> Result<TimeBase, RecordError> {
    if let (Some(uniform), None) = (raw.uniform, options.map.time()) {
        if uniform.rows > MAX_ROWS {
            let file = file.to_owned();
            return Err(RecordError::TooManyRows { file });
        }
        let stamps = (0..uniform.rows).map(|k| uniform.start_s + k as f64 * uniform.step_s);
        return Ok(TimeBase {
            column: None,
            name: "t".to_owned(),
            stamps: stamps.collect(),
            unit: Unit::parse("s"),
        });
    }
    let column = match time_column(file, headings, &options.map)? {
        Some(column) => column,
        None => {
            let (column, because) =
                guessed_time(raw, headings).ok_or_else(|| no_time(file, headings))?;
            notes.push(Note::TimeChosen {
                column: headings[column].name.clone(),
                because,
            });
            column
        }
    };
    let heading = &headings[column];
    Ok(TimeBase {
        column: Some(column),
        name: heading.name.clone(),
        stamps: raw.columns[column].values.clone(),
        unit: time_unit(file, heading, &options.map, notes)?,
    })
}

/// The column that can only be the time base although no name says so, and why.
fn guessed_time(raw: &Raw, headings: &[Heading]) -> Option<(usize, &'static str)> {
    let in_time = |k: &usize| Unit::parse(&headings[*k].unit).kind() == UnitKind::Time;
    let mut timed = (0..headings.len()).filter(in_time);
    if let (Some(column), None) = (timed.next(), timed.next()) {
        return Some((column, "it is the only one in a unit of time"));
    }
    let even = raw.columns.iter().position(rises_evenly)?;
    Some((even, "no name tells the time base, and it rises evenly"))
}

fn no_time(file: &str, headings: &[Heading]) -> RecordError {
    let fault = match headings.first() {
        None => SelectionFault::Nothing,
        Some(first) => SelectionFault::NoTime {
            has: name_list(headings.iter().map(|heading| heading.name.as_str())),
            example: first.name.clone(),
        },
    };
    RecordError::Selection {
        file: file.to_owned(),
        fault,
    }
}

fn rises_evenly(column: &RawColumn) -> bool {
    let values = &column.values;
    if values.len() < MIN_ROWS {
        return false;
    }
    let step = (values[values.len() - 1] - values[0]) / (values.len() - 1) as f64;
    step > 0.0
        && values
            .windows(2)
            .all(|pair| (pair[1] - pair[0] - step).abs() <= EVEN * step)
}
