//! Pages and pictures of a diagnosis.
//!
//! [`chart`] turns small typed descriptions into SVG, [`page`] a diagnosis into one self-contained
//! HTML page, [`summary`] into lines for a terminal. Everything is a pure function of its
//! arguments: no clock, no random identifiers, no files, so equal input gives equal bytes.

pub mod chart;
pub mod lines;
pub mod page;
pub mod summary;

mod markup;
mod number;
mod unit;
mod wording;
