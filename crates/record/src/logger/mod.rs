//! Tables of text as loggers and spreadsheets write them.
//!
//! The layout is guessed from the first lines ([`layout`]), told in a note, and then held to: a row
//! that does not fit is an error with its line.

mod cells;
mod layout;
mod lvm;
mod names;
mod preamble;
mod programs;
mod rows;
mod scopes;
mod stamp;
mod table;
mod text;
mod time_of;
mod told;
mod twincat;

pub(crate) use cells::is_missing;
pub(crate) use layout::starts_by_contract;
#[cfg(feature = "xlsx")]
pub(crate) use rows::read_sheet;
pub(crate) use rows::read_table;
