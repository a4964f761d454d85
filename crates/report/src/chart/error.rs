//! What can be wrong with the description of a chart.

/// Why a chart cannot be drawn.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ChartError {
    /// The two lists of a series do not go together.
    #[error(
        "series `{series}` of chart `{chart}` has {y_len} y values for {x_len} x values, equally many are needed"
    )]
    LengthMismatch {
        /// Title of the chart.
        chart: String,
        /// Name of the series.
        series: String,
        /// Entries of x.
        x_len: usize,
        /// Entries of y.
        y_len: usize,
    },
    /// A picture too small to hold its axes, or absurdly large.
    #[error(
        "a chart of {width_px} x {height_px} pixels was asked for, 160 x 60 to 4000 x 4000 are possible"
    )]
    SizeOutOfRange {
        /// Width found.
        width_px: u32,
        /// Height found.
        height_px: u32,
    },
    /// An axis range that shows nothing.
    #[error("the {axis} axis of chart `{chart}` is set from {from} to {to}, {needed} are needed")]
    BadRange {
        /// Title of the chart.
        chart: String,
        /// `x` or `y`.
        axis: &'static str,
        /// Lower end found.
        from: f64,
        /// Upper end found.
        to: f64,
        /// What is legal, in words.
        needed: &'static str,
    },
    /// The drawing library failed.
    #[error("chart `{chart}` could not be drawn: {source}")]
    Draw {
        /// Title of the chart.
        chart: String,
        /// What the library says.
        source: std::io::Error,
    },
}
