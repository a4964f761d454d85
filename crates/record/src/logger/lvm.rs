//! LabVIEW measurement files (.lvm), as "Write To Measurement File" leaves them.
//!
//! A header of keys ends with `***End_of_Header***`. Each segment has one of its own (a value for
//! each channel: start, step, unit), a line of names, and rows. A file may have one X column, one for
//! each channel, or none.

use super::cells::{Dialect, split};
use super::stamp::{parse_stamp, to_seconds};
use super::told::{lacks, told, value};
use crate::MAX_ROWS;
use crate::base::Base;
use crate::error::RecordError;
use crate::note::Note;
use crate::raw::{Raw, RawColumn};
use crate::words::shortened;

const PROGRAM: &str = "LabVIEW measurement file";
const END: &str = "***End_of_Header***";
const MOST_CHANNELS: usize = 4096;

pub(super) fn is_lvm(first: &str) -> bool {
    first.trim_start().starts_with("LabVIEW Measurement")
}

/// Reads all segments.
pub(super) fn read(file: &str, text: &str, notes: &mut Vec<Note>) -> Result<Raw, RecordError> {
    let mut lines = super::text::lines(text).enumerate().peekable();
    let mut reader = Lvm::new(file);
    // Without the header of the file the first one is a segment's.
    for (_, line) in lines.by_ref() {
        if line.trim().starts_with(END) {
            break;
        }
        reader.key(line);
    }
    while let Some((k, line)) = lines.next() {
        if line.trim().is_empty() {
            continue;
        }
        let cells = reader.cells(k, line)?;
        match cells.first().map(String::as_str) {
            Some("Channels") => {
                let mut keys = vec![cells];
                for (k, line) in lines.by_ref() {
                    if line.trim().starts_with(END) {
                        break;
                    }
                    keys.push(reader.cells(k, line)?);
                }
                reader.segment(&keys);
            }
            Some("X_Value") => reader.names(k, cells)?,
            _ => reader.row(k, &cells)?,
        }
    }
    reader.raw(notes)
}

struct Lvm<'a> {
    file: &'a str,
    dialect: Dialect,
    /// Whether rows have an X column.
    has_x: bool,
    channels: Vec<Channel>,
    /// What of the segment at hand belongs to each channel.
    segments: Vec<Segment>,
    /// Rows of the segment at hand.
    rows: usize,
    /// The first stamp of the file.
    zero: Option<String>,
}

#[derive(Default)]
struct Channel {
    name: String,
    unit: String,
    /// The column of its values, and that of its X.
    column: usize,
    x: usize,
    dimension: String,
    time: Vec<f64>,
    values: Vec<f64>,
}

#[derive(Default, Clone)]
struct Segment {
    unit: String,
    dimension: String,
    start: f64,
    step: f64,
    /// Seconds after the first stamp of the file.
    late_s: f64,
}

