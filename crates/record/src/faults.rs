//! What can be wrong with files of loggers and measurement programs: the parts of
//! [`crate::RecordError`] that belong to one step of reading each.

use crate::place::Place;
use crate::words::digits;

/// What is wrong with a channel map.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MapFault {
    /// An entry of another form.
    #[error(
        "'{found}' found in the channel map, but CHANNEL=COLUMN or 'CHANNEL=COLUMN [UNIT]' is needed"
    )]
    Entry {
        /// The entry, shortened.
        found: String,
    },
    /// Two entries about one channel.
    #[error("channel '{channel}' is mapped twice, but one column is needed for it")]
    Twice {
        /// Name of the channel.
        channel: String,
    },
    /// Names of columns that are none.
    #[error(
        "{found} found in the list of columns, but a different name for each column is needed, such as \"t [s],u [N],y [mm]\""
    )]
    Columns {
        /// What is wrong.
        found: String,
    },
    /// An entry about a channel nobody asks for.
    #[error("the channel map names '{channel}', but the model has {has}{near}")]
    Channel {
        /// Name of the channel.
        channel: String,
        /// The channels there are.
        has: String,
        /// Those like it, ready for the message.
        near: String,
    },
}

/// Why the columns asked for cannot be taken.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SelectionFault {
    /// No column of that name.
    #[error("column '{wanted}' is needed, but the file has {has}{near}")]
    Unknown {
        /// The name needed.
        wanted: String,
        /// The columns there are.
        has: String,
        /// Those like it, ready for the message.
        near: String,
    },
    /// Two columns of one name.
    #[error("columns {first} and {second} are both named '{name}'; names must differ")]
    Ambiguous {
        /// The name.
        name: String,
        /// First column of that name, counted from 1.
        first: usize,
        /// Second column of that name, counted from 1.
        second: usize,
    },
    /// A time column whose unit is no time.
    #[error(
        "column '{name}' is taken for the time base and is in [{unit}], but s, ms, us or min is needed; name another one with --map \"t=COLUMN\", or its unit with --map \"t={name} [s]\""
    )]
    TimeUnit {
        /// Name of the time column.
        name: String,
        /// Its unit.
        unit: String,
    },
    /// Stamps whose unit nothing settles.
    #[error("time column '{name}' {because}; say which it is with {choices}")]
    TimeChoice {
        /// Name of the time column.
        name: String,
        /// What speaks against the unit that would be taken.
        because: String,
        /// The flags, each with the sample rate it makes.
        choices: String,
    },
    /// Nothing that could be the time base.
    #[error(
        "no time base found; the file has {has}; name its time with a map such as 't={example}'"
    )]
    NoTime {
        /// The columns there are.
        has: String,
        /// One of them.
        example: String,
    },
    /// No columns at all.
    #[error("no column of numbers found, but a time base and channels are needed{left_out}")]
    Nothing {
        /// What was left out and why, ready for the message.
        left_out: String,
    },
    /// Names of columns for a file that has names.
    #[error(
        "names of columns are given, but only tables of text need them; name the columns of this file with --map CHANNEL=COLUMN"
    )]
    ColumnsOfNoTable,
    /// Channels whose stamps lie between those of the others, where nothing may be changed.
    #[error(
        "channel '{column}' has stamps of its own, between those of the others, and would have to be interpolated; --mend does that"
    )]
    OtherStamps {
        /// Name of the channel.
        column: String,
    },
    /// Channels that were not recorded at the same time.
    #[error(
        "channels {columns} have time bases of their own that share fewer than {} rows, but one time base is needed",
        crate::MIN_ROWS
    )]
    Apart {
        /// Their names.
        columns: String,
    },
}

/// Why a fault of a record cannot be made good.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MendFault {
    /// More samples missing than there may be.
    #[error(
        "{missing} of {of} samples of column '{column}' are missing, but at most {most_percent} % may be"
    )]
    TooManyMissing {
        /// Name of the column.
        column: String,
        /// Samples missing.
        missing: usize,
        /// Samples there should be.
        of: usize,
        /// Most that may be missing, per cent.
        most_percent: u32,
    },
    /// The mark of an instrument for an overload or no reading, where nothing is mended.
    #[error(
        "{at}: column '{column}' holds {found:e}, the mark of an instrument for an overload or no reading, but a measured value is needed; --mend takes it as missing"
    )]
    Overload {
        /// Line or row.
        at: Place,
        /// Name of the column.
        column: String,
        /// The mark.
        found: f64,
    },
    /// A gap too long to be bridged.
    #[error("{at}: the time step is {} s here and {} s as a rule, but a gap of at most {most} steps can be bridged; split the record there", digits(*found), digits(*usual))]
    Gap {
        /// Line or row of the stamp that ends the gap.
        at: Place,
        /// Length of the gap, s.
        found: f64,
        /// Usual step, s.
        usual: f64,
        /// Longest gap that is bridged, steps.
        most: f64,
    },
}

