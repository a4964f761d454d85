//! Apache Parquet, by the crate `parquet` without its Arrow half.
//!
//! A file is a list of row groups, each with one chunk of pages for every column, and a directory at
//! the end. Columns of numbers, of flags and of stamps are read; stamps become seconds since
//! the first of them.

mod pages;
mod thrift;
mod values;

use std::sync::Arc;

use bytes::Bytes;
use parquet::basic::CompressionCodec;
use parquet::column::reader::{ColumnReader, get_column_reader};
use parquet::file::metadata::{
    FileMetaData, KeyValue, ParquetMetaData, ParquetMetaDataReader, RowGroupMetaData,
};
use parquet::file::serialized_reader::SerializedPageReader;
use parquet::schema::types::ColumnDescPtr;

use self::pages::{Pages, Unpacked, is_known};
use self::values::{Column, Kind, kind_of, number_in};
use crate::arrow::schema::{self as arrow, Field, fields};
use crate::error::Place;
use crate::faults::FormatFault;
use crate::foreign::{guarded, one_line};
use crate::note::Note;
use crate::raw::{Raw, RawColumn, within_limit};

/// Measured rows: one channel whose last bit is noise alone takes a byte for eight.
const MOST_ROWS_PER_BYTE: u64 = 100;

/// All columns of numbers of a file.
pub(crate) fn read(bytes: Vec<u8>, notes: &mut Vec<Note>) -> Result<Raw, FormatFault> {
    let file = Arc::new(Bytes::from(bytes));
    if !directory(&file).is_none_or(thrift::is_sound) {
        return Err(FormatFault::Damaged {
            what: "the directory of the file".to_owned(),
            reason: "it claims more than it holds".to_owned(),
        });
    }
    let metadata = guarded("the directory of the file", || {
        ParquetMetaDataReader::new()
            .parse_and_finish(&*file)
            .map_err(|error| damaged("the directory of the file".to_owned(), &error))
    })?;
    let columns = metadata.file_metadata().schema_descr().columns();
    let rows = rows_of(&metadata, file.len() as u64)?;
    within_limit(rows.saturating_mul(columns.len() as u64))?;
    let mut source = Source {
        file,
        metadata: &metadata,
        rows: rows as usize,
        unpacked: Unpacked::default(),
    };
    let mut raw = Raw::default();
    let told = arrow_fields(metadata.file_metadata());
    for (index, column) in columns.iter().enumerate() {
        let name = column.path().parts().join(".");
        match kind_of(column).map(|kind| by_arrow(kind, &name, &told)) {
            Err(because) => notes.push(Note::LeftOut {
                column: name,
                because: because.to_owned(),
            }),
            Ok(kind) => {
                let what = format!("column '{}'", one_line(&name));
                let read = guarded(&what, || source.column(index, column, kind))?;
                raw.columns.push(named(name, read, notes));
            }
        }
    }
    Ok(raw)
}

/// The columns as the writer knew them: pyarrow, pandas and polars keep their schema beside that of
/// the format, which has no durations.
fn arrow_fields(metadata: &FileMetaData) -> Vec<Field> {
    let of_arrow = |entry: &&KeyValue| entry.key == "ARROW:schema";
    let entry = metadata
        .key_value_metadata()
        .and_then(|all| all.iter().find(of_arrow));
    let bytes = entry.and_then(|entry| base64(entry.value.as_deref()?));
    let message = bytes.as_deref().and_then(|bytes| match bytes {
        [0xff, 0xff, 0xff, 0xff, _, _, _, _, message @ ..] => Some(message),
        [_, _, _, _, message @ ..] => Some(message),
        _ => None,
    });
    message.and_then(fields).unwrap_or_default()
}

fn by_arrow(kind: Kind, name: &str, fields: &[Field]) -> Kind {
    let field = fields.iter().find(|field| field.name == name);
    match (kind, field.map(|field| field.kind)) {
        (Kind::Number, Some(arrow::Kind::Duration { per_second })) => Kind::Duration(per_second),
        _ => kind,
    }
}

