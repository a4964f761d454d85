//! Workbooks of Excel (.xlsx), by the crate `calamine`.
//!
//! A sheet becomes the text of a table, a line for each row and a tab between cells, and goes the way
//! of every table: header, units, stamps and checks are those of text. Numbers are printed with all
//! their digits.

use std::fmt::Write as _;
use std::io::Cursor;

use calamine::{DataRef, ExcelDateTime, Reader as _, Xlsx};

use crate::MAX_ROWS;
use crate::faults::FormatFault;
use crate::foreign::{guarded, one_line};
use crate::raw::within_limit;
use crate::zip_size;

/// Columns that are read.
const MOST_COLUMNS: usize = 4096;
/// A header may stand so many rows below the first.
const MOST_BLANK: usize = 2000;

/// A sheet as text.
pub(crate) struct Sheet {
    pub(crate) name: String,
    pub(crate) text: String,
    /// Cells that hold numbers or stamps.
    numbers: usize,
}

/// The sheet with the most numbers, and the names of others that hold numbers.
pub(crate) fn read(bytes: &[u8]) -> Result<(Sheet, Vec<String>), FormatFault> {
    zip_size::check(bytes)?;
    let sheets = guarded("the workbook", || sheets(bytes))?;
    let mut holding: Vec<Sheet> = sheets
        .into_iter()
        .filter(|sheet| sheet.numbers > 0)
        .collect();
    let most = holding.iter().map(|sheet| sheet.numbers).max();
    // Of equal ones the first.
    let best = holding.iter().position(|sheet| Some(sheet.numbers) == most);
    let Some(best) = best else {
        return Err(FormatFault::Unsupported {
            found: "no sheet with numbers".to_owned(),
            instead: "put the record into a sheet, a header above its columns",
        });
    };
    let sheet = holding.remove(best);
    Ok((sheet, holding.into_iter().map(|sheet| sheet.name).collect()))
}

fn sheets(bytes: &[u8]) -> Result<Vec<Sheet>, FormatFault> {
    let mut book =
        Xlsx::new(Cursor::new(bytes)).map_err(|error| damaged("the workbook", &error))?;
    let mut sheets = Vec::new();
    let mut values = 0;
    for name in book.sheet_names() {
        let what = format!("sheet '{}'", one_line(&name));
        // A sheet of charts has no cells.
        let Ok(mut cells) = book.worksheet_cells_reader(&name) else {
            continue;
        };
        let mut sheet = Sheet {
            name,
            text: String::new(),
            numbers: 0,
        };
        let (mut row, mut column) = (0_usize, 0_usize);
        while let Some(cell) = cells.next_cell().map_err(|error| damaged(&what, &error))? {
            let (at_row, at_column) = cell.get_position();
            let (at_row, at_column) = (at_row as usize, at_column as usize);
            values += 1;
            within_limit(values)?;
            let ordered = at_row > row || (at_row == row && at_column >= column);
            if !ordered
                || at_row > row + MOST_BLANK
                || at_row > MAX_ROWS
                || at_column > MOST_COLUMNS
            {
                // A cell far away from the others, or in no order: no table.
                continue;
            }
            while row < at_row {
                sheet.text.push('\n');
                (row, column) = (row + 1, 0);
            }
            while column < at_column {
                sheet.text.push('\t');
                column += 1;
            }
            sheet.numbers += usize::from(write_cell(&mut sheet.text, cell.get_value()));
        }
        sheets.push(sheet);
    }
    Ok(sheets)
}

/// Writes a cell; whether it is a number or a stamp.
fn write_cell(text: &mut String, cell: &DataRef<'_>) -> bool {
    let words = |text: &mut String, words: &str| {
        let plain: String = words
            .chars()
            .map(|c| if c.is_control() { ' ' } else { c })
            .collect();
        text.push_str(plain.trim());
        false
    };
    // Writing to a string does not fail.
    match cell {
        DataRef::Int(value) => write!(text, "{value}").is_ok(),
        DataRef::Float(value) => write!(text, "{value}").is_ok(),
        DataRef::Bool(value) => write!(text, "{}", u8::from(*value)).is_ok(),
        DataRef::DateTime(stamp) => write_stamp(text, stamp),
        DataRef::String(value) => words(text, value),
        DataRef::SharedString(value) => words(text, value),
        DataRef::DateTimeIso(value) => words(text, value),
        DataRef::DurationIso(value) => words(text, value),
        DataRef::Error(_) => words(text, "#N/A"),
        DataRef::Empty => false,
    }
}

/// Days to the microsecond, the last digit that days of this century have as a double.
fn write_stamp(text: &mut String, stamp: &ExcelDateTime) -> bool {
    let days = stamp.as_f64();
    if stamp.is_duration() || !(0.0..3_000_000.0).contains(&days) {
        return write!(text, "{}", days * 86_400.0).is_ok();
    }
    let micros = (days.fract() * 86_400e6).round() as u64;
    let (whole, micros) = (
        days.trunc() + (micros / 86_400_000_000) as f64,
        micros % 86_400_000_000,
    );
    if days >= 1.0 {
        let whole = ExcelDateTime::new(whole, calamine::ExcelDateTimeType::DateTime, false);
        let (year, month, day, ..) = whole.to_ymd_hms_milli();
        if write!(text, "{year:04}-{month:02}-{day:02}T").is_err() {
            return false;
        }
    }
    let seconds = micros / 1_000_000;
    let (hour, minute, second) = (seconds / 3600, seconds / 60 % 60, seconds % 60);
    write!(
        text,
        "{hour:02}:{minute:02}:{second:02}.{:06}",
        micros % 1_000_000
    )
    .is_ok()
}

fn damaged(what: &str, error: &calamine::XlsxError) -> FormatFault {
    FormatFault::Damaged {
        what: what.to_owned(),
        reason: one_line(&error.to_string()),
    }
}
