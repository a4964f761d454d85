//! The layout of a table fixture, and the look-up of its cells.

use serde::Deserialize;

use crate::{HarmonicList, PrintedValue, Source, TableError, Unit};

const SCHEMA: &str = "simgap-paper-table/1";

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct RawTable {
    schema: String,
    table: u8,
    #[serde(rename = "section")]
    _section: String,
    #[serde(rename = "title")]
    _title: String,
    cells: Vec<RawCell>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct RawCell {
    table: u8,
    section: String,
    row: String,
    column: String,
    unit: String,
    printed: String,
}

/// The cells of one fixture.
pub(crate) struct Cells {
    file: String,
    cells: Vec<RawCell>,
}

impl Cells {
    /// Reads a fixture and checks that every cell claims the right table.
    pub(crate) fn parse(file: &str, number: u8, text: &str) -> Result<Self, TableError> {
        let raw: RawTable = toml::from_str(text).map_err(|error| TableError::Layout {
            file: file.to_owned(),
            reason: error.message().to_owned(),
        })?;
        if raw.schema != SCHEMA {
            return Err(TableError::Schema {
                file: file.to_owned(),
                found: raw.schema,
                needed: SCHEMA,
            });
        }
        let wrong = |found: u8, place: String| TableError::WrongTable {
            file: file.to_owned(),
            place,
            found,
            needed: number,
        };
        if raw.table != number {
            return Err(wrong(raw.table, "the file".to_owned()));
        }
        if let Some(cell) = raw.cells.iter().find(|cell| cell.table != number) {
            return Err(wrong(cell.table, place(&cell.row, &cell.column)));
        }
        Ok(Self {
            file: file.to_owned(),
            cells: raw.cells,
        })
    }

    fn find(&self, row: &str, column: &str) -> Result<&RawCell, TableError> {
        let mut found = self
            .cells
            .iter()
            .filter(|cell| cell.row == row && cell.column == column);
        let cell = found.next().ok_or_else(|| TableError::Missing {
            file: self.file.clone(),
            place: place(row, column),
        })?;
        if found.next().is_some() {
            return Err(TableError::Duplicate {
                file: self.file.clone(),
                place: place(row, column),
            });
        }
        Ok(cell)
    }

    /// The number in a cell.
    pub(crate) fn value(&self, row: &str, column: &str) -> Result<PrintedValue, TableError> {
        let cell = self.find(row, column)?;
        let unit = Unit::from_symbol(&cell.unit).ok_or_else(|| TableError::Unit {
            place: source(cell).to_string(),
            unit: cell.unit.clone(),
        })?;
        PrintedValue::new(&cell.printed, unit, source(cell))
    }

    /// The number in a cell, or `None` where the paper prints a point.
    pub(crate) fn value_or_point(
        &self,
        row: &str,
        column: &str,
    ) -> Result<Option<PrintedValue>, TableError> {
        if self.find(row, column)?.printed == "." {
            return Ok(None);
        }
        self.value(row, column).map(Some)
    }

    /// The list of lines in a cell.
    pub(crate) fn harmonics(&self, row: &str, column: &str) -> Result<HarmonicList, TableError> {
        let cell = self.find(row, column)?;
        HarmonicList::new(&cell.printed, source(cell))
    }

    /// Row labels in order of appearance, without the label `all`.
    pub(crate) fn row_labels(&self) -> Vec<String> {
        let mut labels: Vec<String> = Vec::new();
        for cell in &self.cells {
            if cell.row != "all" && !labels.contains(&cell.row) {
                labels.push(cell.row.clone());
            }
        }
        labels
    }
}

fn place(row: &str, column: &str) -> String {
    format!("row {row}, column {column}")
}

fn source(cell: &RawCell) -> Source {
    Source::Table {
        table: cell.table,
        section: cell.section.clone(),
        row: cell.row.clone(),
        column: cell.column.clone(),
    }
}
