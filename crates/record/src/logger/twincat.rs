//! Exports of the scope of TwinCAT: keys in the first cell of each pair of columns, then a column
//! of times in ms and one of values for each channel.

use super::cells::{Dialect, split};
use super::told::{lacks, told, value};
use crate::MAX_ROWS;
use crate::base::Base;
use crate::error::RecordError;
use crate::note::Note;
use crate::raw::{Raw, RawColumn};

const PROGRAM: &str = "TwinCAT scope";
/// Times are in this unit, s.
const MILLISECOND: f64 = 1e-3;
/// Lines above the rows.
const HEAD: usize = 64;

fn separator(line: &str) -> char {
    [';', '\t', ',']
        .into_iter()
        .find(|&sign| line.contains(sign))
        .unwrap_or(';')
}

pub(super) fn is_twincat(lines: &[&str]) -> bool {
    let starts = |word: &str| {
        lines
            .iter()
            .any(|line| line.trim_start_matches('"').starts_with(word))
    };
    starts("Name") && starts("SampleTime[ms]")
}

pub(super) fn read(file: &str, text: &str, notes: &mut Vec<Note>) -> Result<Raw, RecordError> {
    let head: Vec<&str> = super::text::lines(text).take(HEAD).collect();
    let line_of = |word: &str| {
        let found = |line: &&str| line.trim_start_matches('"').starts_with(word);
        head.iter().rposition(found)
    };
    let missing = |needed| {
        lacks(
            file,
            0,
            "no line of names found".to_owned(),
            needed,
            PROGRAM,
        )
    };
    let names_at = line_of("Name").ok_or_else(|| missing("a line that begins with Name"))?;
    let sign = separator(head[names_at]);
    let cells = |k: usize| -> Vec<String> {
        let cells = head
            .get(k)
            .and_then(|line| split(line, sign))
            .unwrap_or_default();
        cells.into_iter().map(|cell| cell.into_owned()).collect()
    };
    let names = cells(names_at);
    let units = line_of("Unit").map(cells).unwrap_or_default();
    let count = names.len() / 2;
    let (mut times, mut values) = (vec![Vec::new(); count], vec![Vec::new(); count]);
    let dialect = Dialect {
        separator: sign,
        decimal_comma: sign != ',' && decimal_comma(text, sign),
    };
    for (k, line) in super::text::lines(text).enumerate().skip(names_at + 1) {
        let Some(row) = split(line, sign) else {
            continue;
        };
        // Keys end where the first cell is a number.
        let first = row.first().map_or("", |cell| cell.as_ref());
        if super::cells::number(first, dialect.decimal_comma).is_none() {
            continue;
        }
        for channel in 0..count {
            let (Some(t), Some(x)) = (row.get(2 * channel), row.get(2 * channel + 1)) else {
                continue;
            };
            // Channels may be of different lengths.
            if t.is_empty() {
                continue;
            }
            let name = &names[2 * channel + 1];
            times[channel].push(MILLISECOND * value(file, k, name, t, dialect.decimal_comma)?);
            values[channel].push(value(file, k, name, x, dialect.decimal_comma)?);
            if values[channel].len() > MAX_ROWS {
                let file = file.to_owned();
                return Err(RecordError::TooManyRows { file });
            }
        }
    }
    told(
        notes,
        "read as an export of a TwinCAT scope, times in ms beside the values of each channel",
    );
    let mut raw = Raw::default();
    for (channel, (time, values)) in times.into_iter().zip(values).enumerate() {
        let base = raw.base(Base::Stamps(time));
        raw.columns.push(RawColumn {
            name: names[2 * channel + 1].clone(),
            unit: units.get(2 * channel + 1).cloned().unwrap_or_default(),
            values,
            base: Some(base),
            ..RawColumn::default()
        });
    }
    Ok(raw)
}

/// Whether a row of the export has a comma within a number.
fn decimal_comma(text: &str, sign: char) -> bool {
    super::text::lines(text).skip(4).take(200).any(|line| {
        let cells = split(line, sign).unwrap_or_default();
        let comma = |cell: &str| cell.contains(',') && super::cells::number(cell, true).is_some();
        cells.iter().any(|cell| comma(cell))
    })
}
