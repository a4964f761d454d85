//! What was guessed or changed while a file was read, for the reader of a report.

use std::fmt;

use crate::words::{digits, name_list, shortened};

/// Something that was not in the file, or not as it stands there. One sentence each.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Note {
    /// How a table of text was taken apart.
    Dialect {
        /// What separates the cells.
        separator: &'static str,
        /// Whether numbers have a decimal comma.
        decimal_comma: bool,
        /// Line of the header, counted from 1; 0 where the names were given.
        header: u64,
        /// Line of the units, where they have one of their own.
        units: Option<u64>,
        /// Whether the decimal sign was decided by nothing but the first reading that fits.
        undecided: bool,
    },
    /// Text in another encoding than UTF-8.
    Encoding {
        /// Its name.
        encoding: &'static str,
    },
    /// Time from dates and times of day.
    Stamps {
        /// Column, or columns, of the stamps.
        column: String,
        /// How they were read.
        form: &'static str,
        /// The stamp at which time is 0, as written.
        first: String,
    },
    /// Dates whose order of day and month the record does not settle.
    DayOrder {
        /// Column of the stamps.
        column: String,
        /// The order that was taken.
        taken: &'static str,
    },
    /// A time column without a unit.
    SecondsAssumed {
        /// Column of the stamps.
        column: String,
    },
    /// A unit of time that only the name of the column says.
    UnitFromName {
        /// Column of the stamps.
        column: String,
        /// The unit.
        unit: &'static str,
    },
    /// A unit of time that stamps without a unit can only have.
    UnitFromStamps {
        /// Column of the stamps.
        column: String,
        /// The unit.
        unit: &'static str,
        /// The first stamp.
        first: f64,
    },
    /// A time base that counts from its first stamp.
    CountedFrom {
        /// Column of the stamps.
        column: String,
        /// The first stamp and its unit.
        first: String,
    },
    /// A channel with a time base of its own, brought to that of the others.
    Aligned {
        /// Name of the channel.
        channel: String,
        /// How much later than the reference it begins, s.
        late_s: f64,
        /// Whether its values are interpolated.
        interpolated: bool,
        /// Rows that all share.
        rows: usize,
    },
    /// A time base that no name or unit tells.
    TimeChosen {
        /// Column taken as time.
        column: String,
        /// Why.
        because: &'static str,
    },
    /// A column that a map gave another name or unit.
    Mapped {
        /// Name in the model.
        channel: String,
        /// Name in the file.
        column: String,
        /// Unit in the file, if any.
        unit: String,
        /// Unit that the map gives instead.
        given: Option<String>,
    },
    /// A column that was left out.
    LeftOut {
        /// Its name.
        column: String,
        /// Why.
        because: String,
    },
    /// Marks of an instrument for an overload or no reading, taken as missing samples.
    Overloaded {
        /// Name of the channel.
        channel: String,
        /// Samples that hold one.
        marks: usize,
    },
    /// Missing samples, in whose place the values of a curve stand.
    Filled {
        /// Name of the channel.
        channel: String,
        /// Samples missing.
        missing: usize,
        /// Samples there should be.
        of: usize,
        /// Most missing in a row.
        longest_run: usize,
    },
    /// An uneven time base that was resampled.
    Resampled {
        /// Shortest interval of the stamps, s.
        shortest_s: f64,
        /// Longest interval of the stamps, s.
        longest_s: f64,
        /// Step of the new time base, s.
        step_s: f64,
        /// Rows before.
        rows_before: usize,
        /// Rows now.
        rows: usize,
        /// A sine of this frequency loses at most 1 % in the longest interval, Hz.
        trusted_hz: f64,
    },
    /// The sheet of a workbook that was read.
    Sheet {
        /// Its name.
        name: String,
        /// Others that hold numbers.
        others: Vec<String>,
    },
    /// What a file of a certain format holds beside what was read.
    Source {
        /// One sentence.
        text: String,
    },
}

