//! The messages of a file, and the rows in them.

use std::io::Read as _;

use super::flat::Table;
use super::schema::{BATCH, Field, Kind, SCHEMA, fields, of_schema};
use crate::MAX_FILE_BYTES;
use crate::bytes::{Bytes, Stored, counted, half};
use crate::calendar;
use crate::faults::FormatFault;
use crate::note::Note;
use crate::raw::{Raw, RawColumn, within_limit};

/// The word before the messages of a file.
const MAGIC: &[u8] = b"ARROW1\0\0";
/// And behind them.
const END: &[u8] = b"ARROW1";
/// Before the length of a message.
const GOES_ON: u32 = u32::MAX;

/// All columns of numbers of a file or a stream.
pub(crate) fn read(bytes: &[u8], notes: &mut Vec<Note>) -> Result<Raw, FormatFault> {
    if bytes.starts_with(b"FEA1") {
        return Err(FormatFault::Unsupported {
            found: "a Feather file of version 1".to_owned(),
            instead: "write it with version 2 (pyarrow.feather.write_feather), or as Parquet",
        });
    }
    if let Some(footer) = footer(bytes) {
        return by_footer(bytes, &footer)?.map_or_else(
            || Err(damaged("its footer has no schema")),
            |table| Ok(table.raw(notes)),
        );
    }
    let mut rest = Bytes::new(bytes, 0, false);
    if bytes.starts_with(MAGIC) {
        rest.take(MAGIC.len() as u64, "the magic word")?;
    }
    let mut table: Option<Columns> = None;
    while let Some((head, body)) = message(&mut rest)? {
        match Table::root(head).map(|root| root.byte(1)) {
            Some(SCHEMA) if table.is_none() => {
                let fields = fields(head).ok_or_else(no_order)?;
                table = Some(Columns::new(fields));
            }
            None => return Err(damaged("its bytes contradict each other")),
            _ => {
                if let Some(table) = &mut table {
                    table.message(head, body)?;
                }
            }
        }
    }
    let table = table.ok_or_else(|| damaged("it has no schema"))?;
    Ok(table.raw(notes))
}

fn no_order() -> FormatFault {
    damaged("its schema is in no order of bytes that is known")
}

/// The directory at the end of a file; a stream has none, nor has a file that was cut off.
fn footer(bytes: &[u8]) -> Option<Table<'_>> {
    let rest = bytes.strip_prefix(MAGIC)?.strip_suffix(END)?;
    let (rest, length) = rest.split_last_chunk::<4>()?;
    let length = usize::try_from(u32::from_le_bytes(*length)).ok()?;
    Table::root(rest.get(rest.len().checked_sub(length)?..)?)
}

/// The batches that the directory lists.
fn by_footer(bytes: &[u8], footer: &Table<'_>) -> Result<Option<Columns>, FormatFault> {
    let Some(schema) = footer.table(1) else {
        return Ok(None);
    };
    let mut table = Columns::new(of_schema(&schema).ok_or_else(no_order)?);
    for (offset, ..) in footer.blocks(3) {
        let at = usize::try_from(offset).ok().filter(|&at| at <= bytes.len());
        let at = at.ok_or_else(|| damaged("a batch lies beyond it"))?;
        let mut rest = Bytes::new(&bytes[at..], at as u64, false);
        if let Some((head, body)) = message(&mut rest)? {
            table.message(head, body)?;
        }
    }
    Ok(Some(table))
}

/// The next message: its description and its body.
fn message<'a>(rest: &mut Bytes<'a>) -> Result<Option<(&'a [u8], Bytes<'a>)>, FormatFault> {
    const WHAT: &str = "a message";
    if rest.left() < 4 {
        return Ok(None);
    }
    let mut length = rest.u32(WHAT)?;
    if length == GOES_ON {
        if rest.left() < 4 {
            return Ok(None);
        }
        length = rest.u32(WHAT)?;
    }
    if length == 0 {
        return Ok(None);
    }
    let head = rest.take(u64::from(length), WHAT)?;
    let body = Table::root(head).map_or(0, |root| root.i64(3));
    let body = u64::try_from(body).map_err(|_| damaged("a message of negative length"))?;
    Ok(Some((head, rest.part(body, "the body of a message")?)))
}

/// The columns read so far.
struct Columns {
    fields: Vec<Field>,
    numbers: Vec<Vec<f64>>,
    /// Of integers of 64 bits; `None` where one is missing.
    integers: Vec<Vec<Option<i128>>>,
    values: u64,
    unpacked: u64,
}

/// Buffers and nodes of a batch, taken in the order of the columns.
struct Batch<'a> {
    body: &'a [u8],
    nodes: std::vec::IntoIter<(i64, i64)>,
    buffers: std::vec::IntoIter<(i64, i64)>,
    more: std::vec::IntoIter<i64>,
    codec: Option<u8>,
}

