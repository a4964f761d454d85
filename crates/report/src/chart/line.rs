//! Charts of y over x.

use super::{ChartSize, Series};

/// Linear or logarithmic.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scale {
    /// Equal steps.
    Linear,
    /// Equal ratios; values that are not positive are skipped.
    Log,
}

/// A stretch of the abscissa, shaded behind the data and labelled above the frame.
#[derive(Debug, Clone, PartialEq)]
pub struct Span {
    /// Left end, in units of x.
    pub from: f64,
    /// Right end.
    pub to: f64,
    /// Short text above it; may be empty.
    pub label: String,
}

/// Series over a common abscissa with axes, grid and legend.
///
/// | Field | Meaning | Unit | Range |
/// |---|---|---|---|
/// | `title` | heading, and accessible name | | any text |
/// | `x_label`, `y_label` | what the axes show, with the unit in brackets | | any text |
/// | `x_range`, `y_range` | ends of the axis; from the data if `None` | of the axis | finite, from < to, positive if logarithmic |
/// | `size` | natural size | px | 160 x 60 to 4000 x 4000 |
#[derive(Debug, Clone, PartialEq)]
pub struct LineChart<'a> {
    /// Heading; drawn unless empty.
    pub title: String,
    /// Below the abscissa.
    pub x_label: String,
    /// Beside the ordinate.
    pub y_label: String,
    /// Drawn in this order, the last on top.
    pub series: Vec<Series<'a>>,
    /// Shaded stretches; where labels would collide, the earlier one in this list is shown.
    pub spans: Vec<Span>,
    /// Scale of the abscissa.
    pub x_scale: Scale,
    /// Scale of the ordinate.
    pub y_scale: Scale,
    /// Fixed ends of the abscissa.
    pub x_range: Option<[f64; 2]>,
    /// Fixed ends of the ordinate.
    pub y_range: Option<[f64; 2]>,
    /// Natural size of the picture.
    pub size: ChartSize,
}

impl<'a> LineChart<'a> {
    /// A chart of 720 x 300 pixels with linear axes and no series yet.
    #[must_use]
    pub fn new(
        title: impl Into<String>,
        x_label: impl Into<String>,
        y_label: impl Into<String>,
    ) -> Self {
        Self {
            title: title.into(),
            x_label: x_label.into(),
            y_label: y_label.into(),
            series: Vec::new(),
            spans: Vec::new(),
            x_scale: Scale::Linear,
            y_scale: Scale::Linear,
            x_range: None,
            y_range: None,
            size: ChartSize::new(720, 300),
        }
    }

    /// With one more series on top.
    #[must_use]
    pub fn with(mut self, series: Series<'a>) -> Self {
        self.series.push(series);
        self
    }
}