/// Bytes of a text of the usual 64 characters.
fn base64(text: &str) -> Option<Vec<u8>> {
    let mut bytes = Vec::with_capacity(text.len() / 4 * 3);
    let (mut word, mut bits) = (0_u32, 0);
    for c in text
        .bytes()
        .filter(|c| !c.is_ascii_whitespace() && *c != b'=')
    {
        let six = match c {
            b'A'..=b'Z' => c - b'A',
            b'a'..=b'z' => c - b'a' + 26,
            b'0'..=b'9' => c - b'0' + 52,
            b'+' | b'-' => 62,
            b'/' | b'_' => 63,
            _ => return None,
        };
        (word, bits) = ((word << 6 | u32::from(six)) & 0xff_ffff, bits + 6);
        if bits >= 8 {
            bits -= 8;
            bytes.push((word >> bits & 0xff) as u8);
        }
    }
    Some(bytes)
}

/// The bytes before the last eight, which tell their number; `None` if the crate will say why not.
fn directory(file: &[u8]) -> Option<&[u8]> {
    let (rest, [a, b, c, d, b'P', b'A', b'R', b'1']) = file.split_last_chunk()? else {
        return None;
    };
    let length = u32::from_le_bytes([*a, *b, *c, *d]);
    let start = rest.len().checked_sub(usize::try_from(length).ok()?)?;
    rest.get(start..)
}

/// Rows of all groups.
fn rows_of(metadata: &ParquetMetaData, bytes: u64) -> Result<u64, FormatFault> {
    let rows = metadata.row_groups().iter().try_fold(0_u64, |sum, group| {
        let rows = u64::try_from(group.num_rows()).map_err(|_| FormatFault::Malformed {
            at: Place::Names,
            found: format!("a group of {} rows", group.num_rows()),
            needed: "none or more",
        })?;
        Ok(sum.saturating_add(rows))
    })?;
    let most = bytes.saturating_mul(MOST_ROWS_PER_BYTE);
    if rows > most {
        return Err(FormatFault::TooMuch {
            most,
            what: "rows in a file of this length",
        });
    }
    Ok(rows)
}

fn named(name: String, column: Column, notes: &mut Vec<Note>) -> RawColumn {
    let (mut unit, mut origin) = ("", 0.0);
    match column.kind {
        Kind::Stamp(stamps) => {
            unit = "s";
            notes.push(Note::Stamps {
                column: name.clone(),
                form: stamps.form(),
                first: stamps.text(column.first),
            });
        }
        Kind::Duration(_) => unit = "s",
        Kind::Number => origin = column.first.unwrap_or(0) as f64,
        _ => {}
    }
    RawColumn {
        name,
        unit: unit.to_owned(),
        values: column.values,
        origin,
        base: None,
    }
}

struct Source<'a> {
    file: Arc<Bytes>,
    metadata: &'a ParquetMetaData,
    rows: usize,
    unpacked: Unpacked,
}

