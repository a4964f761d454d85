//! What the values of a Parquet column mean, and their numbers.

use parquet::basic::{ConvertedType, LogicalType, TimeUnit, Type};
use parquet::column::reader::ColumnReaderImpl;
use parquet::data_type::DataType;
use parquet::errors::ParquetError;
use parquet::schema::types::ColumnDescriptor;

use crate::bytes::half;
use crate::calendar;

/// Rows that are read at once.
const BATCH: usize = 1 << 16;

/// Bytes of an integer at most.
const MOST_BYTES: i32 = 16;

/// What a number is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Kind {
    Number,
    /// A number of half precision.
    Half,
    /// An integer that counts this part of one.
    Decimal(f64),
    Unsigned32,
    Unsigned64,
    Stamp(Stamps),
    /// An integer that counts parts of a second, so many.
    Duration(u32),
}

/// Stamps that count parts of a second.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Stamps {
    per_second: u32,
    /// Since midnight, not since 1970.
    of_day: bool,
}

/// What a column holds, or why it is left out.
pub(crate) fn kind_of(column: &ColumnDescriptor) -> Result<Kind, &'static str> {
    if column.max_rep_level() > 0 {
        return Err("it holds lists");
    }
    match column.physical_type() {
        Type::BYTE_ARRAY => Err("it holds text"),
        Type::FIXED_LEN_BYTE_ARRAY => kind_of_bytes(column),
        Type::INT96 => Ok(Kind::Stamp(Stamps {
            per_second: 1_000_000_000,
            of_day: false,
        })),
        Type::INT32 | Type::INT64 => kind_of_integer(column),
        Type::BOOLEAN | Type::FLOAT | Type::DOUBLE => Ok(Kind::Number),
    }
}

fn kind_of_bytes(column: &ColumnDescriptor) -> Result<Kind, &'static str> {
    let length = column.type_length();
    if column.logical_type_ref() == Some(&LogicalType::Float16) && length == 2 {
        return Ok(Kind::Half);
    }
    if column.converted_type() == ConvertedType::DECIMAL && (1..=MOST_BYTES).contains(&length) {
        return Ok(Kind::Decimal(10_f64.powi(column.type_scale())));
    }
    Err("its values are no numbers")
}

/// The number in the bytes of a value: half precision, or an integer, the greatest byte first.
pub(crate) fn number_in(kind: Kind, bytes: &[u8]) -> f64 {
    let Kind::Decimal(parts) = kind else {
        let pair = bytes.first_chunk::<2>();
        return pair.map_or(f64::NAN, |pair| half(u16::from_le_bytes(*pair)));
    };
    let is_negative = bytes.first().is_some_and(|byte| byte >> 7 == 1);
    let start = if is_negative { -1 } else { 0 };
    let bytes = bytes.iter().take(MOST_BYTES as usize);
    let count = bytes.fold(start, |count: i128, byte| count << 8 | i128::from(*byte));
    count as f64 / parts
}

fn kind_of_integer(column: &ColumnDescriptor) -> Result<Kind, &'static str> {
    let stamps = |unit: &TimeUnit, of_day| {
        let per_second = match unit {
            TimeUnit::MILLIS => 1_000,
            TimeUnit::MICROS => 1_000_000,
            TimeUnit::NANOS => 1_000_000_000,
        };
        Ok(Kind::Stamp(Stamps { per_second, of_day }))
    };
    match column.logical_type_ref() {
        Some(LogicalType::Timestamp(stamp)) => return stamps(&stamp.unit, false),
        Some(LogicalType::Time(stamp)) => return stamps(&stamp.unit, true),
        _ => {}
    }
    match column.converted_type() {
        ConvertedType::TIMESTAMP_MILLIS => stamps(&TimeUnit::MILLIS, false),
        ConvertedType::TIMESTAMP_MICROS => stamps(&TimeUnit::MICROS, false),
        ConvertedType::TIME_MILLIS => stamps(&TimeUnit::MILLIS, true),
        ConvertedType::TIME_MICROS => stamps(&TimeUnit::MICROS, true),
        ConvertedType::DATE => Err("it holds dates without times of day"),
        ConvertedType::DECIMAL => Ok(Kind::Decimal(10_f64.powi(column.type_scale()))),
        ConvertedType::UINT_8 | ConvertedType::UINT_16 | ConvertedType::UINT_32 => {
            Ok(Kind::Unsigned32)
        }
        ConvertedType::UINT_64 => Ok(Kind::Unsigned64),
        _ => Ok(Kind::Number),
    }
}

