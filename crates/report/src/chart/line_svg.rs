//! A line chart as a picture.

use super::canvas::draw_svg;
use super::plot::Plot;
use super::{ChartError, LineChart, Scale, axis};

impl LineChart<'_> {
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