impl fmt::Display for Note {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Note::Dialect {
                separator,
                decimal_comma,
                header,
                units,
                undecided,
            } => {
                let decimal = if *decimal_comma { "comma" } else { "point" };
                write!(
                    f,
                    "read as a table separated by {separator} with a decimal {decimal}, "
                )?;
                match header {
                    0 => f.write_str("columns named as given")?,
                    line => write!(f, "header in line {line}")?,
                }
                if let Some(line) = units {
                    write!(f, ", units in line {line}")?;
                }
                if *undecided {
                    f.write_str(" (no number settles the decimal sign)")?;
                }
                Ok(())
            }
            Note::Encoding { encoding } => write!(f, "text read as {encoding}, not UTF-8"),
            Note::Stamps {
                column,
                form,
                first,
            } => write!(
                f,
                "time read from {} as {form}, counted from {}",
                quoted(column),
                shortened(first)
            ),
            Note::DayOrder { column, taken } => write!(
                f,
                "the dates of {} do not settle which number is the day; read as {taken}",
                quoted(column)
            ),
            Note::SecondsAssumed { column } => {
                write!(
                    f,
                    "time column {} has no unit; seconds assumed",
                    quoted(column)
                )
            }
            Note::UnitFromName { column, unit } => write!(
                f,
                "time column {} read in {unit}, which its name says",
                quoted(column)
            ),
            Note::UnitFromStamps {
                column,
                unit,
                first,
            } => write!(
                f,
                "time column {} has no unit; read in {unit}, in which its first stamp {first} is a \
                 date of this century",
                quoted(column)
            ),
            Note::CountedFrom { column, first } => write!(
                f,
                "time of {} counted from its first stamp, {}",
                quoted(column),
                shortened(first)
            ),
            Note::Aligned { .. } => self.aligned(f),
            Note::TimeChosen { column, because } => {
                write!(f, "column {} taken as time: {because}", quoted(column))
            }
            Note::Mapped { .. } => self.mapped(f),
            Note::LeftOut { column, because } => {
                write!(f, "column {} left out: {because}", quoted(column))
            }
            Note::Overloaded { channel, marks } => write!(
                f,
                "{marks} samples of {} hold the mark of an instrument for an overload or no reading \
                 (9.9e37 or 9.91e37); taken as missing",
                quoted(channel)
            ),
            Note::Filled {
                channel,
                missing,
                of,
                longest_run,
            } => write!(
                f,
                "{missing} of {of} samples of {} are missing, at most {longest_run} in a row; a \
                 curve through those beside them stands in their place",
                quoted(channel)
            ),
            Note::Resampled { .. } => self.resampled(f),
            Note::Sheet { name, others } => {
                write!(f, "sheet {} is read", quoted(name))?;
                if others.is_empty() {
                    return Ok(());
                }
                let others = name_list(others.iter().map(String::as_str));
                write!(f, ", which has the most numbers; not read: {others}")
            }
            Note::Source { text } => f.write_str(text),
        }
    }
}

impl Note {
    fn mapped(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Note::Mapped {
            channel,
            column,
            unit,
            given,
        } = self
        else {
            return Ok(());
        };
        write!(f, "{} read from column {}", quoted(channel), quoted(column))?;
        match given {
            Some(given) if given == unit => Ok(()),
            Some(given) if unit.is_empty() => write!(f, " in [{given}], which the map gives"),
            Some(given) => write!(f, " in [{given}], which the map gives in place of [{unit}]"),
            None => Ok(()),
        }
    }

    fn aligned(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Note::Aligned {
            channel,
            late_s,
            interpolated,
            rows,
        } = self
        else {
            return Ok(());
        };
        write!(f, "{} has a time base of its own", quoted(channel))?;
        if *late_s != 0.0 {
            let word = if *late_s > 0.0 { "later" } else { "earlier" };
            write!(f, ", which begins {} s {word}", digits(late_s.abs()))?;
        }
        write!(f, "; read on the {rows} stamps that all channels share")?;
        if *interpolated {
            f.write_str(", by cubic interpolation")?;
        }
        Ok(())
    }

    fn resampled(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Note::Resampled {
            shortest_s,
            longest_s,
            step_s,
            rows_before,
            rows,
            trusted_hz,
        } = self
        else {
            return Ok(());
        };
        write!(
            f,
            "uneven time base (intervals of {} to {} s, {rows_before} rows) resampled to a step \
             of {} s ({rows} rows) by cubic interpolation; trustworthy up to {} Hz, where a \
             sine loses 1 % in the longest interval",
            digits(*shortest_s),
            digits(*longest_s),
            digits(*step_s),
            short(*trusted_hz)
        )
    }
}

fn quoted(name: &str) -> String {
    format!("'{}'", shortened(name))
}

/// Three digits are enough for a bound.
fn short(value: f64) -> f64 {
    format!("{value:.2e}").parse().unwrap_or(value)
}