impl Source<'_> {
    fn column(
        &mut self,
        index: usize,
        descriptor: &ColumnDescPtr,
        kind: Kind,
    ) -> Result<Column, FormatFault> {
        let mut column = Column::new(kind, self.rows);
        for group in self.metadata.row_groups() {
            self.chunk(group, index, descriptor, &mut column)?;
        }
        Ok(column)
    }

    fn chunk(
        &mut self,
        group: &RowGroupMetaData,
        index: usize,
        descriptor: &ColumnDescPtr,
        column: &mut Column,
    ) -> Result<(), FormatFault> {
        let what = || format!("column '{}'", one_line(&descriptor.path().string()));
        // Not negative: they are summed.
        let rows = group.num_rows() as usize;
        let pages = self.pages(group, index, descriptor, rows)?;
        let reader = get_column_reader(Arc::clone(descriptor), pages);
        let (levels, column_kind) = (descriptor.max_def_level(), column.kind);
        let read = match reader {
            ColumnReader::BoolColumnReader(mut reader) => {
                column.take(&mut reader, rows, levels, |flag| f64::from(u8::from(*flag)))
            }
            ColumnReader::FloatColumnReader(mut reader) => {
                column.take(&mut reader, rows, levels, |value| f64::from(*value))
            }
            ColumnReader::DoubleColumnReader(mut reader) => {
                column.take(&mut reader, rows, levels, |value| *value)
            }
            ColumnReader::Int32ColumnReader(mut reader) => {
                column.take_counts(&mut reader, rows, levels, |count| i64::from(*count))
            }
            ColumnReader::Int64ColumnReader(mut reader) => {
                column.take_counts(&mut reader, rows, levels, |count| *count)
            }
            ColumnReader::Int96ColumnReader(mut reader) => {
                column.take_counts(&mut reader, rows, levels, |stamp| stamp.to_nanos())
            }
            ColumnReader::FixedLenByteArrayColumnReader(mut reader) => {
                column.take(&mut reader, rows, levels, |value| {
                    number_in(column_kind, value.data())
                })
            }
            ColumnReader::ByteArrayColumnReader(_) => Ok(()),
        };
        if self.unpacked.is_too_much() {
            return Err(FormatFault::TooMuch {
                most: crate::MAX_FILE_BYTES,
                what: "unpacked bytes",
            });
        }
        read.map_err(|error| damaged(what(), &error))
    }

    fn pages(
        &self,
        group: &RowGroupMetaData,
        index: usize,
        descriptor: &ColumnDescPtr,
        rows: usize,
    ) -> Result<Box<Pages>, FormatFault> {
        let what = || format!("column '{}'", one_line(&descriptor.path().string()));
        let broken = |reason: &str| FormatFault::Damaged {
            what: what(),
            reason: reason.to_owned(),
        };
        let chunk = group.columns().get(index);
        let chunk = chunk.ok_or_else(|| broken("a group of rows lacks it"))?;
        if chunk.column_type() != descriptor.physical_type() {
            return Err(broken("a group of rows holds another type"));
        }
        let codec = chunk.compression_codec();
        if !is_known(codec) {
            return Err(FormatFault::Unsupported {
                found: format!("{codec:?} compression"),
                instead: "write it with Snappy, gzip, Zstandard or no compression",
            });
        }
        let start = chunk.dictionary_page_offset();
        let start = start.unwrap_or_else(|| chunk.data_page_offset());
        let end = start.checked_add(chunk.compressed_size());
        let bytes = end.and_then(|end| {
            let (start, end) = (usize::try_from(start).ok()?, usize::try_from(end).ok()?);
            self.file.get(start..end)
        });
        let bytes = bytes.ok_or_else(|| broken("its bytes lie beyond the file"))?;
        if !thrift::are_sound(bytes) {
            return Err(broken("its pages claim more than they hold"));
        }
        let plain = chunk.clone().into_builder();
        let plain = plain.set_compression_codec(CompressionCodec::UNCOMPRESSED);
        let plain = plain.build().map_err(|error| damaged(what(), &error))?;
        let packed = SerializedPageReader::new(Arc::clone(&self.file), &plain, rows, None)
            .map_err(|error| damaged(what(), &error))?;
        Ok(Box::new(Pages {
            packed,
            codec,
            kind: descriptor.physical_type(),
            leveled: descriptor.max_def_level() > 0,
            unpacked: self.unpacked.clone(),
            dictionary: false,
        }))
    }
}

fn damaged(what: String, error: &parquet::errors::ParquetError) -> FormatFault {
    let text = error.to_string();
    let reason = text.strip_prefix("Parquet error: ").unwrap_or(&text);
    FormatFault::Damaged {
        what,
        reason: one_line(reason),
    }
}
