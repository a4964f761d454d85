//! Reading a record from CSV text.

use std::io::{BufRead, BufReader, Read};
use std::path::Path;

use crate::Channel;
use crate::csv_header::{Header, Wanted, check_separator, parse_header};
use crate::error::{Place, RecordError};
use crate::file::{BUFFER_BYTES, opened};
use crate::limits::{MAX_LINE_BYTES, MAX_ROWS};
use crate::record::{Origin, Record};
use crate::words::shortened;

const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";

/// Reads a record from a CSV file.
///
/// The header is `t [s],u [N],y1 [m]`: a name and a unit in brackets per column, one of them
/// named `t` or `time` (any case) or the first one in a unit of time. Rows hold as many numbers,
/// with a point as decimal sign. A byte order mark, CRLF, spaces around cells, quoted cells and
/// empty lines are accepted. The record is named after the file.
///
/// # Errors
///
/// Any of [`RecordError`], with the path as given, the line and the column.
pub fn read_csv(path: &Path) -> Result<Record, RecordError> {
    read(path, None)
}

/// Reads the time column and the named columns of a CSV file; further columns are ignored
/// whatever they hold. Faster than [`read_csv`] where the file has many more columns.
///
/// # Errors
///
/// As [`read_csv`], and [`RecordError::MissingColumn`] when one of the names is not in the header.
pub fn read_csv_channels(path: &Path, names: &[&str]) -> Result<Record, RecordError> {
    read_csv_some(path, names, &[])
}

/// As [`read_csv_channels`], with further columns that are read if they are there: a record of
/// inputs alone is enough to drive a model, and its outputs are welcome.
///
/// # Errors
///
/// As [`read_csv_channels`]; only a missing column of `needed` is an error.
pub fn read_csv_some(
    path: &Path,
    needed: &[&str],
    welcome: &[&str],
) -> Result<Record, RecordError> {
    read(path, Some(Wanted { needed, welcome }))
}

/// Reads a record from CSV text, as [`read_csv`]; `name` names the record and stands for the file
/// in messages.
///
/// # Errors
///
/// Any of [`RecordError`], with the name, the line and the column.
pub fn parse_csv(name: &str, text: impl Read) -> Result<Record, RecordError> {
    let text = BufReader::with_capacity(BUFFER_BYTES, text);
    Reader::new(name, text).record(name.to_owned(), None)
}

fn read(path: &Path, wanted: Option<Wanted<'_>>) -> Result<Record, RecordError> {
    let label = path.display().to_string();
    let (file, name) = opened(path, &label)?;
    let text = BufReader::with_capacity(BUFFER_BYTES, file);
    Reader::new(&label, text).record(name, wanted)
}

/// Lines of a file with their numbers.
///
/// The lines are split here and only a line with a quotation mark goes through the csv crate: its
/// reader counts CRLF lines one late, and a message must name the right line.
pub(crate) struct Reader<'a, R> {
    label: &'a str,
    text: R,
    buffer: Vec<u8>,
    line: u64,
}

/// Blank lines between rows: `count` of them before row `row`.
struct Blank {
    row: usize,
    count: u64,
}

impl<'a, R: BufRead> Reader<'a, R> {
    pub(crate) fn new(label: &'a str, text: R) -> Self {
        Reader {
            label,
            text,
            buffer: Vec::new(),
            line: 0,
        }
    }

    fn file(&self) -> String {
        self.label.to_owned()
    }

    /// Takes the next line into the buffer, without its end; false after the last one.
    fn advance(&mut self) -> Result<bool, RecordError> {
        self.buffer.clear();
        let limit = MAX_LINE_BYTES as u64 + 1;
        let taken = (&mut self.text)
            .take(limit)
            .read_until(b'\n', &mut self.buffer);
        let label = self.label;
        let refused = |source| RecordError::Unreadable {
            file: label.to_owned(),
            source,
        };
        if taken.map_err(refused)? == 0 {
            return Ok(false);
        }
        self.line += 1;
        if self.buffer.len() > MAX_LINE_BYTES {
            return Err(RecordError::LongLine {
                file: self.file(),
                line: self.line,
            });
        }
        if self.line == 1 && self.buffer.starts_with(BYTE_ORDER_MARK) {
            self.buffer.drain(..BYTE_ORDER_MARK.len());
        }
        Ok(true)
    }

    /// The line in the buffer.
    fn text(&self) -> Result<&str, RecordError> {
        match std::str::from_utf8(&self.buffer) {
            Ok(text) => Ok(text.trim_ascii()),
            Err(_) => Err(RecordError::NotUtf8 {
                file: self.file(),
                line: self.line,
            }),
        }
    }

    /// The cells of a line with quotation marks.
    fn quoted_cells(&self, line: &str) -> Result<Vec<String>, RecordError> {
        // A quote left open would swallow the end of the line: the mark put there then shows up.
        const END: &str = "\nend";
        let text = format!("{line}{END}");
        let mut reader = csv::ReaderBuilder::new()
            .has_headers(false)
            .flexible(true)
            .trim(csv::Trim::All)
            .from_reader(text.as_bytes());
        let mut rows = reader.records();
        let open = || RecordError::OpenQuote {
            file: self.file(),
            line: self.line,
        };
        match (rows.next(), rows.next()) {
            (Some(Ok(row)), Some(Ok(_))) => Ok(row.iter().map(unquoted).collect()),
            _ => Err(open()),
        }
    }

