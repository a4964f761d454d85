//! Pages and pictures of a diagnosis.
//!
//! [`chart`] turns small typed descriptions into SVG. Everything is a pure function of its
//! arguments: no clock, no random identifiers, no files, so equal input gives equal bytes.

pub mod chart;
mod markup;
mod number;
