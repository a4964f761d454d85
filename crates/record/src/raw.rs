//! Columns as a file of a measurement program holds them, on the way to a record.

use crate::base::{self, Base, shared_rows};
use crate::clock::{Stamps, clocked};
use crate::error::{Place, RecordError};
use crate::faults::{FormatFault, SelectionFault};
use crate::heading::{Heading, heading};
use crate::mend::{Columns, finish};
use crate::note::Note;
use crate::record::Origin;
use crate::select::{Pick, ReadOptions, Reading, select, time_column};
use crate::words::{name_list, shortened};
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
    /// What the values are counted from: integers beyond 2^53 keep their differences so.
    pub(crate) origin: f64,
    /// Index of its time base, where it has one of its own.
    pub(crate) base: Option<usize>,
}

impl RawColumn {
    fn channel_values(&self) -> Vec<f64> {
        if self.origin == 0.0 {
            return self.values.clone();
        }
        self.values
            .iter()
            .map(|value| value + self.origin)
            .collect()
    }
}

/// What a file holds.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Raw {
    pub(crate) columns: Vec<RawColumn>,
    /// Time bases that are no columns.
    pub(crate) bases: Vec<Base>,
}

impl Raw {
    /// The index of a time base, which is added if no like one is there.
    pub(crate) fn base(&mut self, base: Base) -> usize {
        if let Some(at) = self.bases.iter().position(|other| other.is_like(&base)) {
            return at;
        }
        self.bases.push(base);
        self.bases.len() - 1
    }
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
    if !options.columns.is_empty() {
        return Err(RecordError::Selection {
            file: file.to_owned(),
            fault: SelectionFault::ColumnsOfNoTable,
        });
    }
    let headings: Vec<Heading> = raw.columns.iter().map(headed).collect();
    let based = !raw.bases.is_empty() && options.map.time().is_none();
    let columns = if based {
        on_bases(file, &raw, &headings, options, mend, &mut notes)?
    } else {
        on_a_column(file, &raw, &headings, options, &mut notes)?
    };
    let time_name = columns.time_name.clone();
    let origin = Origin {
        file,
        time_name: &time_name,
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

/// The columns on the time base of one of them, or on the one that a map names.
fn on_a_column(
    file: &str,
    raw: &Raw,
    headings: &[Heading],
    options: &ReadOptions,
    notes: &mut Vec<Note>,
) -> Result<Columns, RecordError> {
    let column = match time_column(file, headings, &options.map)? {
        Some(column) => column,
        None => {
            let guess = guessed_time(raw, headings);
            let (column, because) = guess.ok_or_else(|| no_time(file, headings, notes))?;
            notes.push(Note::TimeChosen {
                column: headings[column].name.clone(),
                because,
            });
            column
        }
    };
    let (heading, found) = (&headings[column], &raw.columns[column]);
    let stamps = Stamps {
        values: found.values.clone(),
        origin: found.origin,
    };
    let (time, time_unit) = clocked(file, heading, &options.map, stamps, notes)?;
    let picks = select(file, headings, Some(column), options, notes)?;
    let picks = of_length(raw, picks, time.len(), options, notes);
    Ok(Columns {
        channels: picks.into_iter().map(|pick| channel(raw, pick)).collect(),
        time,
        time_unit,
        time_name: heading.name.clone(),
    })
}

fn channel(raw: &Raw, pick: Pick) -> Channel {
    Channel {
        values: raw.columns[pick.column].channel_values(),
        name: pick.channel,
        unit: pick.unit,
    }
}

/// Where every column is read, those of another length are left out and told.
fn of_length(
    raw: &Raw,
    mut picks: Vec<Pick>,
    needed: usize,
    options: &ReadOptions,
    notes: &mut Vec<Note>,
) -> Vec<Pick> {
    if options.wanted.is_none() {
        picks.retain(|pick| {
            let found = raw.columns[pick.column].values.len();
            if found != needed {
                notes.push(Note::LeftOut {
                    column: pick.channel.clone(),
                    because: format!("it has {found} values, the time base {needed}"),
                });
            }
            found == needed
        });
    }
    picks
}

/// The columns on time bases that are none of them.
fn on_bases(
    file: &str,
    raw: &Raw,
    headings: &[Heading],
    options: &ReadOptions,
    mend: bool,
    notes: &mut Vec<Note>,
) -> Result<Columns, RecordError> {
    let picks = select(file, headings, None, options, notes)?;
    let reference = reference(raw, &picks, options.wanted.is_some());
    let rows = raw.bases[reference].rows();
    if rows > MAX_ROWS {
        let file = file.to_owned();
        return Err(RecordError::TooManyRows { file });
    }
    let base_of = |pick: &Pick| raw.columns[pick.column].base.unwrap_or(reference);
    let picks = aligned_picks(raw, picks, reference, options, notes);
    let mut time = raw.bases[reference].stamps();
    let others = picks.iter().any(|pick| base_of(pick) != reference);
    let mut range = (0, rows);
    if others {
        let bases = picks.iter().map(|pick| &raw.bases[base_of(pick)]);
        let shared = shared_rows(&time, bases);
        range = shared.ok_or_else(|| apart(file, &picks))?;
        time = time[range.0..range.1].to_vec();
    }
    let mut channels = Vec::with_capacity(picks.len());
    for pick in picks {
        let own = base_of(&pick);
        let column = &raw.columns[pick.column];
        let found = column.values.len();
        if own == reference {
            let mut channel = channel(raw, pick);
            if others && found == rows {
                channel.values = channel.values[range.0..range.1].to_vec();
            }
            channels.push(channel);
            continue;
        }
        let (values, interpolated) = base::at(&raw.bases[own], &column.values, &time);
        if interpolated && !mend {
            return Err(RecordError::Selection {
                file: file.to_owned(),
                fault: SelectionFault::OtherStamps {
                    column: pick.channel,
                },
            });
        }
        notes.push(Note::Aligned {
            channel: pick.channel.clone(),
            late_s: start_of(&raw.bases[own]) - start_of(&raw.bases[reference]),
            interpolated,
            rows: time.len(),
        });
        channels.push(Channel {
            name: pick.channel,
            unit: pick.unit,
            values,
        });
    }
    let start = time.first().copied().unwrap_or(0.0);
    if start.abs() >= COUNTED_FROM_S {
        time.iter_mut().for_each(|t| *t -= start);
    }
    Ok(Columns {
        time,
        time_unit: Unit::parse("s"),
        channels,
        time_name: "t".to_owned(),
    })
}

/// Seconds since 1904 or 1970 are no time of a run.
const COUNTED_FROM_S: f64 = 1e8;

fn start_of(base: &Base) -> f64 {
    match base {
        Base::Even(even) => even.start_s,
        Base::Stamps(stamps) => stamps.first().copied().unwrap_or(0.0),
    }
}

/// The finest time base of what is wanted; where everything is read, that of most columns.
fn reference(raw: &Raw, picks: &[Pick], wanted: bool) -> usize {
    let bases = || {
        picks
            .iter()
            .filter_map(|pick| raw.columns[pick.column].base)
    };
    let count = |base: usize| bases().filter(|&other| other == base).count();
    let step = |base: usize| raw.bases[base].mean_step();
    let mut all: Vec<usize> = bases().collect();
    all.sort_unstable();
    all.dedup();
    if !wanted {
        let most = all.iter().map(|&base| count(base)).max();
        all.retain(|&base| Some(count(base)) == most);
    }
    // Of equal ones the first.
    let finest = all
        .iter()
        .map(|&base| step(base))
        .fold(f64::INFINITY, f64::min);
    let best = all
        .into_iter()
        .find(|&base| step(base) <= finest * (1.0 + 1e-6));
    best.unwrap_or(0)
}

/// Where every column is read, those that share too little time with the reference are left out.
fn aligned_picks(
    raw: &Raw,
    mut picks: Vec<Pick>,
    reference: usize,
    options: &ReadOptions,
    notes: &mut Vec<Note>,
) -> Vec<Pick> {
    if options.wanted.is_some() {
        return picks;
    }
    let stamps = raw.bases[reference].stamps();
    let rows = stamps.len();
    let mut left_out = |pick: &Pick, because: String| {
        notes.push(Note::LeftOut {
            column: pick.channel.clone(),
            because,
        });
        false
    };
    picks.retain(|pick| {
        let column = &raw.columns[pick.column];
        let found = column.values.len();
        match column.base {
            Some(base) if base != reference => {
                let shared = shared_rows(&stamps, std::iter::once(&raw.bases[base]));
                // The record is not cut to a small part of itself for the sake of one channel.
                match shared {
                    Some((start, end)) if 2 * (end - start) >= rows => true,
                    _ => left_out(
                        pick,
                        "its own time base lies apart from that of most".to_owned(),
                    ),
                }
            }
            _ if found == rows => true,
            _ => left_out(pick, format!("it has {found} values, the time base {rows}")),
        }
    });
    picks
}

fn apart(file: &str, picks: &[Pick]) -> RecordError {
    RecordError::Selection {
        file: file.to_owned(),
        fault: SelectionFault::Apart {
            columns: name_list(picks.iter().map(|pick| pick.channel.as_str())),
        },
    }
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

fn no_time(file: &str, headings: &[Heading], notes: &[Note]) -> RecordError {
    let fault = match headings.first() {
        None => SelectionFault::Nothing {
            left_out: left_out(notes),
        },
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

/// What was left out and why, for the message about a file of which nothing is left.
fn left_out(notes: &[Note]) -> String {
    const SHOWN: usize = 3;
    let told = |note: &Note| match note {
        Note::LeftOut { column, because } => Some(format!("'{}': {because}", shortened(column))),
        _ => None,
    };
    let all: Vec<String> = notes.iter().filter_map(told).collect();
    if all.is_empty() {
        return String::new();
    }
    let more = if all.len() > SHOWN { "; ..." } else { "" };
    format!(
        " (left out are {}{more})",
        all[..all.len().min(SHOWN)].join("; ")
    )
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
