//! Columns as the text of a CSV file.

use std::fmt::Write as _;
use std::path::Path;

use crate::error::{Place, RecordError};

/// Below this magnitude, and from [`EXPONENT_FROM`] on, numbers are written with an exponent.
const EXPONENT_BELOW: f64 = 1e-5;

/// See [`EXPONENT_BELOW`].
const EXPONENT_FROM: f64 = 1e16;

/// Columns as CSV, checked to make a readable file.
pub(crate) fn checked_csv(
    path: &Path,
    headers: &[String],
    columns: &[&[f64]],
) -> Result<String, RecordError> {
    let file = || path.display().to_string();
    if headers.len() != columns.len() {
        let (headers, columns) = (headers.len(), columns.len());
        return Err(RecordError::HeaderCount {
            file: file(),
            headers,
            columns,
        });
    }
    let needed = columns.first().map_or(0, |column| column.len());
    let named = || headers.iter().zip(columns);
    if let Some((header, column)) = named().find(|(_, column)| column.len() != needed) {
        let (column, found) = (header.clone(), column.len());
        return Err(RecordError::LengthMismatch {
            file: file(),
            column,
            found,
            needed,
        });
    }
    for (header, column) in named() {
        if let Some(row) = column.iter().position(|value| !value.is_finite()) {
            let (column, found) = (header.clone(), column[row].to_string());
            return Err(RecordError::NotFinite {
                file: file(),
                at: Place::Row(row),
                column,
                found,
            });
        }
    }
    Ok(csv_text(headers, columns))
}

fn csv_text(headers: &[String], columns: &[&[f64]]) -> String {
    let rows = columns.first().map_or(0, |column| column.len());
    let mut text = String::with_capacity(rows * columns.len() * 12 + 64);
    for (index, header) in headers.iter().enumerate() {
        if index > 0 {
            text.push(',');
        }
        push_cell(&mut text, header);
    }
    text.push('\n');
    for row in 0..rows {
        for (index, column) in columns.iter().enumerate() {
            if index > 0 {
                text.push(',');
            }
            push_number(&mut text, column[row]);
        }
        text.push('\n');
    }
    text
}

/// A header cell, quoted where it must be.
fn push_cell(text: &mut String, cell: &str) {
    if cell.contains([',', '"', '\n', '\r']) {
        text.push('"');
        text.push_str(&cell.replace('"', "\"\""));
        text.push('"');
    } else {
        text.push_str(cell);
    }
}

/// The fewest digits that read back as the same double.
fn push_number(text: &mut String, value: f64) {
    let magnitude = value.abs();
    let plain = magnitude == 0.0 || (EXPONENT_BELOW..EXPONENT_FROM).contains(&magnitude);
    // Writing to a String cannot fail.
    let _ = if plain {
        write!(text, "{value}")
    } else {
        write!(text, "{value:e}")
    };
}
