//! A line chart laid out and drawn.

use super::axis::{self, Axis};
use super::canvas::{Anchor, Canvas, Drawn, Font, Pen};
use super::decimate::{thin, thin_points};
use super::legend::{Legend, ROW_PX};
use super::palette::{FRAME, GRID, SHADE, parse_rgb};
use super::{LineChart, Mark, Scale, Series};

/// Rows that the labels of spans may fill above the frame.
const SPAN_ROWS: usize = 2;
const SPAN_ROW_PX: f64 = 15.0;

/// The chart laid out: axes fitted to data, the frame placed.
pub(super) struct Plot<'c> {
    chart: &'c LineChart<'c>,
    legend: Legend<'c>,
    x: Axis,
    y: Axis,
    left: f64,
    right: f64,
    top: f64,
    bottom: f64,
}

impl<'c> Plot<'c> {
    pub(super) fn new(chart: &'c LineChart<'c>) -> Self {
        let (width, height) = (
            f64::from(chart.size.width_px),
            f64::from(chart.size.height_px),
        );
        let legend = Legend::new(&chart.series, width - 24.0);
        let title_px = if chart.title.is_empty() { 4.0 } else { 26.0 };
        let labelled = chart.spans.iter().filter(|s| !s.label.is_empty()).count();
        let span_rows = labelled.min(SPAN_ROWS);
        let above = 8.0 + span_rows as f64 * SPAN_ROW_PX;
        let top = title_px + legend.rows as f64 * ROW_PX + above;
        let bottom = (height - if chart.x_label.is_empty() { 26.0 } else { 46.0 }).max(top + 10.0);
        let y = chart.fit_y(((bottom - top) / 42.0) as usize);
        let widest = y
            .ticks
            .iter()
            .map(|t| Font::TICK.width_px(&t.1))
            .fold(0.0, f64::max);
        let label_px = if chart.y_label.is_empty() { 4.0 } else { 24.0 };
        let left = (label_px + widest + 10.0).min(0.5 * width);
        let right = width - 16.0;
        let x = chart.fit_x(((right - left) / 70.0) as usize);
        Self {
            chart,
            legend,
            x,
            y,
            left,
            right,
            top,
            bottom,
        }
    }

    fn at_x(&self, position: f64) -> f64 {
        self.left + position * (self.right - self.left)
    }

    fn at_y(&self, position: f64) -> f64 {
        self.bottom - position * (self.bottom - self.top)
    }

    pub(super) fn draw(&self, canvas: &mut Canvas<'_>) -> Drawn {
        let title = Font::TITLE.fit(
            &self.chart.title,
            f64::from(self.chart.size.width_px) - 20.0,
        );
        if !title.is_empty() {
            canvas.text(&title, (12.0, 15.0), Font::TITLE, Anchor::Start)?;
        }
        let legend_top = if title.is_empty() { 4.0 } else { 26.0 };
        self.legend.draw(canvas, 12.0, legend_top)?;
        self.draw_spans(canvas)?;
        self.draw_grid(canvas)?;
        let drawn = self
            .chart
            .series
            .iter()
            .try_fold(0, |n, s| self.draw_series(canvas, s).map(|k| n + k))?;
        if drawn == 0 {
            let centre = (
                0.5 * (self.left + self.right),
                0.5 * (self.top + self.bottom),
            );
            canvas.text("no data", centre, Font::LABEL, Anchor::Middle)?;
        }
        let (l, r, t, b) = (self.left, self.right, self.top, self.bottom);
        canvas.path(&[(l, t), (r, t), (r, b), (l, b), (l, t)], Pen::hair(FRAME))?;
        self.draw_labels(canvas)
    }

