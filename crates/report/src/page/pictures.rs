//! The charts of a page, drawn from the check records.

use simgap_diagnose::{ChannelSeries, Diagnosis};
use simgap_signal::welch::{WelchOptions, welch};

use super::picture::{Picture, SIZE};
use super::stretch::{longest_finite_run, telling_stretch};
use crate::chart::{ChartError, LineChart, Mark, Role, Scale, Series, Span, SpectrumChart};
use crate::unit::{Prefixed, prefixed};
use crate::wording::corrected_name;

/// Points that the script may show of a record, and of any other line.
const RECORD_POINTS: usize = 6000;
const LINE_POINTS: usize = 1500;
/// Stretches of the time strip.
const STRETCHES: usize = 60;
/// A spectrum of fewer samples says nothing.
const FEWEST_SAMPLES: usize = 64;
/// Averages wanted before the resolution is raised.
const AVERAGES: usize = 4;
const LONGEST_SEGMENT: usize = 8192;
/// Bands shaded in a spectrum: the strongest, and none below this share.
const SHADED_BANDS: usize = 4;
const LEAST_BAND: f64 = 0.05;

/// One output of one check record, ready to be drawn.
pub(crate) struct Pictured<'a> {
    pub(crate) record: &'a str,
    pub(crate) time_s: &'a [f64],
    pub(crate) channel: &'a ChannelSeries,
    diagnosis: &'a Diagnosis,
    /// Whether a gain of its own brings the channel to the unit it is shown in.
    has_gain: bool,
    /// rms of the nominal discrepancy over the standard deviation of the measurement.
    pub(crate) nominal_gap: f64,
    /// First and one-past-last sample of the stretch where the nominal model is worst.
    worst: Option<(usize, usize)>,
}

/// Every channel of every check record, the worst predicted first.
pub(crate) fn pictured<'a>(input: &super::ReportInput<'a>) -> Vec<Pictured<'a>> {
    let (diagnosis, series) = (input.diagnosis, input.series);
    let outputs = input.nominal.map_or(&[][..], |model| &model.outputs);
    let gain = |channel: &str| {
        outputs
            .iter()
            .any(|o| o.channel == channel && o.gain.is_some())
    };
    let mut all: Vec<Pictured<'_>> = series
        .iter()
        .flat_map(|record| {
            record.channels.iter().map(|channel| Pictured {
                record: &record.record,
                time_s: &record.time_s,
                channel,
                diagnosis,
                has_gain: gain(&channel.channel),
                nominal_gap: relative_gap(&channel.measured, &channel.nominal),
                worst: telling_stretch(
                    &channel.measured,
                    &discrepancy(&channel.measured, &channel.nominal),
                ),
            })
        })
        .collect();
    // A stable sort: equals stay in the order of the records.
    all.sort_by(|a, b| b.nominal_gap.total_cmp(&a.nominal_gap));
    all
}

fn relative_gap(measured: &[f64], predicted: &[f64]) -> f64 {
    let pairs = || {
        let both = measured.iter().zip(predicted);
        both.filter(|(m, p)| m.is_finite() && p.is_finite())
    };
    let n = pairs().count().max(1) as f64;
    let mean = pairs().map(|(m, _)| m).sum::<f64>() / n;
    let spread = pairs().map(|(m, _)| (m - mean).powi(2)).sum::<f64>();
    let off = pairs().map(|(m, p)| (m - p).powi(2)).sum::<f64>();
    if off > 0.0 && spread > 0.0 {
        (off / spread).sqrt()
    } else {
        0.0
    }
}

/// Measured minus predicted, as long as the shorter.
fn discrepancy(measured: &[f64], predicted: &[f64]) -> Vec<f64> {
    measured.iter().zip(predicted).map(|(m, p)| m - p).collect()
}

/// Largest size of the finite values.
fn size_of(values: &[&[f64]]) -> f64 {
    values
        .iter()
        .flat_map(|v| v.iter())
        .filter(|v| v.is_finite())
        .fold(0.0, |m, v| m.max(v.abs()))
}

fn rms_of_finite(values: &[f64]) -> f64 {
    let finite = || values.iter().filter(|v| v.is_finite());
    let count = finite().count();
    if count == 0 {
        return f64::NAN;
    }
    (finite().map(|v| v * v).sum::<f64>() / count as f64).sqrt()
}

