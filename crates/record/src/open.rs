//! One entry for files of every format.

use std::borrow::Cow;
use std::io::{BufReader, Read};
use std::path::Path;

use crate::csv_header::Wanted;
use crate::csv_read::Reader;
use crate::error::RecordError;
use crate::faults::FormatFault;
use crate::file::{BUFFER_BYTES, all_bytes, opened};
use crate::format::Format;
use crate::logger::{self, starts_by_contract};
use crate::note::Note;
use crate::raw::{Raw, assemble};
use crate::select::{Mend, ReadOptions, Reading};
use crate::{arrays, mat5, tdms, uff};

/// As many bytes tell the format.
const HEAD_BYTES: usize = 1 << 16;

/// Reads a record from a file of any format that is known; which one, its first bytes tell.
///
/// A CSV of the form of the contract (`t [s],u [N],y1 [m]`, commas, points) is read line by line
/// and strictly, as [`crate::read_csv`] does. Any other table of text is taken apart by its looks:
/// separator, decimal sign, lines before the header, a row of units, dates and times of day, words
/// for missing values, encoding. What was guessed is told in [`Reading::notes`]. In such files, and
/// in those of measurement programs, missing samples are filled by a curve through their neighbours and an
/// uneven time base is resampled, and told too; [`Mend`] changes that.
///
/// ```
/// use simgap_record::{ChannelMap, ReadOptions, read_file};
///
/// let dir = tempfile::tempdir()?;
/// let path = dir.path().join("run.txt");
/// let mut text = String::from("Logger 7\nZeit;Kraft;Weg\ns;kN;mm\n");
/// for k in 0..20 {
///     text += &format!("0,{k:02};1,5;{k},25\n");
/// }
/// std::fs::write(&path, text)?;
/// let map = ChannelMap::parse(["u=Kraft", "y=Weg"])?;
/// let reading = read_file(&path, &ReadOptions::channels(["u", "y"], [""; 0]).with_map(map))?;
/// assert_eq!(reading.record.require("y")?.values[3], 3.25);
/// assert_eq!(
///     reading.notes[0].to_string(),
///     "read as a table separated by semicolons with a decimal comma, header in line 2, units in \
///      line 3",
/// );
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
///
/// Any of [`RecordError`], with the path as given and the line, the byte or the row.
pub fn read_file(path: &Path, options: &ReadOptions) -> Result<Reading, RecordError> {
    let label = path.display().to_string();
    let (mut file, name) = opened(path, &label)?;
    let refused = |source| RecordError::Unreadable {
        file: label.clone(),
        source,
    };
    let mut head = Vec::new();
    (&mut file)
        .take(HEAD_BYTES as u64)
        .read_to_end(&mut head)
        .map_err(refused)?;
    let format = Format::of(&head, path);
    let by_contract = format == Format::Text && starts_by_contract(&head);
    // A pipe cannot be read twice: the head goes before the rest.
    let whole = head.as_slice().chain(file);
    let plain = options.map.is_empty() && options.columns.is_empty();
    if by_contract && plain && options.mend != Mend::Always {
        return strict(&label, name.clone(), whole, options)
            .or_else(|error| second_look(path, &label, name, options, error));
    }
    let bytes = all_bytes(whole, &label)?;
    let mend = match options.mend {
        Mend::Always => true,
        Mend::Foreign => !by_contract,
        Mend::Never => false,
    };
    read_bytes(&label, name, bytes.into(), format, options, mend)
}

/// Reads a record from the bytes of a file, as [`read_file`]; `name` names the record, stands for
/// the file in messages, and its ending tells the format where the bytes do not.
///
/// # Errors
///
/// As [`read_file`].
pub fn parse_file(name: &str, bytes: &[u8], options: &ReadOptions) -> Result<Reading, RecordError> {
    let head = &bytes[..bytes.len().min(HEAD_BYTES)];
    let format = Format::of(head, Path::new(name));
    let by_contract = format == Format::Text && starts_by_contract(head);
    let mend = options.mend == Mend::Always || (options.mend == Mend::Foreign && !by_contract);
    read_bytes(name, name.to_owned(), bytes.into(), format, options, mend)
}