    fn draw_grid(&self, canvas: &mut Canvas<'_>) -> Drawn {
        let pen = Pen::hair(GRID);
        let x_lines = self.x.minor.iter().chain(self.x.ticks.iter().map(|t| &t.0));
        for x in x_lines.map(|p| self.at_x(*p)) {
            canvas.line((x, self.top), (x, self.bottom), pen)?;
        }
        for y in self.y.ticks.iter().map(|t| self.at_y(t.0)) {
            canvas.line((self.left, y), (self.right, y), pen)?;
        }
        Ok(())
    }

    fn draw_spans(&self, canvas: &mut Canvas<'_>) -> Drawn {
        let log = self.chart.x_scale == Scale::Log;
        let mut taken: [Vec<(f64, f64)>; SPAN_ROWS] = Default::default();
        for span in &self.chart.spans {
            if span.from.is_nan() || span.to.is_nan() || (log && span.to <= 0.0) {
                continue;
            }
            let inside = |v: f64| self.at_x(self.x.position(v)).clamp(self.left, self.right);
            let (from, to) = (
                inside(span.from.max(if log { 1e-150 } else { span.from })),
                inside(span.to),
            );
            if to <= self.left || from >= self.right || to < from {
                continue;
            }
            // A narrow band still shows.
            let to = to.max(from + 2.0).min(self.right);
            canvas.rect((from, self.top), (to, self.bottom), parse_rgb(SHADE))?;
            let half = 0.5 * Font::TICK.width_px(&span.label);
            let centre = (0.5 * (from + to))
                .clamp(self.left + half, (self.right - half).max(self.left + half));
            if span.label.is_empty() {
                continue;
            }
            // A label that would run into those already set is left out.
            let free = |row: &Vec<(f64, f64)>| {
                row.iter()
                    .all(|(a, b)| centre + half < *a || centre - half > *b)
            };
            if let Some(row) = taken.iter().position(free) {
                let y = self.top - 8.0 - row as f64 * SPAN_ROW_PX;
                canvas.text(&span.label, (centre, y), Font::TICK, Anchor::Middle)?;
                taken[row].push((centre - half - 6.0, centre + half + 6.0));
            }
        }
        Ok(())
    }

    fn draw_labels(&self, canvas: &mut Canvas<'_>) -> Drawn {
        for (position, label) in &self.x.ticks {
            let half = 0.5 * Font::TICK.width_px(label);
            let x = self.at_x(*position).min(self.right + 14.0 - half);
            canvas.text(label, (x, self.bottom + 12.0), Font::TICK, Anchor::Middle)?;
        }
        for (position, label) in &self.y.ticks {
            canvas.text(
                label,
                (self.left - 6.0, self.at_y(*position)),
                Font::TICK,
                Anchor::End,
            )?;
        }
        let x_label = self.x.name(&self.chart.x_label);
        if !x_label.is_empty() {
            let fitted = Font::LABEL.fit(&x_label, self.right - self.left);
            let at = (0.5 * (self.left + self.right), self.bottom + 32.0);
            canvas.text(&fitted, at, Font::LABEL, Anchor::Middle)?;
        }
        let y_label = self.y.name(&self.chart.y_label);
        if !y_label.is_empty() {
            let fitted = Font::LABEL.fit(&y_label, self.bottom - self.top + 20.0);
            let at = (13.0, 0.5 * (self.top + self.bottom));
            canvas.text_upwards(&fitted, at, Font::LABEL)?;
        }
        Ok(())
    }

    /// Draws one series and returns how many points it had to show.
    fn draw_series(
        &self,
        canvas: &mut Canvas<'_>,
        series: &Series<'_>,
    ) -> Result<usize, std::io::Error> {
        let pieces = self.pieces(series);
        let pen = Pen {
            rgb: series.role.rgb(),
            width: series.role.line_width(),
            dashed: series.dashed,
        };
        for piece in &pieces {
            match series.mark {
                Mark::Line => canvas.path(&thin(piece), pen)?,
                Mark::Steps => canvas.path(&thin(&stairs(piece)), pen)?,
                Mark::Points => {
                    for p in thin_points(piece).into_iter().filter(|p| self.holds(*p)) {
                        canvas.dot(p, 2.2, pen.rgb)?;
                    }
                }
                Mark::Stems => {
                    for p in thin_points(piece).into_iter().filter(|p| self.holds(*p)) {
                        canvas.line((p.0, self.foot()), p, pen)?;
                        canvas.dot(p, 3.0, pen.rgb)?;
                    }
                }
            }
        }
        Ok(pieces.iter().map(Vec::len).sum())
    }

