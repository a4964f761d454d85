//! Which format a file has.

use std::fmt;
use std::path::Path;

/// A file format that records come in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Format {
    /// A table of text: CSV and its relatives.
    Text,
    /// MATLAB level 5, what `save -v6` and `save -v7` write.
    Mat5,
    /// MATLAB 7.3, and HDF5 in general.
    Hdf5,
    /// Universal file format, dataset 58.
    Uff,
    /// Apache Parquet.
    Parquet,
    /// ASAM MDF.
    Mdf,
    /// National Instruments TDMS.
    Tdms,
    /// Arrow IPC, which is Feather of version 2.
    Arrow,
    /// A workbook of Excel (.xlsx).
    Xlsx,
    /// A workbook of Excel before 2007 (.xls).
    Xls,
    /// Another ZIP archive.
    Zip,
    /// gzip.
    Gzip,
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Format::Text => "table of text",
            Format::Mat5 => "MATLAB file",
            Format::Hdf5 => "HDF5 or MATLAB 7.3 file",
            Format::Uff => "universal file (UFF)",
            Format::Parquet => "Parquet file",
            Format::Mdf => "MDF file",
            Format::Tdms => "TDMS file",
            Format::Arrow => "Arrow or Feather file",
            Format::Xlsx => "Excel workbook",
            Format::Xls => "Excel workbook of before 2007",
            Format::Zip => "ZIP archive",
            Format::Gzip => "gzip archive",
        })
    }
}

impl Format {
    /// The format that the first bytes of a file tell; by the ending of its name where they do not.
    ///
    /// ```
    /// use std::path::Path;
    /// use simgap_record::Format;
    ///
    /// assert_eq!(Format::of(b"PAR1....", Path::new("run.csv")), Format::Parquet);
    /// assert_eq!(Format::of(b"t [s],y [m]\n", Path::new("run.csv")), Format::Text);
    /// ```
    #[must_use]
    pub fn of(head: &[u8], path: &Path) -> Format {
        const HDF5: &[u8] = b"\x89HDF\r\n\x1a\n";
        let starts = |magic: &[u8]| head.starts_with(magic);
        if starts(HDF5) || starts(b"MATLAB 7.3") || head.get(512..520) == Some(HDF5) {
            return Format::Hdf5;
        }
        if starts(b"MATLAB 5.0 MAT-file")
            || matches!(
                head.get(124..128),
                Some([0, 1, b'I', b'M'] | [1, 0, b'M', b'I'])
            )
        {
            return Format::Mat5;
        }
        if starts(b"PAR1") {
            return Format::Parquet;
        }
        if starts(b"MDF     ") || starts(b"UnFinMF ") {
            return Format::Mdf;
        }
        if starts(b"TDSm") || starts(b"TDSh") {
            return Format::Tdms;
        }
        if starts(b"ARROW1\0\0") || starts(b"FEA1") {
            return Format::Arrow;
        }
        if starts(b"PK\x03\x04") {
            let names = |name: &[u8]| head.windows(name.len()).any(|window| window == name);
            let book = names(b"[Content_Types].xml")
                || names(b"xl/")
                || has_ending(path, &["xlsx", "xlsm"]);
            return if book { Format::Xlsx } else { Format::Zip };
        }
        if starts(b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1") {
            return Format::Xls;
        }
        if starts(b"\x1f\x8b") {
            return Format::Gzip;
        }
        if is_uff(head) {
            return Format::Uff;
        }
        by_ending(path)
    }
}

/// A line that holds -1 alone, then the number of a dataset.
fn is_uff(head: &[u8]) -> bool {
    let mut lines = head
        .split(|&byte| byte == b'\n')
        .map(|line| line.trim_ascii())
        .filter(|line| !line.is_empty());
    let number = |line: &[u8]| {
        let digits = line.iter().take_while(|byte| byte.is_ascii_digit()).count();
        let rest = line.get(digits..).unwrap_or_default();
        (1..=5).contains(&digits) && (rest.is_empty() || rest[0] == b'b')
    };
    lines.next() == Some(b"-1") && lines.next().is_some_and(number)
}

fn ending(path: &Path) -> Option<String> {
    let ending = path.extension()?;
    Some(ending.to_string_lossy().to_lowercase())
}

fn has_ending(path: &Path, endings: &[&str]) -> bool {
    ending(path).is_some_and(|ending| endings.contains(&ending.as_str()))
}

fn by_ending(path: &Path) -> Format {
    match ending(path).as_deref() {
        Some("mat") => Format::Mat5,
        Some("uff" | "unv" | "bunv") => Format::Uff,
        Some("parquet") => Format::Parquet,
        Some("mf4" | "mdf") => Format::Mdf,
        Some("tdms") => Format::Tdms,
        Some("h5" | "hdf5") => Format::Hdf5,
        Some("arrow" | "arrows" | "feather" | "ipc") => Format::Arrow,
        _ => Format::Text,
    }
}
