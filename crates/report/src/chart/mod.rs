//! Typed descriptions of charts, and their SVG.
//!
//! A chart is described by plain data ([`LineChart`], [`BarChart`]) and drawn by its `to_svg`.
//! Colours belong to roles ([`Role`]), so that measured, nominal and corrected look the same in
//! every picture. Coordinates are rounded to a tenth of a pixel; long series are thinned to the
//! extremes of each pair of pixel columns, which looks the same and stays small.
//!
//! # Examples
//!
//! ```
//! use simgap_report::chart::{LineChart, Role, Series};
//! let t: Vec<f64> = (0..1000).map(|n| n as f64 * 0.001).collect();
//! let y: Vec<f64> = t.iter().map(|t| (31.4 * t).sin()).collect();
//! let svg = LineChart::new("Free decay", "time [s]", "y [m]")
//!     .with(Series::new("measured", Role::Measured, &t, &y))
//!     .to_svg()?;
//! assert!(svg.starts_with("<svg") && svg.contains("viewBox"));
//! # Ok::<(), simgap_report::chart::ChartError>(())
//! ```

mod axis;
mod bar;
mod canvas;
mod data;
mod decimate;
mod error;
mod legend;
mod line;
mod line_svg;
mod live;
mod palette;
mod plot;
mod series;
mod spectrum;

pub(crate) use axis::superscript;
pub use bar::{Bar, BarChart};
pub(crate) use canvas::standalone;
pub(crate) use data::{bars_csv, lines_csv};
pub use error::ChartError;
pub use line::{LineChart, Scale, Span};
pub(crate) use live::live_json;
pub use palette::{NEUTRAL_COLOURS, ROLE_COLOURS, Role, RoleColour};
pub use series::{Mark, Series};
pub use spectrum::SpectrumChart;

/// Size of a picture in pixels at its natural scale; the `viewBox` lets it scale.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ChartSize {
    /// Width, from 160 to 4000.
    pub width_px: u32,
    /// Height, from 60 to 4000.
    pub height_px: u32,
}

impl ChartSize {
    /// A size; checked when the chart is drawn.
    #[must_use]
    pub const fn new(width_px: u32, height_px: u32) -> Self {
        Self {
            width_px,
            height_px,
        }
    }

    fn check(self) -> Result<Self, ChartError> {
        let fits = (160..=4000).contains(&self.width_px) && (60..=4000).contains(&self.height_px);
        if fits {
            Ok(self)
        } else {
            Err(ChartError::SizeOutOfRange {
                width_px: self.width_px,
                height_px: self.height_px,
            })
        }
    }
}