impl Columns {
    fn new(fields: Vec<Field>) -> Columns {
        let count = fields.len();
        Columns {
            fields,
            numbers: vec![Vec::new(); count],
            integers: vec![Vec::new(); count],
            values: 0,
            unpacked: 0,
        }
    }

    /// Takes the rows of a message that holds some.
    fn message(&mut self, head: &[u8], mut body: Bytes<'_>) -> Result<(), FormatFault> {
        let root = Table::root(head).filter(|root| root.byte(1) == BATCH);
        let Some(batch) = root.and_then(|root| root.table(2)) else {
            return Ok(());
        };
        let left = body.left() as u64;
        self.batch(&batch, body.take(left, "a batch")?)
    }

    fn batch(&mut self, batch: &Table<'_>, body: &[u8]) -> Result<(), FormatFault> {
        let rows = u64::try_from(batch.i64(0)).map_err(|_| damaged("a batch of negative rows"))?;
        self.values = self
            .values
            .saturating_add(rows.saturating_mul(self.fields.len() as u64));
        within_limit(self.values)?;
        let mut batch = Batch {
            body,
            nodes: batch.pairs(1).into_iter(),
            buffers: batch.pairs(2).into_iter(),
            more: batch.numbers(4).into_iter(),
            codec: batch.table(3).map(|packed| packed.byte(0)),
        };
        for k in 0..self.fields.len() {
            let field = self.fields[k].clone();
            if matches!(field.kind, Kind::Other(_)) {
                batch.skip(&field);
                continue;
            }
            batch
                .nodes
                .next()
                .ok_or_else(|| damaged("a batch lacks columns"))?;
            let marks = batch.buffer(&mut self.unpacked)?;
            let values = batch.buffer(&mut self.unpacked)?;
            self.column(k, field.kind, rows as usize, &marks, &values)?;
        }
        Ok(())
    }

    fn column(
        &mut self,
        k: usize,
        kind: Kind,
        rows: usize,
        marks: &[u8],
        values: &[u8],
    ) -> Result<(), FormatFault> {
        let is_there = |row: usize| marks.is_empty() || bit(marks, row);
        let needed = |bits: usize| rows.saturating_mul(bits).div_ceil(8);
        let enough = |bits: usize| {
            values.len() >= needed(bits) && (marks.is_empty() || marks.len() >= needed(1))
        };
        let short = || damaged("a column has fewer values than rows");
        let (stored, long) = match kind {
            Kind::Flag => {
                if !enough(1) {
                    return Err(short());
                }
                let flag = |row| {
                    if is_there(row) {
                        f64::from(u8::from(bit(values, row)))
                    } else {
                        f64::NAN
                    }
                };
                self.numbers[k].extend((0..rows).map(flag));
                return Ok(());
            }
            Kind::Float { bits: 16 } => {
                if !enough(16) {
                    return Err(short());
                }
                let one =
                    |row: usize| half(u16::from_le_bytes([values[2 * row], values[2 * row + 1]]));
                self.numbers[k]
                    .extend((0..rows).map(|row| if is_there(row) { one(row) } else { f64::NAN }));
                return Ok(());
            }
            Kind::Float { bits: 32 } => (Stored::F32, false),
            Kind::Float { .. } => (Stored::F64, false),
            Kind::Integer {
                bits: 8,
                signed: true,
            } => (Stored::I8, false),
            Kind::Integer { bits: 8, .. } => (Stored::U8, false),
            Kind::Integer {
                bits: 16,
                signed: true,
            } => (Stored::I16, false),
            Kind::Integer { bits: 16, .. } => (Stored::U16, false),
            Kind::Integer {
                bits: 32,
                signed: true,
            } => (Stored::I32, false),
            Kind::Integer { bits: 32, .. } => (Stored::U32, false),
            Kind::Integer {
                bits: 64,
                signed: false,
            } => (Stored::U64, true),
            Kind::Stamp { bits: 32, .. } => (Stored::I32, true),
            Kind::Integer { .. } | Kind::Stamp { .. } | Kind::Duration { .. } => {
                (Stored::I64, true)
            }
            Kind::Other(_) => return Ok(()),
        };
        if !enough(8 * stored.size()) {
            return Err(short());
        }
        let chunks = values.chunks_exact(stored.size()).take(rows).enumerate();
        if long {
            let whole = |chunk: &[u8]| stored.integer(chunk);
            self.integers[k].extend(chunks.map(|(row, chunk)| is_there(row).then(|| whole(chunk))));
        } else {
            let one = |(row, chunk)| {
                if is_there(row) {
                    stored.number(chunk, false)
                } else {
                    f64::NAN
                }
            };
            self.numbers[k].extend(chunks.map(one));
        }
        Ok(())
    }

