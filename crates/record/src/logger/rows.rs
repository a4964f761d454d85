//! The rows of a table of text.

use super::cells::{Cell, Dialect, classify, split};
use super::layout::{Known, guess, starts_by_contract};
use super::programs;
use super::stamp::{RawStamp, to_seconds};
use super::table::Layout;
use super::text::{decode, lines};
use super::time_of::{TimeBase, first_cells, time_of};
use crate::clock::{Stamps, clocked};
use crate::error::{Place, RecordError};
use crate::faults::TextFault;
use crate::heading::Heading;
use crate::mend::{Columns, finish};
use crate::note::Note;
use crate::raw::assemble;
use crate::record::Origin;
use crate::select::{Pick, ReadOptions, Reading, select};
use crate::words::shortened;
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
    let mut notes: Vec<Note> = encoding.into_iter().collect();
    if options.columns.is_empty()
        && let Some(raw) = programs::read(file, &text, &mut notes)?
    {
        return assemble(file, name, raw, options, mend, notes);
    }
    let known = Known {
        columns: &options.columns,
        ..Known::default()
    };
    read_text(file, name, &text, options, mend, known, notes)
}

/// Reads a sheet of a workbook, which stands as text: tabs between cells, points in numbers.
#[cfg(feature = "xlsx")]
pub(crate) fn read_sheet(
    file: &str,
    name: String,
    text: &str,
    options: &ReadOptions,
    mend: bool,
    note: Note,
) -> Result<Reading, RecordError> {
    let known = Known {
        dialect: Some(Dialect {
            separator: '\t',
            decimal_comma: false,
        }),
        columns: &options.columns,
    };
    read_text(file, name, text, options, mend, known, vec![note])
}

fn read_text(
    file: &str,
    name: String,
    text: &str,
    options: &ReadOptions,
    mend: bool,
    known: Known<'_>,
    mut notes: Vec<Note>,
) -> Result<Reading, RecordError> {
    let layout = guess(file, lines(text), known)?;
    let plain = !layout.dialect.decimal_comma && layout.header == Some(0);
    if !(plain && starts_by_contract(text.as_bytes())) && known.dialect.is_none() {
        notes.push(Note::Dialect {
            separator: layout.dialect.separated_by(),
            decimal_comma: layout.dialect.decimal_comma,
            header: layout.header.map_or(0, |line| line as u64 + 1),
            units: layout.units.map(|line| line as u64 + 1),
            undecided: layout.undecided,
        });
    }
    let rows = || lines(text).enumerate().skip(layout.first_row);
    let before = || lines(text).take(layout.first_row);
    let time = time_of(file, &layout, rows(), before(), options, &mut notes)?;
    let picks = select(file, &layout.headings, time.column, options, &mut notes)?;
    let picks = with_numbers(picks, &layout, rows(), options, &mut notes);
    let mut table = Table::new(file, &layout, &time, &picks);
    for (line, text) in rows() {
        table.push(line as u64 + 1, text)?;
    }
    table.record(name, picks, time, (options, mend), notes)
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
    /// Whole part of the first stamp, where it has too many digits for a double.
    origin: Option<i64>,
    stamps: Vec<RawStamp>,
    first_stamp: String,
    columns: Vec<Vec<f64>>,
    lines: Vec<u32>,
}

impl<'a> Table<'a> {
    fn new(file: &'a str, layout: &'a Layout, time: &TimeBase, picks: &[Pick]) -> Table<'a> {
        let mut slots = vec![Vec::new(); layout.headings.len()];
        if let Some(column) = time.column {
            slots[column].push(Slot::Time);
        }
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
            header_line: layout.header.unwrap_or(layout.first_row) as u64 + 1,
            slots,
            stamped: time.stamped,
            clocked: time.clock.is_some(),
            time: Vec::new(),
            origin: None,
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
            (Slot::Time, Cell::Number(value)) if !self.stamped => self.count(cell, value),
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

    /// Takes a stamp. Counts since 1970 have more digits than a double: the whole part of the first
    /// is taken off before they become one.
    fn count(&mut self, cell: &str, value: f64) {
        const LONG: f64 = 1e9;
        let (whole, part) = cell.split_once(['.', ',']).unwrap_or((cell, ""));
        let whole = whole.parse::<i64>().ok();
        if self.time.is_empty() && value >= LONG {
            self.origin = whole;
        }
        let Some(origin) = self.origin else {
            self.time.push(value);
            return;
        };
        let part = format!("0.{part}").parse::<f64>();
        self.time.push(match (whole, part) {
            (Some(whole), Ok(part)) => (i128::from(whole) - i128::from(origin)) as f64 + part,
            _ => value - origin as f64,
        });
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
        (options, mend): (&ReadOptions, bool),
        mut notes: Vec<Note>,
    ) -> Result<Reading, RecordError> {
        let heading = base.column.map(|column| &self.headings[column]);
        let time_name = heading.map_or_else(|| "t".to_owned(), |heading| heading.name.clone());
        let mut time = std::mem::take(&mut self.time);
        let mut time_unit = Unit::parse("s");
        if self.stamped && !self.stamps.is_empty() {
            time = self.seconds(&time_name, &mut notes)?;
        } else if let Some(heading) = heading {
            let stamps = Stamps {
                values: time,
                origin: self.origin.unwrap_or(0) as f64,
            };
            (time, time_unit) = clocked(self.file, heading, &options.map, stamps, &mut notes)?;
        } else {
            time = (0..self.lines.len())
                .map(|k| k as f64 * base.step_s)
                .collect();
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
            time,
            time_unit,
            channels,
            time_name: time_name.clone(),
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
