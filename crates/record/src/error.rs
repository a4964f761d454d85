//! What can be wrong with a record.

use std::io;

use crate::faults::{FormatFault, MapFault, MendFault, SelectionFault, TextFault};
pub use crate::place::Place;
use crate::place::mending;
use crate::words::digits;
use crate::{Format, MAX_LINE_BYTES, MAX_ROWS, MIN_ROWS, Quantity, UNEVEN_FRACTION, UnitKind};

/// Why a record cannot be read, made or written. Each message is one line: file, line or column,
/// what was found, what is needed.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RecordError {
    /// No file of that name.
    #[error("{file}: no such file")]
    NotFound {
        /// Path as given.
        file: String,
    },
    /// A directory where a file is needed.
    #[error("{file}: is a directory, but a file is needed")]
    IsDirectory {
        /// Path as given.
        file: String,
    },
    /// The operating system refuses to read.
    #[error("{file}: cannot be read: {source}")]
    Unreadable {
        /// Path as given.
        file: String,
        /// What the system says.
        source: io::Error,
    },
    /// Nothing in the file, not even a header.
    #[error(
        "{file}: the file is empty, but a header such as 't [s],u [N],y [m]' and at least \
         {MIN_ROWS} rows are needed"
    )]
    Empty {
        /// File or record.
        file: String,
    },
    /// Too few rows to be a record, or none.
    #[error("{file}: {found} row(s) of data found, but at least {MIN_ROWS} are needed")]
    TooFewRows {
        /// File or record.
        file: String,
        /// Rows found.
        found: usize,
    },
    /// More rows than are read.
    #[error(
        "{file}: more than {MAX_ROWS} rows found, which is the limit; split the record or lower \
         its sample rate"
    )]
    TooManyRows {
        /// File or record.
        file: String,
    },
    /// A line beyond any sensible length: not a table of numbers.
    #[error(
        "{file}: line {line}: longer than {MAX_LINE_BYTES} bytes, which is the limit; one row of \
         numbers per line is needed"
    )]
    LongLine {
        /// File or record.
        file: String,
        /// Line, counted from 1.
        line: u64,
    },
    /// Bytes that are not UTF-8 text.
    #[error("{file}: line {line}: not UTF-8 text; save the file as CSV in UTF-8")]
    NotUtf8 {
        /// File or record.
        file: String,
        /// Line, counted from 1.
        line: u64,
    },
    /// Columns or lines separated by something else.
    #[error(
        "{file}: line {line}: {found} found, but {needed} are needed (and a point as decimal sign)"
    )]
    Separator {
        /// File or record.
        file: String,
        /// Line, counted from 1.
        line: u64,
        /// What separates here.
        found: &'static str,
        /// What has to separate.
        needed: &'static str,
    },
    /// A quotation mark that is opened and not closed on its line.
    #[error("{file}: line {line}: a quotation mark is not closed on this line")]
    OpenQuote {
        /// File or record.
        file: String,
        /// Line, counted from 1.
        line: u64,
    },
    /// A header cell without a unit in brackets.
    #[error(
        "{file}: line {line}: column {column} is headed '{found}', but a name and a unit in \
         brackets are needed, such as 'y [mm]' ('y [-]' if it has none)"
    )]
    MissingUnit {
        /// File or record.
        file: String,
        /// Line, counted from 1.
        line: u64,
        /// Column, counted from 1.
        column: usize,
        /// The header cell.
        found: String,
    },
    /// Two columns of one name.
    #[error(
        "{file}: {at}: columns {first} and {second} are both named '{name}'; names must differ"
    )]
    DuplicateColumn {
        /// File or record.
        file: String,
        /// Header line.
        at: Place,
        /// The name.
        name: String,
        /// First column of that name, counted from 1.
        first: usize,
        /// Second column of that name, counted from 1.
        second: usize,
    },
    /// No column of time stamps.
    #[error(
        "{file}: line {line}: no time column found among {has}; a column 't [s]' or 'time [s]' is \
         needed, or the name of another one, with --map \"t=COLUMN [s]\""
    )]
    NoTimeColumn {
        /// File or record.
        file: String,
        /// Line, counted from 1.
        line: u64,
        /// The columns there are.
        has: String,
    },
    /// A time column whose unit is no time.
    #[error(
        "{file}: line {line}: time column '{name}' is in [{unit}], but s, ms, us or min is needed"
    )]
    TimeUnit {
        /// File or record.
        file: String,
        /// Line, counted from 1.
        line: u64,
        /// Name of the time column.
        name: String,
        /// Its unit.
        unit: String,
    },
    /// A row with more or fewer cells than the header.
    #[error("{file}: line {line}: {found} cells found, but the header has {needed}")]
    CellCount {
        /// File or record.
        file: String,
        /// Line, counted from 1.
        line: u64,
        /// Cells in this row.
        found: usize,
        /// Cells in the header.
        needed: usize,
    },
    /// An empty cell.
    #[error(
        "{file}: line {line}: column '{column}' is empty, but a number is needed; --mend takes it as missing"
    )]
    MissingCell {
        /// File or record.
        file: String,
        /// Line, counted from 1.
        line: u64,
        /// Name of the column.
        column: String,
    },
    /// Text that is not a number.
    #[error("{file}: line {line}: column '{column}' holds '{found}', but a number is needed")]
    NotANumber {
        /// File or record.
        file: String,
        /// Line, counted from 1.
        line: u64,
        /// Name of the column.
        column: String,
        /// The text, shortened.
        found: String,
    },
    /// NaN, an infinity, or a number too large for a double.
    #[error("{file}: {at}: column '{column}' holds '{found}', but a finite number is needed{}", mending(*at, found))]
    NotFinite {
        /// File or record.
        file: String,
        /// Line or row.
        at: Place,
        /// Name of the column.
        column: String,
        /// The text or the value.
        found: String,
    },
    /// Time that stands still or runs backwards.
    #[error(
        "{file}: {at}: time goes from {previous} s to {found} s, but every stamp must be later \
         than the one before (repeated stamps often have too few decimals)"
    )]
    TimeOrder {
        /// File or record.
        file: String,
        /// Line or row of the later stamp.
        at: Place,
        /// The stamp before, s.
        previous: f64,
        /// The stamp, s.
        found: f64,
    },
    /// A time base that is not evenly spaced.
    #[error(
        "{file}: {at}: the time step is {} s here and {} s elsewhere, but even \
         spacing is needed (stamps off a uniform grid by no more than their rounding, and \
         {UNEVEN_FRACTION} of a step); --mend resamples to an even step, or split the record",
        digits(*found), digits(*usual)
    )]
    UnevenTime {
        /// File or record.
        file: String,
        /// Line or row of the stamp that ends the step.
        at: Place,
        /// Step here, s.
        found: f64,
        /// Median step of the record, s.
        usual: f64,
    },
    /// A time base for a generated record that is none.
    #[error(
        "{file}: a start of {start_s} s and a step of {time_step_s} s found, but a finite start \
         and a finite positive step are needed"
    )]
    TimeStep {
        /// Record.
        file: String,
        /// Start found, s.
        start_s: f64,
        /// Step found, s.
        time_step_s: f64,
    },
    /// A channel that is not as long as the time base.
    #[error("{file}: column '{column}' has {found} values, but there are {needed} time stamps")]
    LengthMismatch {
        /// Record or file to be written.
        file: String,
        /// Name of the column.
        column: String,
        /// Values found.
        found: usize,
        /// Time stamps.
        needed: usize,
    },
    /// A range of rows that is not in the record.
    #[error("{file}: rows {start} to {end} asked for, but the record has {len}")]
    RowRange {
        /// Record.
        file: String,
        /// First row asked for.
        start: usize,
        /// Row behind the last asked for.
        end: usize,
        /// Rows there are.
        len: usize,
    },
    /// A column that is needed and not there.
    #[error("{file}: column '{wanted}' is needed, but the file has {has}")]
    MissingColumn {
        /// File or record.
        file: String,
        /// The name needed.
        wanted: String,
        /// The columns there are.
        has: String,
    },
    /// A channel map that is none.
    #[error(transparent)]
    Map(#[from] MapFault),
    /// Columns that cannot be taken.
    #[error("{file}: {fault}")]
    Selection {
        /// File or record.
        file: String,
        /// What is wrong.
        fault: SelectionFault,
    },
    /// Missing samples or uneven stamps beyond what can be made good.
    #[error("{file}: {fault}")]
    Mending {
        /// File or record.
        file: String,
        /// What is wrong.
        fault: MendFault,
    },
    /// A table of text that cannot be taken apart.
    #[error("{file}: {fault}")]
    Text {
        /// File or record.
        file: String,
        /// What is wrong.
        fault: TextFault,
    },
    /// A file that its format does not allow, or this reader.
    #[error("{file}: {fault} ({format})")]
    Format {
        /// File or record.
        file: String,
        /// Format of the file.
        format: Format,
        /// What is wrong.
        fault: FormatFault,
    },
    /// A file too large to be held in memory.
    #[error("{file}: longer than {most} bytes, which is the limit; split the record")]
    TooLarge {
        /// File.
        file: String,
        /// Longest that is read, bytes.
        most: u64,
    },
    /// A unit that does not measure what the model takes from the channel.
    #[error("column '{channel}' {}", misfit(unit, *kind, *wanted))]
    UnitMismatch {
        /// Name of the column.
        channel: String,
        /// Its unit.
        unit: String,
        /// What that unit measures.
        kind: UnitKind,
        /// What is needed.
        wanted: Quantity,
    },
    /// An error of a channel, with the record it stands in.
    #[error("{file}: {source}")]
    InRecord {
        /// File or record.
        file: String,
        /// What is wrong there.
        source: Box<RecordError>,
    },
    /// Headers and columns to be written do not pair up.
    #[error("{file}: {headers} headers given for {columns} columns to be written")]
    HeaderCount {
        /// File to be written.
        file: String,
        /// Headers given.
        headers: usize,
        /// Columns given.
        columns: usize,
    },
    /// A file where a directory is needed.
    #[error("{path}: is a file, but a directory is needed")]
    NotADirectory {
        /// Path as given.
        path: String,
    },
    /// The operating system refuses to write.
    #[error("{path}: cannot be written: {source}")]
    Unwritable {
        /// Path as given.
        path: String,
        /// What the system says.
        source: io::Error,
    },
}

fn misfit(unit: &str, kind: UnitKind, wanted: Quantity) -> String {
    let examples = wanted.examples();
    if unit.is_empty() {
        return format!(
            "has no unit, but {wanted} is needed ({examples}): in the header, in a channel map \
             such as 'y=y [mm]', or a gain in the model"
        );
    }
    format!(
        "is in [{unit}], which is {kind}, but {wanted} is needed ({examples}), or a gain in the model"
    )
}
