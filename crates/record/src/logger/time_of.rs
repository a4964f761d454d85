//! Which columns of a table of text hold its time.

use super::cells::{Cell, Dialect, classify, split};
use super::preamble;
use super::table::Layout;
use crate::error::RecordError;
use crate::note::Note;
use crate::select::{ReadOptions, time_column};
use crate::words::name_list;

/// The time base as the headings and the first row tell it.
pub(super) struct TimeBase {
    /// `None` where the rows are so many seconds apart.
    pub(super) column: Option<usize>,
    pub(super) step_s: f64,
    /// A column of times of day beside a column of dates.
    pub(super) clock: Option<usize>,
    pub(super) stamped: bool,
}

pub(super) fn time_of<'a>(
    file: &str,
    layout: &Layout,
    rows: impl Iterator<Item = (usize, &'a str)>,
    before: impl Iterator<Item = &'a str>,
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
            let Some(column) = column else {
                return sampled(file, layout, before, notes);
            };
            notes.push(Note::TimeChosen {
                column: layout.headings[column].name.clone(),
                because: "it holds dates or times of day",
            });
            column
        }
    };
    let Some(found) = stamp(column) else {
        return Ok(TimeBase {
            column: Some(column),
            step_s: 0.0,
            clock: None,
            stamped: false,
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
        column: Some(column),
        step_s: 0.0,
        clock,
        stamped: true,
    })
}

/// The sampling that a line above the table tells.
fn sampled<'a>(
    file: &str,
    layout: &Layout,
    before: impl Iterator<Item = &'a str>,
    notes: &mut Vec<Note>,
) -> Result<TimeBase, RecordError> {
    let Some((column, step_s)) = preamble::sampling(before, layout.dialect) else {
        return Err(RecordError::NoTimeColumn {
            file: file.to_owned(),
            line: layout.header.unwrap_or(layout.first_row) as u64 + 1,
            has: name_list(layout.headings.iter().map(|heading| heading.name.as_str())),
        });
    };
    notes.push(Note::TimeChosen {
        column,
        because: "it stands above the table, and names the sampling",
    });
    Ok(TimeBase {
        column: None,
        step_s,
        clock: None,
        stamped: false,
    })
}

/// What the cells of the first row hold.
pub(super) fn first_cells<'a>(
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
