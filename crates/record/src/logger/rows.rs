//! The rows of a table of text.

use super::cells::{Cell, Dialect, classify, split};
use super::layout::{Layout, guess, starts_by_contract};
use super::stamp::{RawStamp, to_seconds};
use super::text::{decode, lines};
use crate::error::{Place, RecordError, name_list, shortened};
use crate::faults::TextFault;
use crate::mend::{Columns, finish};
use crate::note::Note;
use crate::record::Origin;
use crate::select::{Heading, Pick, ReadOptions, Reading, select, time_column, time_unit};
use crate::{Channel, MAX_ROWS, Unit};

/// Reads a table of text whose layout has to be guessed. `name` becomes the name of the record,
/// `file` stands in messages.
pub(crate) fn read_table(
    file: &str,
    name: String,
    bytes: &[u8],
    options: &ReadOptions,
    mend: bool,
) -> Result<Reading, RecordError> {
    let (text, encoding) = decode(file, bytes)?;
    let layout = guess(file, lines(&text))?;
    let mut notes: Vec<Note> = encoding.into_iter().collect();
    let plain = !layout.dialect.decimal_comma && layout.header == 0;
    if !(plain && starts_by_contract(text.as_bytes())) {
        notes.push(Note::Dialect {
            separator: layout.dialect.separated_by(),
            decimal_comma: layout.dialect.decimal_comma,
            header: layout.header as u64 + 1,
            units: layout.units.map(|line| line as u64 + 1),
            undecided: layout.undecided,
        });
    }
    let rows = || lines(&text).enumerate().skip(layout.first_row);
    let time = time_of(file, &layout, rows(), options, &mut notes)?;
    let picks = select(
        file,
        &layout.headings,
        Some(time.column),
        options,
        &mut notes,
    )?;
    let picks = with_numbers(picks, &layout, rows(), options, &mut notes);
    let mut table = Table::new(file, &layout, &time, &picks);
    for (line, text) in rows() {
        table.push(line as u64 + 1, text)?;
    }
    table.record(name, picks, time, mend, notes)
}

/// The time base as the headings and the first row tell it.
struct TimeBase {
    column: usize,
    /// A column of times of day beside a column of dates.
    clock: Option<usize>,
    stamped: bool,
    unit: Unit,
}

fn time_of<'a>(
    file: &str,
    layout: &Layout,
    rows: impl Iterator<Item = (usize, &'a str)>,
    options: &ReadOptions,
    notes: &mut Vec<Note>,
) -> Result<TimeBase, RecordError> {
    let first = first_cells(layout.dialect, rows);
    let stamp = |column: usize| match first.get(column) {
        Some(Cell::Stamp(stamp)) => Some(*stamp),
        _ => None,
    };
    let column = match time_column(file, &layout.headings, &options.map)? {
        Some(column) => column,
        None => {
            let column = (0..layout.headings.len()).find(|&k| stamp(k).is_some());
            let column = column.ok_or_else(|| RecordError::NoTimeColumn {
                file: file.to_owned(),
                line: layout.header as u64 + 1,
                has: name_list(layout.headings.iter().map(|heading| heading.name.as_str())),
            })?;
            notes.push(Note::TimeChosen {
                column: layout.headings[column].name.clone(),
                because: "it holds dates or times of day",
            });
            column
        }
    };
    let Some(found) = stamp(column) else {
        let unit = time_unit(file, &layout.headings[column], &options.map, notes)?;
        return Ok(TimeBase {
            column,
            clock: None,
            stamped: false,
            unit,
        });
    };
    // A date and a time of day in neighbouring columns belong together, whichever is named time.
    let half = |k: usize, clock: bool| {
        let stamp = stamp(k)?;
        (stamp.date.is_none() == clock && stamp.clock.is_some() == clock).then_some(k)
    };
    let date_before = || column.checked_sub(1).and_then(|k| half(k, false));
    let (column, clock) = match (found.date, found.clock) {
        (Some(_), None) => (column, half(column + 1, true)),
        (None, Some(_)) => match date_before() {
            Some(date) => (date, Some(column)),
            None => (column, None),
        },
        _ => (column, None),
    };
    Ok(TimeBase {
        column,
        clock,
        stamped: true,
        unit: Unit::parse("s"),
    })
}

