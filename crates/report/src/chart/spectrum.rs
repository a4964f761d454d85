//! Densities or amplitudes over frequency, with named bands.

use super::{ChartError, ChartSize, LineChart, Scale, Series, Span};

/// Spectra on a logarithmic ordinate, with labelled bands behind them.
#[derive(Debug, Clone, PartialEq)]
pub struct SpectrumChart<'a> {
    /// Heading.
    pub title: String,
    /// Beside the ordinate, with the unit in brackets.
    pub y_label: String,
    /// Spectra over frequency in Hz.
    pub series: Vec<Series<'a>>,
    /// Named bands, Hz.
    pub bands: Vec<Span>,
    /// Scale of the frequency axis; a logarithmic one leaves 0 Hz out.
    pub x_scale: Scale,
    /// Shown frequencies, Hz.
    pub freq_range_hz: Option<[f64; 2]>,
    /// Natural size of the picture.
    pub size: ChartSize,
}

impl<'a> SpectrumChart<'a> {
    /// A chart of 720 x 300 pixels over a linear frequency axis.
    #[must_use]
    pub fn new(title: impl Into<String>, y_label: impl Into<String>) -> Self {
        Self {
            title: title.into(),
            y_label: y_label.into(),
            series: Vec::new(),
            bands: Vec::new(),
            x_scale: Scale::Linear,
            freq_range_hz: None,
            size: ChartSize::new(720, 300),
        }
    }

    /// With one more spectrum on top.
    #[must_use]
    pub fn with(mut self, series: Series<'a>) -> Self {
        self.series.push(series);
        self
    }

    /// The picture.
    ///
    /// # Errors
    ///
    /// As [`LineChart::to_svg`].
    ///
    /// # Examples
    ///
    /// ```
    /// use simgap_report::chart::{Role, Series, Span, SpectrumChart};
    /// let mut chart = SpectrumChart::new("Discrepancy", "density [m²/Hz]")
    ///     .with(Series::from_points("nominal", Role::Nominal, &[(1.0, 1e-9), (2.0, 1e-7), (3.0, 1e-10)]));
    /// chart.bands.push(Span { from: 1.5, to: 2.5, label: "first mode".into() });
    /// assert!(chart.to_svg()?.contains("first mode"));
    /// # Ok::<(), simgap_report::chart::ChartError>(())
    /// ```
    pub fn to_svg(&self) -> Result<String, ChartError> {
        self.lines().to_svg()
    }

    /// The same as a line chart.
    pub(crate) fn lines(&self) -> LineChart<'a> {
        let mut chart = LineChart::new(self.title.clone(), "frequency [Hz]", self.y_label.clone());
        chart.series.clone_from(&self.series);
        chart.spans.clone_from(&self.bands);
        chart.x_scale = self.x_scale;
        chart.y_scale = Scale::Log;
        chart.x_range = self.freq_range_hz;
        chart.size = self.size;
        chart
    }
}
