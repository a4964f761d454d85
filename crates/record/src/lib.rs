//! Measured records: channels, units, time base, file formats, quality checks.
//!
//! A [`Record`] is a table of equally long columns over one evenly spaced time base. Every
//! [`Channel`] keeps its values as they were written together with the [`Unit`] of its header;
//! [`Channel::si_values`] converts on request and refuses a unit that does not fit the
//! [`Quantity`] asked for. Whoever makes a record, from a file ([`read_file`], of any [`Format`]) or
//! from numbers ([`Record::new`]), passes the same checks, so that later crates need none of their
//! own.
//!
//! A CSV of the contract's own form is read strictly. In a file of a logger or a measurement
//! program the layout is guessed, missing samples are filled and uneven stamps resampled, and every
//! [`Note`] of a [`Reading`] says one of these things; [`ReadOptions`] chooses columns, names and
//! units ([`ChannelMap`]) and whether faults are made good ([`Mend`]).
//!
//! ```
//! use simgap_record::{Quantity, parse_csv};
//!
//! let mut text = String::from("t [ms],y [mm]\n");
//! for k in 0..10 {
//!     text += &format!("{k},{}\n", 0.5 * f64::from(k));
//! }
//! let record = parse_csv("A.csv", text.as_bytes())?;
//! assert!((record.sample_rate_hz() - 1000.0).abs() < 1e-6);
//! let displacement = record.require("y")?.si_values(Quantity::Displacement)?;
//! assert_eq!(displacement[3], 1.5e-3);
//! # Ok::<(), simgap_record::RecordError>(())
//! ```

mod arrays;
#[cfg(any(feature = "arrow", feature = "parquet"))]
#[cfg_attr(
    not(feature = "arrow"),
    expect(dead_code, reason = "Parquet needs the schema alone")
)]
mod arrow;
mod base;
mod batch;
mod bytes;
#[cfg(any(feature = "arrow", feature = "parquet"))]
mod calendar;
mod channel;
mod clock;
#[cfg(feature = "parquet")]
mod columnar;
mod csv_header;
mod csv_read;
mod csv_write;
mod error;
mod faults;
mod file;
mod fill;
#[cfg(any(
    feature = "arrow",
    feature = "matlab73",
    feature = "mdf",
    feature = "parquet",
    feature = "xlsx"
))]
#[cfg_attr(
    not(any(
        feature = "matlab73",
        feature = "mdf",
        feature = "parquet",
        feature = "xlsx"
    )),
    allow(dead_code, reason = "Arrow is read without another crate's reader")
)]
mod foreign;
mod format;
#[cfg(feature = "matlab73")]
mod hdf5;
#[cfg(feature = "matlab73")]
mod hdf5_cells;
#[cfg(feature = "matlab73")]
mod hdf5_newest;
#[cfg(feature = "matlab73")]
mod hdf5_types;
mod heading;
mod limits;
mod logger;
mod map;
mod mat5;
mod mat_objects;
#[cfg(feature = "mdf")]
mod mdf;
mod mend;
mod mended;
mod new_file;
mod note;
mod open;
mod overload;
mod panics;
mod place;
mod quality;
mod quantity;
mod raw;
mod record;
mod resample;
mod same;
mod select;
mod tdms;
mod time_base;
mod time_names;
mod uff;
mod uff_lines;
mod unit;
mod words;
mod write;
#[cfg(feature = "xlsx")]
mod xlsx;
#[cfg(feature = "xlsx")]
mod zip_size;

pub use batch::{Batch, ensure_replaceable};
pub use channel::{Channel, Conversion};
pub use csv_read::{parse_csv, read_csv, read_csv_channels, read_csv_some};
pub use error::{Place, RecordError};
pub use faults::{FormatFault, MapFault, MendFault, SelectionFault, TextFault};
pub use format::Format;
pub use limits::{MAX_FILE_BYTES, MAX_LINE_BYTES, MAX_ROWS, MIN_ROWS};
pub use map::{ChannelMap, MapEntry};
pub use note::Note;
pub use open::{parse_file, read_file};
pub use panics::without_panic;
pub use quality::{Defect, Edge, QualityFinding, quality};
pub use quantity::Quantity;
pub use record::Record;
pub use same::{AuditFinding, AuditTopic, audit, found_within};
pub use select::{Mend, ReadOptions, Reading};
pub use time_base::UNEVEN_FRACTION;
pub use unit::{Unit, UnitKind};
pub use write::{ensure_writable_dir, write_csv_atomic, write_text_atomic};
