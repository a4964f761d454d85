//! The paper's Tables 1-5 as typed data with provenance; nothing computed.
//!
//! The numbers of Y. H. Park's mold oscillator paper (key: `park-mold`) live in
//! `crates/tables/fixtures/*.toml`, one line per printed number. They are embedded at build time and read
//! through typed accessors. Each number keeps three things: the string as printed, its value, and
//! where it stands in the paper.
//!
//! The only arithmetic here is the reading of digits and the change of unit to SI. Whatever the
//! numbers imply is computed elsewhere.
//!
//! ```
//! let table5 = simgap_tables::table5()?;
//! let row = &table5.rows[0];
//! assert_eq!(row.leaf_stiffness.printed(), "70,815,413.66");
//! assert_eq!(row.leaf_stiffness.si(), 70_815_413.66);
//! assert_eq!(row.leaf_stiffness.source().to_string(), "Table 5, row 1 Hz, column k_leaf (section 2.2.3)");
//! # Ok::<(), simgap_tables::TableError>(())
//! ```

mod checksum;
mod error;
mod paper;
mod printed;
mod raw;
mod stated;

pub use checksum::{CHECKSUMS, fixture_checksum, verify_checksums};
pub use error::TableError;
pub use paper::{
    BeatRow, FourierRow, LineRow, StiffnessRow, Table1, Table2, Table3, Table4, Table5, table1,
    table2, table3, table4, table5,
};
pub use printed::{HarmonicList, PrintedValue, Source, Unit};
pub use stated::{StatedLines, StatedValue, StatedValues, stated_values};