/// What is wrong with a table of text of unknown layout.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TextFault {
    /// Bytes that no text holds.
    #[error(
        "line {line}: bytes that are no text, and no format that is known; a table of text (CSV), Parquet, MAT, UFF or TDMS is needed"
    )]
    NotText {
        /// Line, counted from 1.
        line: u64,
    },
    /// No table of numbers.
    #[error(
        "line 1: '{first}' found, but no table of numbers in the first {looked_at} line(s), separated by comma, semicolon, tab or spaces (commas cannot separate numbers with decimal commas)"
    )]
    NoTable {
        /// Lines that were looked at.
        looked_at: usize,
        /// The first one with something in it, shortened.
        first: String,
    },
    /// Numbers without a header.
    #[error(
        "line {line}: {width} columns of numbers begin here, but no line of as many names stands above them; name them with --columns \"{example}\""
    )]
    NoHeader {
        /// First line of the numbers, counted from 1.
        line: u64,
        /// Their columns.
        width: usize,
        /// Names for as many columns.
        example: String,
    },
    /// More or fewer names given than there are columns.
    #[error(
        "line {line}: {needed} columns of numbers begin here, but --columns names {found}; a name for each is needed"
    )]
    ColumnCount {
        /// First line of the numbers, counted from 1.
        line: u64,
        /// Names given.
        found: usize,
        /// Columns there are.
        needed: usize,
    },
    /// A file of a known program or instrument that lacks something.
    #[error("line {line}: {found}, but {needed} is needed ({program})")]
    Program {
        /// Line, counted from 1.
        line: u64,
        /// What was found.
        found: String,
        /// What is needed.
        needed: &'static str,
        /// Whose layout it is.
        program: &'static str,
    },
    /// A cell of the time column that is no stamp.
    #[error(
        "line {line}: column '{column}' holds '{found}', but a date and time such as 2024-03-01T12:00:00.500 is needed"
    )]
    NotAStamp {
        /// Line, counted from 1.
        line: u64,
        /// Name of the column.
        column: String,
        /// The text, shortened.
        found: String,
    },
    /// A 30 February.
    #[error(
        "line {line}: column '{column}' holds a date there is not, or in another form than the rows above"
    )]
    NoSuchDate {
        /// Line, counted from 1.
        line: u64,
        /// Name of the column.
        column: String,
    },
}

/// What is wrong with a file of a binary or otherwise fixed format.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FormatFault {
    /// The file ends, or claims more than it holds.
    #[error(
        "{at}: {needed} byte(s) of {what} are needed, but {left} are left; the file is cut off or damaged"
    )]
    Truncated {
        /// Where the missing bytes begin.
        at: Place,
        /// What they would be.
        what: &'static str,
        /// How many there should be.
        needed: u64,
        /// How many there are.
        left: u64,
    },
    /// Something that the format does not allow.
    #[error("{at}: {found} found, but {needed} is needed")]
    Malformed {
        /// Where.
        at: Place,
        /// What was found.
        found: String,
        /// What is needed.
        needed: &'static str,
    },
    /// Something that the format allows and this reader does not take.
    #[error("{found} found, which is not read; {instead}")]
    Unsupported {
        /// What was found.
        found: String,
        /// What to do instead.
        instead: &'static str,
    },
    /// A part of a file that the reader of its format gives up on.
    #[error(
        "{what} cannot be read ({reason}); the file is cut off, damaged or of a form that is not known"
    )]
    Damaged {
        /// The part.
        what: String,
        /// What the reader says.
        reason: String,
    },
    /// More than is read.
    #[error("more than {most} {what} found, which is the limit")]
    TooMuch {
        /// Most that is read.
        most: u64,
        /// Of what.
        what: &'static str,
    },
}