    fn raw(self, notes: &mut Vec<Note>) -> Raw {
        let mut raw = Raw::default();
        let columns = self.fields.into_iter().zip(self.numbers).zip(self.integers);
        for ((field, numbers), integers) in columns {
            let mut column = RawColumn {
                name: field.name,
                values: numbers,
                ..RawColumn::default()
            };
            match field.kind {
                Kind::Other(because) => {
                    notes.push(Note::LeftOut {
                        column: column.name,
                        because: because.to_owned(),
                    });
                    continue;
                }
                Kind::Duration { per_second } => {
                    "s".clone_into(&mut column.unit);
                    let part = |count: i128| count as f64 / f64::from(per_second);
                    column.values = integers
                        .iter()
                        .map(|count| count.map_or(f64::NAN, part))
                        .collect();
                }
                Kind::Stamp {
                    per_second, of_day, ..
                } => {
                    "s".clone_into(&mut column.unit);
                    let first = integers.iter().flatten().next().copied();
                    let since =
                        |count: i128| (count - first.unwrap_or(0)) as f64 / f64::from(per_second);
                    column.values = integers
                        .iter()
                        .map(|count| count.map_or(f64::NAN, since))
                        .collect();
                    notes.push(Note::Stamps {
                        column: column.name.clone(),
                        form: if of_day { "times of day" } else { "timestamps" },
                        first: first.map_or_else(
                            || "none".to_owned(),
                            |first| calendar::text(first as i64, per_second, of_day),
                        ),
                    });
                }
                Kind::Integer { .. } if !integers.is_empty() => {
                    let whole: Vec<i128> = integers.iter().flatten().copied().collect();
                    let (values, origin) = counted(&whole);
                    let mut values = values.into_iter();
                    let next = |count: &Option<i128>| match count {
                        Some(_) => values.next().unwrap_or(f64::NAN),
                        None => f64::NAN,
                    };
                    (column.values, column.origin) = (integers.iter().map(next).collect(), origin);
                }
                _ => {}
            }
            raw.columns.push(column);
        }
        raw
    }
}

impl Batch<'_> {
    /// Passes over a column and those within it.
    fn skip(&mut self, field: &Field) {
        self.nodes.next();
        let more = if field.is_view {
            self.more.next().unwrap_or(0)
        } else {
            0
        };
        let count = field.buffers + usize::try_from(more).unwrap_or(0).min(self.buffers.len());
        for _ in 0..count {
            self.buffers.next();
        }
        field.children.iter().for_each(|child| self.skip(child));
    }

    /// The next buffer, unpacked.
    fn buffer(&mut self, unpacked: &mut u64) -> Result<Vec<u8>, FormatFault> {
        let (offset, length) = self
            .buffers
            .next()
            .ok_or_else(|| damaged("a batch lacks buffers"))?;
        let range = usize::try_from(offset)
            .ok()
            .zip(usize::try_from(length).ok());
        let bytes =
            range.and_then(|(start, length)| self.body.get(start..start.checked_add(length)?));
        let bytes = bytes.ok_or_else(|| damaged("a buffer lies beyond its batch"))?;
        let most = MAX_FILE_BYTES.saturating_sub(*unpacked);
        let unpacked_now = match (self.codec, bytes.split_first_chunk::<8>()) {
            (Some(codec), Some((claim, packed))) => {
                if i64::from_le_bytes(*claim) == -1 {
                    packed.to_vec()
                } else {
                    unpack(codec, packed, most)?
                }
            }
            _ => bytes.to_vec(),
        };
        *unpacked = unpacked.saturating_add(unpacked_now.len() as u64);
        if *unpacked > MAX_FILE_BYTES {
            return Err(FormatFault::TooMuch {
                most: MAX_FILE_BYTES,
                what: "unpacked bytes",
            });
        }
        Ok(unpacked_now)
    }
}

fn unpack(codec: u8, packed: &[u8], most: u64) -> Result<Vec<u8>, FormatFault> {
    let mut bytes = Vec::new();
    let read = match codec {
        0 => lz4_flex::frame::FrameDecoder::new(packed)
            .take(most + 1)
            .read_to_end(&mut bytes),
        1 => match ruzstd::decoding::StreamingDecoder::new(packed) {
            Ok(decoder) => decoder.take(most + 1).read_to_end(&mut bytes),
            Err(error) => return Err(damaged(&crate::foreign::one_line(&error.to_string()))),
        },
        _ => {
            return Err(FormatFault::Unsupported {
                found: "a compression that is neither LZ4 nor Zstandard".to_owned(),
                instead: "write it without compression",
            });
        }
    };
    read.map_err(|error| damaged(&crate::foreign::one_line(&error.to_string())))?;
    Ok(bytes)
}

fn bit(bits: &[u8], at: usize) -> bool {
    bits.get(at / 8)
        .is_some_and(|byte| byte >> (at % 8) & 1 == 1)
}

fn damaged(reason: &str) -> FormatFault {
    FormatFault::Damaged {
        what: "the file".to_owned(),
        reason: reason.to_owned(),
    }
}