/// What the cells of the first row hold.
fn first_cells<'a>(
    dialect: Dialect,
    mut rows: impl Iterator<Item = (usize, &'a str)>,
) -> Vec<Cell> {
    let row = rows.find(|(_, line)| !line.trim().is_empty());
    let cells = row.and_then(|(_, line)| split(line, dialect.separator));
    let cells = cells.unwrap_or_default();
    cells
        .iter()
        .map(|cell| classify(cell, dialect.decimal_comma))
        .collect()
}

/// Where every column is read, those of words are left out and told.
fn with_numbers<'a>(
    picks: Vec<Pick>,
    layout: &Layout,
    rows: impl Iterator<Item = (usize, &'a str)>,
    options: &ReadOptions,
    notes: &mut Vec<Note>,
) -> Vec<Pick> {
    if options.wanted.is_some() {
        return picks;
    }
    let first = first_cells(layout.dialect, rows);
    let is_number = |cell: Option<&Cell>| matches!(cell, Some(Cell::Number(_) | Cell::Missing));
    picks
        .into_iter()
        .filter(|pick| {
            let mapped = options.map.entry(&pick.channel).is_some();
            let keep = mapped || is_number(first.get(pick.column));
            if !keep {
                notes.push(Note::LeftOut {
                    column: pick.channel.clone(),
                    because: "its first row holds no number".to_owned(),
                });
            }
            keep
        })
        .collect()
}

/// Where the cell of a column goes.
#[derive(Clone, Copy)]
enum Slot {
    Time,
    Clock,
    Channel(usize),
}

/// The rows read so far.
struct Table<'a> {
    file: &'a str,
    dialect: Dialect,
    headings: &'a [Heading],
    header_line: u64,
    slots: Vec<Vec<Slot>>,
    stamped: bool,
    clocked: bool,
    time: Vec<f64>,
    stamps: Vec<RawStamp>,
    first_stamp: String,
    columns: Vec<Vec<f64>>,
    lines: Vec<u32>,
}

