//! What the values of a Parquet column mean, and their numbers.

use parquet::basic::{ConvertedType, LogicalType, TimeUnit, Type};
use parquet::column::reader::ColumnReaderImpl;
use parquet::data_type::DataType;
use parquet::errors::ParquetError;
use parquet::schema::types::ColumnDescriptor;

/// Rows that are read at once.
const BATCH: usize = 1 << 16;

/// What a number is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Kind {
    Number,
    /// An integer that counts this part of one.
    Decimal(f64),
    Unsigned32,
    Unsigned64,
    Stamp(Stamps),
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
        Type::FIXED_LEN_BYTE_ARRAY => Err("its values are no numbers of 4 or 8 bytes"),
        Type::INT96 => Ok(Kind::Stamp(Stamps {
            per_second: 1_000_000_000,
            of_day: false,
        })),
        Type::INT32 | Type::INT64 => kind_of_integer(column),
        Type::BOOLEAN | Type::FLOAT | Type::DOUBLE => Ok(Kind::Number),
    }
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
                Kind::Number => count as f64,
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
        let Some(stamp) = stamp else {
            return "none".to_owned();
        };
        let per_second = i64::from(self.per_second);
        let (seconds, part) = (stamp.div_euclid(per_second), stamp.rem_euclid(per_second));
        let digits = per_second.ilog10() as usize;
        let (days, of_day) = (seconds.div_euclid(86_400), seconds.rem_euclid(86_400));
        let (hours, minutes, seconds) = (of_day / 3600, of_day / 60 % 60, of_day % 60);
        let clock = format!("{hours:02}:{minutes:02}:{seconds:02}.{part:0digits$}");
        if self.of_day {
            return clock;
        }
        let (year, month, day) = civil(days);
        format!("{year:04}-{month:02}-{day:02} {clock}")
    }
}

/// Year, month and day of a day counted from 1970-01-01, in the calendar of today for all times.
///
/// Counted in years from March, so that the day that leap years add is the last of its year.
fn civil(days: i64) -> (i64, i64, i64) {
    // Days of 400 years, of 100, of 4, and of 1.
    const CYCLE: i64 = 146_097;
    let from_march = days + 719_468;
    let (cycle, day) = (from_march.div_euclid(CYCLE), from_march.rem_euclid(CYCLE));
    let year = (day - day / 1_460 + day / 36_524 - day / (CYCLE - 1)) / 365;
    let day = day - (365 * year + year / 4 - year / 100);
    let month = (5 * day + 2) / 153;
    let day = day - (153 * month + 2) / 5 + 1;
    let (month, late) = if month < 10 {
        (month + 3, 0)
    } else {
        (month - 9, 1)
    };
    (400 * cycle + year + late, month, day)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verify_days_of_the_calendar() {
        let cases = [
            (0, (1970, 1, 1)),
            (-1, (1969, 12, 31)),
            (11_016, (2000, 2, 29)),
            (19_782, (2024, 2, 29)),
            (19_783, (2024, 3, 1)),
            (47_540, (2100, 2, 28)),
            (47_541, (2100, 3, 1)),
        ];
        for (days, date) in cases {
            assert_eq!(civil(days), date, "{days}");
        }
    }
}