fn scaled<'x>(name: &str, role: Role, x: &'x [f64], y: &[f64], factor: f64) -> Series<'x> {
    let n = x.len().min(y.len());
    let y: Vec<f64> = y[..n].iter().map(|v| v * factor).collect();
    Series::new(name.to_owned(), role, &x[..n], y)
}

impl Pictured<'_> {
    /// "y in C.csv".
    pub(crate) fn name(&self) -> String {
        format!("{} in {}", self.channel.channel, self.record)
    }

    /// Where the nominal model is worst, s; `None` where the record is short anyway.
    pub(crate) fn worst_s(&self) -> Option<[f64; 2]> {
        let (from, to) = self.worst?;
        let (from, to) = (*self.time_s.get(from)?, *self.time_s.get(to - 1)?);
        (from < to && from.is_finite() && to.is_finite()).then_some([from, to])
    }

    /// Measured, nominal and corrected over the whole record, or over `zoom`.
    pub(crate) fn motion(
        &self,
        title: &str,
        zoom: Option<[f64; 2]>,
    ) -> Result<Picture, ChartError> {
        let c = self.channel;
        let Prefixed { unit, factor } = prefixed(c.unit, size_of(&[&c.measured]));
        // The samples around the stretch are enough for it.
        let shown = match (zoom, self.worst) {
            (Some(_), Some((from, to))) => from.saturating_sub(1)..(to + 1).min(self.time_s.len()),
            _ => 0..self.time_s.len(),
        };
        let t = &self.time_s[shown.clone()];
        let lines = [
            ("measured", Role::Measured, &c.measured),
            ("model as given", Role::Nominal, &c.nominal),
            (self.corrected_name(), Role::Corrected, &c.corrected),
        ];
        let times = if self.has_gain { " × gain" } else { "" };
        let y_label = format!("{}{times} [{unit}]", c.channel);
        let mut chart = LineChart::new(title, "time [s]", y_label);
        for (name, role, values) in lines {
            let values = &values[shown.clone()];
            chart.series.push(scaled(name, role, t, values, factor));
        }
        chart.size = SIZE;
        chart.x_range = zoom;
        let worst = self.worst_s();
        if zoom.is_some() {
            return Picture::lines("motion-worst", chart, None, None);
        }
        chart.spans.extend(worst.map(|[from, to]| Span {
            from,
            to,
            label: "worst stretch".to_owned(),
        }));
        Picture::lines("motion", chart, Some(RECORD_POINTS), worst)
    }

    /// What the model as given and the corrected one leave, over time.
    pub(crate) fn left_over(&self, title: &str) -> Result<Picture, ChartError> {
        let c = self.channel;
        let before = discrepancy(&c.measured, &c.nominal);
        let after = discrepancy(&c.measured, &c.corrected);
        let Prefixed { unit, factor } = prefixed(c.unit, size_of(&[&before, &after]));
        let t = self.time_s;
        let y_label = format!("measured − predicted [{unit}]");
        let mut chart = LineChart::new(title, "time [s]", y_label)
            .with(scaled("model as given", Role::Nominal, t, &before, factor))
            .with(scaled(
                self.corrected_name(),
                Role::Corrected,
                t,
                &after,
                factor,
            ));
        chart.size = SIZE;
        Picture::lines("discrepancy", chart, Some(LINE_POINTS), self.worst_s())
    }

    /// The rms of both in equal stretches of the record: where in time the gap lies.
    pub(crate) fn strip(&self, title: &str) -> Result<Option<Picture>, ChartError> {
        let c = self.channel;
        let n = self.time_s.len();
        if n < 2 * STRETCHES {
            return Ok(None);
        }
        let len = n.div_ceil(STRETCHES);
        let ends = || (0..n).step_by(len).chain([n - 1]);
        let times: Vec<f64> = ends().map(|i| self.time_s[i]).collect();
        let rms = |predicted: &[f64]| -> Vec<f64> {
            let off = discrepancy(&c.measured, predicted);
            let mut list: Vec<f64> = off.chunks(len).map(rms_of_finite).collect();
            list.extend(list.last().copied());
            list
        };
        let (before, after) = (rms(&c.nominal), rms(&c.corrected));
        let Prefixed { unit, factor } = prefixed(c.unit, size_of(&[&before, &after]));
        let y_label = format!("rms of the discrepancy [{unit}]");
        let name = self.corrected_name();
        let mut chart = LineChart::new(title, "time [s]", y_label)
            .with(scaled(
                "model as given",
                Role::Nominal,
                &times,
                &before,
                factor,
            ))
            .with(scaled(name, Role::Corrected, &times, &after, factor));
        for series in &mut chart.series {
            series.mark = Mark::Steps;
        }
        chart.size = SIZE;
        Picture::lines("time-strip", chart, None, None).map(Some)
    }

    fn corrected_name(&self) -> &'static str {
        corrected_name(self.diagnosis.verdict.status)
    }

    /// Power spectral density of both, with the strongest bands shaded; `None` if the record is
    /// too short or its time base unusable.
    pub(crate) fn spectrum(&self, title: &str) -> Result<Option<Picture>, ChartError> {
        let c = self.channel;
        let before = discrepancy(&c.measured, &c.nominal);
        let after = discrepancy(&c.measured, &c.corrected);
        let Prefixed { unit, factor } = prefixed(c.unit, size_of(&[&before]));
        let (Some(before), Some(after)) =
            (self.density(&before, factor), self.density(&after, factor))
        else {
            return Ok(None);
        };
        let (Some(&lowest), Some(&highest)) = (before.0.get(1), before.0.last()) else {
            return Ok(None);
        };
        let square = if unit.contains(['/', ' ']) {
            format!("({unit})²/Hz")
        } else {
            format!("{unit}²/Hz")
        };
        let corrected = self.corrected_name();
        let mut chart = SpectrumChart::new(title, format!("density [{square}]"))
            .with(Series::new(
                "model as given",
                Role::Nominal,
                before.0,
                before.1,
            ))
            .with(Series::new(corrected, Role::Corrected, after.0, after.1));
        chart.size = SIZE;
        chart.x_scale = Scale::Log;
        chart.freq_range_hz = (lowest < highest).then_some([lowest, highest]);
        chart.bands = self.bands();
        Picture::lines("spectrum", chart.lines(), Some(LINE_POINTS), None).map(Some)
    }

    /// Frequencies and densities of the longest gapless part.
    fn density(&self, values: &[f64], factor: f64) -> Option<(Vec<f64>, Vec<f64>)> {
        let n = values.len().min(self.time_s.len());
        let (from, to) = longest_finite_run(&values[..n]);
        if to - from < FEWEST_SAMPLES {
            return None;
        }
        let rate_hz = (to - from - 1) as f64 / (self.time_s[to - 1] - self.time_s[from]);
        let run: Vec<f64> = values[from..to].iter().map(|v| v * factor).collect();
        let segment =
            ((2 * run.len() / (AVERAGES + 1)).max(FEWEST_SAMPLES) + 1).next_power_of_two() / 2;
        let options = WelchOptions::new(segment.clamp(FEWEST_SAMPLES, LONGEST_SEGMENT));
        let psd = welch(&run, rate_hz, &options).ok()?;
        Some((psd.freq_hz, psd.density))
    }

    /// The strongest first, since their labels have precedence.
    pub(crate) fn bands(&self) -> Vec<Span> {
        let strongest = crate::bands::told(&self.diagnosis.r#where.bands).into_iter();
        strongest
            .filter(|b| b.share >= LEAST_BAND && !b.is_spread())
            .take(SHADED_BANDS)
            .map(|b| Span {
                from: b.from_hz,
                to: b.to_hz,
                label: b.label,
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verify_the_discrepancy_is_measured_minus_predicted() {
        assert_eq!(discrepancy(&[3.0, 1.0], &[1.0, 1.5]), [2.0, -0.5]);
    }

    #[test]
    fn verify_the_gap_is_relative_to_the_spread() {
        // Spread about the mean 1 is 1, the prediction is off by 0.5 everywhere.
        let gap = relative_gap(&[0.0, 2.0, f64::NAN], &[0.5, 1.5, 0.0]);
        assert!((gap - 0.5).abs() < 1e-15, "{gap}");
        assert_eq!(relative_gap(&[1.0, 1.0], &[0.0, 0.0]), 0.0);
    }
}