fn read_bytes(
    label: &str,
    name: String,
    bytes: Cow<'_, [u8]>,
    format: Format,
    options: &ReadOptions,
    mend: bool,
) -> Result<Reading, RecordError> {
    if format == Format::Text {
        return logger::read_table(label, name, &bytes, options, mend);
    }
    #[cfg(feature = "xlsx")]
    if format == Format::Xlsx {
        return workbook(label, name, &bytes, options, mend);
    }
    let mut notes = Vec::new();
    let raw = raw_of(bytes, format, &mut notes).map_err(|fault| RecordError::Format {
        file: label.to_owned(),
        format,
        fault,
    })?;
    assemble(label, name, raw, options, mend, notes)
}

/// The sheet with most numbers, as a table of text.
#[cfg(feature = "xlsx")]
fn workbook(
    label: &str,
    name: String,
    bytes: &[u8],
    options: &ReadOptions,
    mend: bool,
) -> Result<Reading, RecordError> {
    let (sheet, others) = crate::xlsx::read(bytes).map_err(|fault| RecordError::Format {
        file: label.to_owned(),
        format: Format::Xlsx,
        fault,
    })?;
    let note = Note::Sheet {
        name: sheet.name,
        others,
    };
    logger::read_sheet(label, name, &sheet.text, options, mend, note)
}

fn raw_of(bytes: Cow<'_, [u8]>, format: Format, notes: &mut Vec<Note>) -> Result<Raw, FormatFault> {
    let unread = |instead| {
        Err(FormatFault::Unsupported {
            found: format!("a {format}"),
            instead,
        })
    };
    match format {
        Format::Mat5 => {
            let workspace = mat5::read(&bytes, notes)?;
            Ok(arrays::to_raw(workspace, notes))
        }
        Format::Uff => uff::read(&bytes, notes),
        Format::Tdms => tdms::read(&bytes, notes),
        #[cfg(feature = "matlab73")]
        Format::Hdf5 => {
            let workspace = crate::hdf5::read(bytes.into_owned(), notes)?;
            Ok(arrays::to_raw(workspace, notes))
        }
        #[cfg(feature = "parquet")]
        Format::Parquet => crate::columnar::read(bytes.into_owned(), notes),
        #[cfg(feature = "mdf")]
        Format::Mdf => crate::mdf::read(bytes.into_owned(), notes),
        #[cfg(feature = "arrow")]
        Format::Arrow => crate::arrow::read(&bytes, notes),
        #[cfg(not(feature = "matlab73"))]
        Format::Hdf5 => unread("save it with -v7 in MATLAB, or as CSV"),
        Format::Zip => unread("unpack it first"),
        Format::Xls => unread("save it as .xlsx or as CSV"),
        Format::Gzip => unread("unpack it first"),
        _ => unread("save it as CSV, Parquet, MAT, UFF or TDMS"),
    }
}

fn strict(
    label: &str,
    name: String,
    file: impl Read,
    options: &ReadOptions,
) -> Result<Reading, RecordError> {
    let text = BufReader::with_capacity(BUFFER_BYTES, file);
    let reader = Reader::new(label, text);
    let record = match &options.wanted {
        None => reader.record(name, None)?,
        Some(wanted) => {
            let needed: Vec<&str> = wanted.needed.iter().map(String::as_str).collect();
            let welcome: Vec<&str> = wanted.welcome.iter().map(String::as_str).collect();
            let wanted = Wanted {
                needed: &needed,
                welcome: &welcome,
            };
            reader.record(name, Some(wanted))?
        }
    };
    Ok(Reading {
        record,
        notes: vec![],
    })
}

/// Brackets may stand in a line before the header, and not every column of a file that is read
/// whole need have a unit. Otherwise the first error stands.
fn second_look(
    path: &Path,
    label: &str,
    name: String,
    options: &ReadOptions,
    error: RecordError,
) -> Result<Reading, RecordError> {
    let of_header = matches!(
        error,
        RecordError::MissingUnit { .. }
            | RecordError::NoTimeColumn { .. }
            | RecordError::DuplicateColumn { .. }
            | RecordError::CellCount { .. }
    );
    if !of_header || !path.is_file() {
        return Err(error);
    }
    let (file, _) = opened(path, label)?;
    let bytes = all_bytes(file, label)?;
    // The name of the time column says its unit: `time_ms`.
    let lacks_time = matches!(error, RecordError::NoTimeColumn { .. });
    let takes_all = options.wanted.is_none() || lacks_time;
    match logger::read_table(label, name, &bytes, options, false) {
        Ok(reading) if takes_all || reading.has_later_header() => Ok(reading),
        _ => Err(error),
    }
}
