//! Charts of y over x.

use super::canvas::draw_svg;
use super::plot::Plot;
use super::{ChartError, ChartSize, Series, axis};

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

    /// The picture.
    ///
    /// Points that the axes cannot show (not finite, not positive on a logarithmic axis) are
    /// skipped; a chart without any point says "no data".
    ///
    /// # Errors
    ///
    /// [`ChartError::LengthMismatch`], [`ChartError::SizeOutOfRange`], [`ChartError::BadRange`].
    ///
    /// # Examples
    ///
    /// ```
    /// use simgap_report::chart::{LineChart, Mark, Role, Scale, Series};
    /// let mut chart = LineChart::new("Tone", "frequency [Hz]", "amplitude [mm]").with(
    ///     Series::new("", Role::Measured, vec![1.0, 3.0, 5.0], vec![1.0, 0.11, 0.04]).with_mark(Mark::Stems),
    /// );
    /// chart.y_scale = Scale::Log;
    /// assert!(chart.to_svg()?.contains("frequency [Hz]"));
    /// # Ok::<(), simgap_report::chart::ChartError>(())
    /// ```
    pub fn to_svg(&self) -> Result<String, ChartError> {
        let size = self.size.check()?;
        for s in &self.series {
            if s.x.len() != s.y.len() {
                return Err(ChartError::LengthMismatch {
                    chart: self.title.clone(),
                    series: s.name.clone().into_owned(),
                    x_len: s.x.len(),
                    y_len: s.y.len(),
                });
            }
        }
        self.check_range("x", self.x_range, self.x_scale)?;
        self.check_range("y", self.y_range, self.y_scale)?;
        let plot = Plot::new(self);
        draw_svg(&self.title, size, |canvas| plot.draw(canvas))
    }

    fn check_range(
        &self,
        axis: &'static str,
        range: Option<[f64; 2]>,
        scale: Scale,
    ) -> Result<(), ChartError> {
        let Some([from, to]) = range else {
            return Ok(());
        };
        let log = scale == Scale::Log;
        if from < to
            && axis::shows(from, log)
            && axis::shows(to, log)
            && to - from > 1e-10 * from.abs().max(to.abs())
        {
            return Ok(());
        }
        Err(ChartError::BadRange {
            chart: self.title.clone(),
            axis,
            from,
            to,
            needed: if log {
                "two rising positive numbers"
            } else {
                "two rising finite numbers"
            },
        })
    }
}