impl<'a> Lvm<'a> {
    fn new(file: &'a str) -> Lvm<'a> {
        Lvm {
            file,
            dialect: Dialect {
                separator: '\t',
                decimal_comma: false,
            },
            has_x: true,
            channels: Vec::new(),
            segments: Vec::new(),
            rows: 0,
            zero: None,
        }
    }

    /// A line of the header of the file.
    fn key(&mut self, line: &str) {
        let mut words = line.split(['\t', ',', ';']).map(str::trim);
        let (key, word) = (words.next().unwrap_or(""), words.next().unwrap_or(""));
        match (key, word) {
            ("Separator", "Comma") => self.dialect.separator = ',',
            ("Separator", "Semicolon") => self.dialect.separator = ';',
            // The sign itself may have been taken for a separator.
            ("Decimal_Separator", "") => self.dialect.decimal_comma = line.contains(','),
            ("X_Columns", "No") => self.has_x = false,
            _ => {}
        }
    }

    fn cells(&self, k: usize, line: &str) -> Result<Vec<String>, RecordError> {
        let line = line.trim_end_matches('\r');
        let cells = split(line, self.dialect.separator).ok_or_else(|| RecordError::OpenQuote {
            file: self.file.to_owned(),
            line: k as u64 + 1,
        })?;
        Ok(cells.into_iter().map(|cell| cell.into_owned()).collect())
    }

    /// The header of a segment: keys with a value for each channel.
    fn segment(&mut self, keys: &[Vec<String>]) {
        let of = |key: &str| {
            keys.iter()
                .find(|cells| cells.first().is_some_and(|c| c == key))
        };
        let count = of("Channels").and_then(|cells| cells.get(1)?.parse::<usize>().ok());
        let count = count.unwrap_or(0).min(MOST_CHANNELS);
        let number = |key: &str, k: usize| {
            let cell = of(key).and_then(|cells| cells.get(k + 1));
            let read = |cell: &String| super::cells::number(cell, self.dialect.decimal_comma);
            cell.and_then(read).unwrap_or(0.0)
        };
        let text = |key: &str, k: usize| {
            of(key)
                .and_then(|cells| cells.get(k + 1).cloned())
                .unwrap_or_default()
        };
        let mut zero = self.zero.clone();
        let segments = (0..count)
            .map(|k| {
                let stamp = format!("{} {}", text("Date", k), text("Time", k));
                Segment {
                    unit: text("Y_Unit_Label", k),
                    dimension: text("X_Dimension", k),
                    start: number("X0", k),
                    step: number("Delta_X", k),
                    late_s: late(&mut zero, &stamp),
                }
            })
            .collect();
        (self.segments, self.rows, self.zero) = (segments, 0, zero);
    }

    /// The line of names: X columns, channels, a comment.
    fn names(&mut self, k: usize, cells: Vec<String>) -> Result<(), RecordError> {
        let mut x = 0;
        let mut channels = Vec::new();
        for (column, name) in cells.into_iter().enumerate() {
            match name.as_str() {
                "X_Value" => x = column,
                "Comment" => break,
                "" => {}
                _ => channels.push(Channel {
                    name,
                    column,
                    x,
                    ..Channel::default()
                }),
            }
        }
        for (channel, segment) in channels.iter_mut().zip(&self.segments) {
            segment.unit.clone_into(&mut channel.unit);
            segment.dimension.clone_into(&mut channel.dimension);
        }
        let like = |a: &Channel, b: &Channel| (&a.name, a.column) == (&b.name, b.column);
        if self.channels.is_empty() {
            self.channels = channels;
            return Ok(());
        }
        let same = self.channels.len() == channels.len()
            && self.channels.iter().zip(&channels).all(|(a, b)| like(a, b));
        if same {
            return Ok(());
        }
        let found = "a segment with other channels than the first".to_owned();
        Err(lacks(
            self.file,
            k,
            found,
            "the same channels in all segments",
            PROGRAM,
        ))
    }

    fn row(&mut self, k: usize, cells: &[String]) -> Result<(), RecordError> {
        if self.rows >= MAX_ROWS {
            let file = self.file.to_owned();
            return Err(RecordError::TooManyRows { file });
        }
        if self.channels.is_empty() {
            let found = format!("'{}' found", shortened(&cells.join(" ")));
            return Err(lacks(
                self.file,
                k,
                found,
                "a line of names that begins with X_Value",
                PROGRAM,
            ));
        }
        let comma = self.dialect.decimal_comma;
        let none = Segment::default();
        for (index, channel) in self.channels.iter_mut().enumerate() {
            let segment = self.segments.get(index).unwrap_or(&none);
            let cell = cells.get(channel.column).map_or("", String::as_str);
            let x = cells.get(channel.x).map_or("", String::as_str);
            // Channels may be of different lengths.
            if cell.is_empty() && (x.is_empty() || channel.x + 1 == channel.column && index > 0) {
                continue;
            }
            let stamp = if self.has_x && !x.is_empty() {
                value(self.file, k, "X_Value", x, comma)?
            } else {
                segment.start + self.rows as f64 * segment.step
            };
            channel.time.push(segment.late_s + stamp);
            channel
                .values
                .push(value(self.file, k, &channel.name, cell, comma)?);
        }
        self.rows += 1;
        Ok(())
    }

    fn raw(self, notes: &mut Vec<Note>) -> Result<Raw, RecordError> {
        told(notes, "read as a LabVIEW measurement file");
        let mut raw = Raw::default();
        for mut channel in self.channels {
            let over = channel.dimension.trim();
            if !over.is_empty() && !over.eq_ignore_ascii_case("time") {
                notes.push(Note::LeftOut {
                    column: channel.name,
                    because: format!("its values stand over {}, not over time", shortened(over)),
                });
                continue;
            }
            while channel.values.last().is_some_and(|value| value.is_nan()) {
                channel.values.pop();
                channel.time.pop();
            }
            let base = raw.base(Base::Stamps(channel.time));
            raw.columns.push(RawColumn {
                name: channel.name,
                unit: channel.unit,
                values: channel.values,
                base: Some(base),
                ..RawColumn::default()
            });
        }
        if raw.columns.is_empty() && notes.len() < 2 {
            let found = "no channels found".to_owned();
            return Err(lacks(
                self.file,
                0,
                found,
                "a segment with a line of names that begins with X_Value",
                PROGRAM,
            ));
        }
        Ok(raw)
    }
}

/// Seconds of a stamp after the first one, 0 where either cannot be read.
fn late(zero: &mut Option<String>, stamp: &str) -> f64 {
    let Some(parsed) = parse_stamp(stamp) else {
        return 0.0;
    };
    let first = zero.get_or_insert_with(|| stamp.to_owned());
    let Some(first) = parse_stamp(first) else {
        return 0.0;
    };
    to_seconds(&[first, parsed]).map_or(0.0, |times| times.seconds[1])
}