    /// Where stems stand: at zero if the axis shows it, else at the bottom.
    fn foot(&self) -> f64 {
        if self.chart.y_scale == Scale::Log {
            return self.bottom;
        }
        self.at_y(self.y.position(0.0)).clamp(self.top, self.bottom)
    }

    fn holds(&self, (x, y): (f64, f64)) -> bool {
        (self.left - 0.5..=self.right + 0.5).contains(&x)
            && (self.top - 0.5..=self.bottom + 0.5).contains(&y)
    }

    /// The series in pixels, cut where it has no point to show or leaves the frame sideways; above
    /// and below it is held at the edge of the frame.
    fn pieces(&self, series: &Series<'_>) -> Vec<Vec<(f64, f64)>> {
        let x_log = self.chart.x_scale == Scale::Log;
        let y_log = self.chart.y_scale == Scale::Log;
        let clamp = matches!(series.mark, Mark::Line | Mark::Steps);
        let mut pieces = vec![Vec::new()];
        for (&x, &y) in series.x.iter().zip(series.y.iter()) {
            let shown = axis::shows(x, x_log) && axis::shows(y, y_log);
            let px = if shown {
                self.at_x(self.x.position(x))
            } else {
                f64::NAN
            };
            if (self.left - 0.5..=self.right + 0.5).contains(&px) {
                let py = self.at_y(self.y.position(y));
                let py = if clamp {
                    py.clamp(self.top, self.bottom)
                } else {
                    py
                };
                if let Some(piece) = pieces.last_mut() {
                    piece.push((px, py));
                }
            } else if pieces.last().is_some_and(|p| !p.is_empty()) {
                pieces.push(Vec::new());
            }
        }
        pieces.retain(|p| !p.is_empty());
        pieces
    }
}

impl LineChart<'_> {
    fn fit_x(&self, tick_count: usize) -> Axis {
        let log = self.x_scale == Scale::Log;
        let values = self.series.iter().flat_map(|s| s.x.iter().copied());
        match self.x_range {
            Some(range) => Axis::exactly(range, log, tick_count.clamp(2, 10)),
            None => Axis::around(
                axis::extent(values, log),
                log,
                false,
                tick_count.clamp(2, 10),
            ),
        }
    }

    fn stems(&self) -> bool {
        self.series.iter().any(|s| s.mark == Mark::Stems)
    }

    /// Fits the ordinate to the points whose abscissa is shown.
    fn fit_y(&self, tick_count: usize) -> Axis {
        let log = self.y_scale == Scale::Log;
        let tick_count = tick_count.clamp(2, 8);
        if let Some(range) = self.y_range {
            return Axis::exactly(range, log, tick_count);
        }
        let [from, to] = self.x_range.unwrap_or([f64::NEG_INFINITY, f64::INFINITY]);
        let points = self.series.iter().flat_map(|s| s.x.iter().zip(s.y.iter()));
        let values = points
            .filter(|(x, _)| (from..=to).contains(*x))
            .map(|(_, y)| *y);
        let values = values.chain((self.stems() && !log).then_some(0.0));
        Axis::around(axis::extent(values, log), log, true, tick_count)
    }
}

fn stairs(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let mut out = Vec::with_capacity(2 * points.len());
    for pair in points.windows(2) {
        out.push(pair[0]);
        out.push((pair[1].0, pair[0].1));
    }
    out.extend(points.last());
    out
}
