//! Pages and pictures of a diagnosis.
//!
//! [`chart`] turns small typed descriptions into SVG, [`page`] a diagnosis into one self-contained
//! HTML page, [`summary`] into lines for a terminal. Everything is a pure function of its
//! arguments: no clock, no random identifiers, no files, so equal input gives equal bytes.
//!
//! ```
//! use simgap_report::chart::{LineChart, Role, Series};
//!
//! let chart = LineChart::new("Free decay", "time [s]", "y [mm]")
//!     .with(Series::from_points("measured", Role::Measured, &[(0.0, 1.0), (0.1, 0.8)]));
//! assert!(chart.to_svg()?.contains("time [s]"));
//! # Ok::<(), simgap_report::chart::ChartError>(())
//! ```

pub mod chart;
pub mod lines;
pub mod markup;
pub mod page;
pub mod schematic;
pub mod summary;

mod bands;
mod number;
mod restoring;
mod unit;
mod wording;