/// The values of a column, as far as they are read; NaN where they are missing.
#[derive(Debug)]
pub(crate) struct Column {
    pub(crate) kind: Kind,
    pub(crate) values: Vec<f64>,
    /// The first stamp, which the others are counted from.
    pub(crate) first: Option<i64>,
}

impl Column {
    pub(crate) fn new(kind: Kind, rows: usize) -> Column {
        Column {
            kind,
            // The number of rows is only claimed yet.
            values: Vec::with_capacity(rows.min(BATCH)),
            first: None,
        }
    }

    /// Integers, as what they count.
    pub(crate) fn take_counts<T: DataType>(
        &mut self,
        reader: &mut ColumnReaderImpl<T>,
        rows: usize,
        levels: i16,
        count: impl Fn(&T::T) -> i64,
    ) -> Result<(), ParquetError> {
        let (kind, mut first) = (self.kind, self.first);
        let taken = self.take(reader, rows, levels, |value| {
            let count = count(value);
            match kind {
                Kind::Number | Kind::Half => {
                    // Beyond 2^53 a double loses digits: such integers keep their differences.
                    let far = count.unsigned_abs() > 1 << 53;
                    let from = *first.get_or_insert(if far { count } else { 0 });
                    count.saturating_sub(from) as f64
                }
                Kind::Duration(per_second) => count as f64 / f64::from(per_second),
                Kind::Decimal(parts) => count as f64 / parts,
                Kind::Unsigned32 => f64::from(count as u32),
                Kind::Unsigned64 => count as u64 as f64,
                // Nanoseconds since 1970 have more digits than a number of ours.
                Kind::Stamp(stamps) => {
                    let since = count.saturating_sub(*first.get_or_insert(count));
                    since as f64 / f64::from(stamps.per_second)
                }
            }
        });
        self.first = first;
        taken
    }

    /// The next rows.
    pub(crate) fn take<T: DataType>(
        &mut self,
        reader: &mut ColumnReaderImpl<T>,
        rows: usize,
        levels: i16,
        mut number: impl FnMut(&T::T) -> f64,
    ) -> Result<(), ParquetError> {
        let (mut present, mut values) = (Vec::new(), Vec::new());
        let mut left = rows;
        while left > 0 {
            present.clear();
            values.clear();
            let marks = (levels > 0).then_some(&mut present);
            let batch = left.min(BATCH);
            let (read, ..) = reader.read_records(batch, marks, None, &mut values)?;
            if read == 0 {
                return Err(ParquetError::General(format!(
                    "{left} of {rows} rows are missing"
                )));
            }
            if levels > 0 {
                let mut values = values.iter();
                self.values.extend(present.iter().map(|&level| {
                    let value = if level == levels { values.next() } else { None };
                    value.map_or(f64::NAN, &mut number)
                }));
            } else {
                self.values.extend(values.iter().map(&mut number));
            }
            left -= read;
        }
        Ok(())
    }
}

impl Stamps {
    pub(crate) fn form(self) -> &'static str {
        if self.of_day {
            "times of day"
        } else {
            "timestamps"
        }
    }

    /// A stamp as text.
    pub(crate) fn text(self, stamp: Option<i64>) -> String {
        stamp.map_or_else(
            || "none".to_owned(),
            |stamp| calendar::text(stamp, self.per_second, self.of_day),
        )
    }
}