    fn header(&mut self, wanted: Option<Wanted<'_>>) -> Result<Header, RecordError> {
        while self.advance()? {
            let text = self.text()?;
            if text.is_empty() {
                continue;
            }
            check_separator(self.label, self.line, text)?;
            let cells = if text.contains('"') {
                self.quoted_cells(text)?
            } else {
                text.split(',').map(str::to_owned).collect()
            };
            return parse_header(self.label, self.line, &cells, wanted);
        }
        Err(RecordError::Empty { file: self.file() })
    }

    pub(crate) fn record(
        mut self,
        name: String,
        wanted: Option<Wanted<'_>>,
    ) -> Result<Record, RecordError> {
        let header = self.header(wanted)?;
        let mut table = Table::new(&header);
        let mut blanks: Vec<Blank> = Vec::new();
        while self.advance()? {
            let text = self.text()?;
            if text.is_empty() {
                match blanks.last_mut() {
                    Some(last) if last.row == table.rows => last.count += 1,
                    _ => blanks.push(Blank {
                        row: table.rows,
                        count: 1,
                    }),
                }
                continue;
            }
            if table.rows == MAX_ROWS {
                return Err(RecordError::TooManyRows { file: self.file() });
            }
            let parsed = if text.contains('"') {
                let cells = self.quoted_cells(text)?;
                table.push(cells.iter().map(String::as_str))
            } else {
                table.push(text.split(','))
            };
            parsed.map_err(|fault| fault.at(self.file(), self.line, &header))?;
        }
        let line_of = |row: usize| {
            let skipped: u64 = blanks
                .iter()
                .filter(|b| b.row <= row)
                .map(|b| b.count)
                .sum();
            Place::Line(header.line + 1 + row as u64 + skipped)
        };
        let origin = Origin {
            file: self.label,
            time_name: &header.time.name,
            header: Place::Line(header.line),
            row: &line_of,
        };
        let Table { time, columns, .. } = table;
        let channels = header
            .channels
            .iter()
            .zip(columns)
            .map(|(column, values)| Channel {
                name: column.name.clone(),
                unit: column.unit.clone(),
                values,
            });
        Record::from_file(name, &origin, &header.time.unit, time, channels.collect())
    }
}

/// A cell without the quotation marks that spaces before them hid from the csv crate.
fn unquoted(cell: &str) -> String {
    let inner = cell
        .strip_prefix('"')
        .and_then(|rest| rest.strip_suffix('"'));
    inner.unwrap_or(cell).trim().to_owned()
}

/// Where the cell of a column goes.
#[derive(Clone, Copy)]
enum Slot {
    Ignored,
    Time,
    Channel(usize),
}

/// The numbers read so far.
struct Table {
    slots: Vec<Slot>,
    time: Vec<f64>,
    columns: Vec<Vec<f64>>,
    rows: usize,
}

/// What is wrong with a row.
enum RowFault {
    Count(usize),
    Missing(usize),
    Text(usize, String),
    NotFinite(usize, String),
}

impl Table {
    fn new(header: &Header) -> Table {
        let mut slots = vec![Slot::Ignored; header.width];
        slots[header.time.index] = Slot::Time;
        for (slot, channel) in header.channels.iter().enumerate() {
            slots[channel.index] = Slot::Channel(slot);
        }
        let columns = vec![Vec::new(); header.channels.len()];
        Table {
            slots,
            time: Vec::new(),
            columns,
            rows: 0,
        }
    }

    fn push<'a>(&mut self, cells: impl Iterator<Item = &'a str> + Clone) -> Result<(), RowFault> {
        let count = || cells.clone().count();
        let mut row = cells.clone();
        for (index, &slot) in self.slots.iter().enumerate() {
            let Some(cell) = row.next() else {
                return Err(RowFault::Count(count()));
            };
            match slot {
                Slot::Ignored => {}
                Slot::Time => self
                    .time
                    .push(number(cell, index, &count, self.slots.len())?),
                Slot::Channel(k) => {
                    self.columns[k].push(number(cell, index, &count, self.slots.len())?);
                }
            }
        }
        if row.next().is_some() {
            return Err(RowFault::Count(count()));
        }
        self.rows += 1;
        Ok(())
    }
}

/// The number in a cell. A wrong number of cells shifts the columns, so it is told first.
fn number(
    cell: &str,
    index: usize,
    count: &dyn Fn() -> usize,
    width: usize,
) -> Result<f64, RowFault> {
    let cell = cell.trim_ascii();
    match cell.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        _ if count() != width => Err(RowFault::Count(count())),
        Ok(_) => Err(RowFault::NotFinite(index, shortened(cell))),
        Err(_) if cell.is_empty() => Err(RowFault::Missing(index)),
        Err(_) => Err(RowFault::Text(index, shortened(cell))),
    }
}

impl RowFault {
    fn at(self, file: String, line: u64, header: &Header) -> RecordError {
        let name = |index: usize| {
            let all = std::iter::once(&header.time).chain(&header.channels);
            let named = all.into_iter().find(|column| column.index == index);
            named.map_or_else(|| (index + 1).to_string(), |column| column.name.clone())
        };
        match self {
            RowFault::Count(found) => RecordError::CellCount {
                file,
                line,
                found,
                needed: header.width,
            },
            RowFault::Missing(index) => RecordError::MissingCell {
                file,
                line,
                column: name(index),
            },
            RowFault::Text(index, found) => RecordError::NotANumber {
                file,
                line,
                column: name(index),
                found,
            },
            RowFault::NotFinite(index, found) => {
                let at = Place::Line(line);
                RecordError::NotFinite {
                    file,
                    at,
                    column: name(index),
                    found,
                }
            }
        }
    }
}