impl<'a> Table<'a> {
    fn new(file: &'a str, layout: &'a Layout, time: &TimeBase, picks: &[Pick]) -> Table<'a> {
        let mut slots = vec![Vec::new(); layout.headings.len()];
        slots[time.column].push(Slot::Time);
        if let Some(clock) = time.clock {
            slots[clock].push(Slot::Clock);
        }
        for (index, pick) in picks.iter().enumerate() {
            slots[pick.column].push(Slot::Channel(index));
        }
        Table {
            file,
            dialect: layout.dialect,
            headings: &layout.headings,
            header_line: layout.header as u64 + 1,
            slots,
            stamped: time.stamped,
            clocked: time.clock.is_some(),
            time: Vec::new(),
            stamps: Vec::new(),
            first_stamp: String::new(),
            columns: vec![Vec::new(); picks.len()],
            lines: Vec::new(),
        }
    }

    fn push(&mut self, line: u64, text: &str) -> Result<(), RecordError> {
        // A control-Z ends files of old programs.
        if text
            .trim_matches([' ', '\t', '\r', '\u{1a}', self.dialect.separator])
            .is_empty()
        {
            return Ok(());
        }
        if self.lines.len() == MAX_ROWS {
            return Err(RecordError::TooManyRows {
                file: self.file.to_owned(),
            });
        }
        let cells = split(text, self.dialect.separator).ok_or_else(|| RecordError::OpenQuote {
            file: self.file.to_owned(),
            line,
        })?;
        let needed = self.headings.len();
        let empty_end = cells.len() == needed + 1 && cells[needed].is_empty();
        if cells.len() != needed && !empty_end {
            return Err(RecordError::CellCount {
                file: self.file.to_owned(),
                line,
                found: cells.len(),
                needed,
            });
        }
        for (index, cell) in cells.iter().take(needed).enumerate() {
            for k in 0..self.slots[index].len() {
                self.take(line, index, self.slots[index][k], cell)?;
            }
        }
        self.lines.push(u32::try_from(line).unwrap_or(u32::MAX));
        Ok(())
    }

    fn take(&mut self, line: u64, index: usize, slot: Slot, cell: &str) -> Result<(), RecordError> {
        let held = classify(cell, self.dialect.decimal_comma);
        match (slot, held) {
            (Slot::Time, Cell::Number(value)) if !self.stamped => self.time.push(value),
            (Slot::Time, Cell::Stamp(stamp)) if self.stamped => {
                if self.stamps.is_empty() {
                    self.first_stamp = cell.to_owned();
                }
                self.stamps.push(stamp);
            }
            (Slot::Clock, Cell::Stamp(clock)) if clock.clock.is_some() => {
                if self.stamps.len() == 1 {
                    self.first_stamp += &format!(" {cell}");
                }
                if let Some(stamp) = self.stamps.last_mut() {
                    stamp.clock = clock.clock;
                }
            }
            (Slot::Channel(k), Cell::Number(value)) => self.columns[k].push(value),
            (Slot::Channel(k), Cell::Missing) => self.columns[k].push(f64::NAN),
            _ => return Err(self.not_held(line, index, slot, cell)),
        }
        Ok(())
    }

    fn not_held(&self, line: u64, index: usize, slot: Slot, cell: &str) -> RecordError {
        let (file, column) = (self.file.to_owned(), self.headings[index].name.clone());
        let found = shortened(cell);
        match slot {
            Slot::Time | Slot::Clock if self.stamped => RecordError::Text {
                file,
                fault: TextFault::NotAStamp {
                    line,
                    column,
                    found,
                },
            },
            _ if cell.is_empty() => RecordError::MissingCell { file, line, column },
            _ => RecordError::NotANumber {
                file,
                line,
                column,
                found,
            },
        }
    }

    fn record(
        mut self,
        name: String,
        picks: Vec<Pick>,
        base: TimeBase,
        mend: bool,
        mut notes: Vec<Note>,
    ) -> Result<Reading, RecordError> {
        let time_name = self.headings[base.column].name.clone();
        if self.stamped && !self.stamps.is_empty() {
            self.time = self.seconds(&time_name, &mut notes)?;
        }
        let channels = picks.into_iter().zip(std::mem::take(&mut self.columns));
        let channels = channels
            .map(|(pick, values)| Channel {
                name: pick.channel,
                unit: pick.unit,
                values,
            })
            .collect();
        let lines = &self.lines;
        let line_of = |row: usize| Place::Line(lines.get(row).copied().unwrap_or(0).into());
        let origin = Origin {
            file: self.file,
            time_name: &time_name,
            header: Place::Line(self.header_line),
            row: &line_of,
        };
        let columns = Columns {
            time: std::mem::take(&mut self.time),
            time_unit: base.unit,
            channels,
        };
        let record = finish(name, &origin, columns, mend, &mut notes)?;
        Ok(Reading { record, notes })
    }

    fn seconds(&self, time_name: &str, notes: &mut Vec<Note>) -> Result<Vec<f64>, RecordError> {
        let times = to_seconds(&self.stamps).map_err(|row| RecordError::Text {
            file: self.file.to_owned(),
            fault: TextFault::NoSuchDate {
                line: self.lines.get(row).copied().unwrap_or(0).into(),
                column: time_name.to_owned(),
            },
        })?;
        let column = if self.clocked {
            format!("{time_name} and the column beside it")
        } else {
            time_name.to_owned()
        };
        notes.push(Note::Stamps {
            column: column.clone(),
            form: times.form,
            first: self.first_stamp.clone(),
        });
        if let Some(taken) = times.taken {
            notes.push(Note::DayOrder { column, taken });
        }
        Ok(times.seconds)
    }
}
