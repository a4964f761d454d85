//! The header line: which column is what.

use crate::Unit;
use crate::error::{Place, RecordError};
use crate::words::{name_list, shortened};

/// A column that is read.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Column {
    pub(crate) name: String,
    pub(crate) unit: Unit,
    /// Index of the column in the file.
    pub(crate) index: usize,
}

/// The columns of a file that are read.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Header {
    pub(crate) line: u64,
    /// Columns in the file, read or not.
    pub(crate) width: usize,
    pub(crate) time: Column,
    pub(crate) channels: Vec<Column>,
}

/// The columns asked for, beside the time column.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Wanted<'a> {
    /// Must be there.
    pub(crate) needed: &'a [&'a str],
    /// Read if they are there.
    pub(crate) welcome: &'a [&'a str],
}

impl Wanted<'_> {
    fn has(&self, name: &str) -> bool {
        self.needed.contains(&name) || self.welcome.contains(&name)
    }
}

/// A header cell taken apart: `y1 [mm]`.
struct Cell<'a> {
    text: &'a str,
    name: &'a str,
    unit: Option<&'a str>,
}

impl<'a> Cell<'a> {
    fn parse(text: &'a str) -> Cell<'a> {
        let text = text.trim();
        let split = text
            .strip_suffix(']')
            .and_then(|rest| rest.rsplit_once('['));
        match split {
            Some((name, unit)) => {
                let (name, unit) = (name.trim(), unit.trim());
                let unit = (!unit.is_empty() && !name.is_empty()).then_some(unit);
                Cell { text, name, unit }
            }
            None => Cell {
                text,
                name: text,
                unit: None,
            },
        }
    }

    fn is_time(&self) -> bool {
        self.name.eq_ignore_ascii_case("t") || self.name.eq_ignore_ascii_case("time")
    }
}

/// Reads the header. With `wanted`, only the time column and the columns of these names have to
/// be in order; all others are ignored.
pub(crate) fn parse_header(
    file: &str,
    line: u64,
    cells: &[String],
    wanted: Option<Wanted<'_>>,
) -> Result<Header, RecordError> {
    let cells: Vec<Cell<'_>> = cells.iter().map(|cell| Cell::parse(cell)).collect();
    let time_index = time_column(file, line, &cells)?;
    let time = column(file, line, &cells, time_index)?;
    let mut channels: Vec<Column> = Vec::with_capacity(cells.len() - 1);
    for (index, cell) in cells.iter().enumerate() {
        if index == time_index || wanted.is_some_and(|names| !names.has(cell.name)) {
            continue;
        }
        let found = column(file, line, &cells, index)?;
        let same = |other: &&Column| other.name == found.name;
        if let Some(first) = std::iter::once(&time).chain(&channels).find(same) {
            return Err(RecordError::DuplicateColumn {
                file: file.to_owned(),
                at: Place::Line(line),
                name: found.name,
                first: first.index + 1,
                second: index + 1,
            });
        }
        channels.push(found);
    }
    for name in wanted.map_or(&[][..], |names| names.needed) {
        if !channels.iter().any(|channel| channel.name == *name) {
            return Err(RecordError::MissingColumn {
                file: file.to_owned(),
                wanted: (*name).to_owned(),
                has: name_list(cells.iter().map(|cell| cell.name)),
            });
        }
    }
    Ok(Header {
        line,
        width: cells.len(),
        time,
        channels,
    })
}

/// The column named t or time, or else a first column whose unit is a time.
fn time_column(file: &str, line: u64, cells: &[Cell<'_>]) -> Result<usize, RecordError> {
    let named = cells.iter().position(Cell::is_time);
    let by_unit = || {
        let unit = cells.first()?.unit?;
        (Unit::parse(unit).kind() == crate::UnitKind::Time).then_some(0)
    };
    let index = named
        .or_else(by_unit)
        .ok_or_else(|| RecordError::NoTimeColumn {
            file: file.to_owned(),
            line,
            has: name_list(cells.iter().map(|cell| cell.text)),
        })?;
    match cells[index].unit {
        Some(unit) if Unit::parse(unit).kind() != crate::UnitKind::Time => {
            Err(RecordError::TimeUnit {
                file: file.to_owned(),
                line,
                name: shortened(cells[index].name),
                unit: shortened(unit),
            })
        }
        _ => Ok(index),
    }
}

fn column(file: &str, line: u64, cells: &[Cell<'_>], index: usize) -> Result<Column, RecordError> {
    let cell = &cells[index];
    match cell.unit {
        Some(unit) => Ok(Column {
            name: cell.name.to_owned(),
            unit: Unit::parse(unit),
            index,
        }),
        None => Err(RecordError::MissingUnit {
            file: file.to_owned(),
            line,
            column: index + 1,
            found: shortened(cell.text),
        }),
    }
}

/// Refuses a header whose cells or lines are separated by something else.
pub(crate) fn check_separator(file: &str, line: u64, header: &str) -> Result<(), RecordError> {
    let one_cell = !header.contains(',');
    let (found, needed) = if header.contains('\r') {
        ("carriage returns alone at the ends of lines", "line feeds")
    } else if one_cell && header.contains(';') {
        ("semicolons", "commas")
    } else if one_cell && header.contains('\t') {
        ("tabs", "commas")
    } else {
        return Ok(());
    };
    Err(RecordError::Separator {
        file: file.to_owned(),
        line,
        found,
        needed,
    })
}
