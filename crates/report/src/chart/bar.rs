//! Labelled horizontal bars.

use super::axis::Axis;
use super::canvas::{Anchor, Canvas, Drawn, Font, Pen, draw_svg};
use super::palette::{FRAME, GRID, INK, SHADE, parse_rgb};
use super::{ChartError, ChartSize, Role};

const ROW_PX: f64 = 24.0;
/// Height of a row whose label stands above its bar.
const STACKED_ROW_PX: f64 = 40.0;
/// Labels wider than this share of the picture stand above their bars.
const WIDEST_BESIDE: f64 = 0.4;
const BAR_PX: f64 = 14.0;
const TITLE_PX: f64 = 30.0;
/// Room for the numbers and the name of the abscissa.
const AXIS_PX: f64 = 42.0;

/// One bar.
#[derive(Debug, Clone, PartialEq)]
pub struct Bar {
    /// Text on its left.
    pub label: String,
    /// Its length.
    pub value: f64,
    /// A value marked on it by a tick, such as what would be expected by chance.
    pub mark: Option<f64>,
    /// Where it ended in the step before: the stretch from its end up to there is drawn hollow.
    pub before: Option<f64>,
    /// Text after its end; the value in per cent if empty.
    pub text: String,
    /// Decides its colour.
    pub role: Role,
}

impl Bar {
    /// A bar for a share between 0 and 1, printed in per cent.
    #[must_use]
    pub fn share(label: impl Into<String>, value: f64, role: Role) -> Self {
        Self {
            label: label.into(),
            value,
            mark: None,
            before: None,
            text: String::new(),
            role,
        }
    }
}

/// Horizontal bars under one another, each with its label and its value.
///
/// The height follows from the number of bars.
#[derive(Debug, Clone, PartialEq)]
pub struct BarChart {
    /// Heading; drawn unless empty.
    pub title: String,
    /// From top to bottom.
    pub bars: Vec<Bar>,
    /// Value of a full-width bar; the largest value if `None`.
    pub full: Option<f64>,
    /// What the length of a bar is, with the unit in brackets; no abscissa is drawn if empty.
    pub axis_label: String,
    /// Whether values are shares, written in per cent along the abscissa.
    pub percent: bool,
    /// A value marked by a dashed line across all bars.
    pub limit: Option<f64>,
    /// Width of the picture, px.
    pub width_px: u32,
}

/// The frame of the bars, px.
struct Frame {
    left: f64,
    right: f64,
    full: f64,
}

impl Frame {
    fn at(&self, value: f64) -> f64 {
        self.left + (value / self.full).clamp(0.0, 1.0) * (self.right - self.left)
    }
}

impl BarChart {
    /// A chart of shares: a full-width bar is 1.
    #[must_use]
    pub fn shares(title: impl Into<String>, bars: Vec<Bar>) -> Self {
        Self {
            title: title.into(),
            bars,
            full: Some(1.0),
            axis_label: String::new(),
            percent: true,
            limit: None,
            width_px: 460,
        }
    }

    /// The picture. A value that is not finite is printed as a dash and has no bar; a negative one
    /// has no length.
    ///
    /// # Errors
    ///
    /// [`ChartError::SizeOutOfRange`] for a width below 160 or so many bars that the picture would
    /// be higher than 4000 pixels, [`ChartError::BadRange`] for a full value that is not positive.
    ///
    /// # Examples
    ///
    /// ```
    /// use simgap_report::chart::{Bar, BarChart, Role};
    /// let bars = vec![Bar::share("y1", 0.75, Role::Nominal), Bar::share("y2", 0.25, Role::Nominal)];
    /// assert!(BarChart::shares("Channels", bars).to_svg()?.contains("75\u{a0}%"));
    /// # Ok::<(), simgap_report::chart::ChartError>(())
    /// ```
    pub fn to_svg(&self) -> Result<String, ChartError> {
        let size = self.size().check()?;
        let largest = self.bars.iter().map(|b| b.value).filter(|v| v.is_finite());
        let full = self
            .full
            .unwrap_or_else(|| match largest.fold(0.0, f64::max) {
                m if m > 0.0 => m,
                _ => 1.0,
            });
        if !(full.is_finite() && full > 0.0) {
            return Err(ChartError::BadRange {
                chart: self.title.clone(),
                axis: "x",
                from: 0.0,
                to: full,
                needed: "two rising finite numbers",
            });
        }
        draw_svg(&self.title, size, |canvas| self.draw(canvas, full))
    }

    /// Natural size of the picture.
    pub(crate) fn size(&self) -> ChartSize {
        let rows = self.bars.len().max(1) as f64;
        let axis_px = if self.axis_label.is_empty() {
            6.0
        } else {
            AXIS_PX
        };
        let height = self.top() + rows * self.row_px() + axis_px;
        ChartSize::new(self.width_px, height.max(60.0) as u32)
    }

    fn label_px(&self) -> f64 {
        let widths = self.bars.iter().map(|b| Font::LABEL.width_px(&b.label));
        widths.fold(0.0, f64::max)
    }

    fn stacked(&self) -> bool {
        self.label_px() > WIDEST_BESIDE * f64::from(self.width_px)
    }

    fn row_px(&self) -> f64 {
        if self.stacked() {
            STACKED_ROW_PX
        } else {
            ROW_PX
        }
    }

    fn top(&self) -> f64 {
        if self.title.is_empty() { 4.0 } else { TITLE_PX }
    }

    fn draw(&self, canvas: &mut Canvas<'_>, full: f64) -> Drawn {
        let width = f64::from(self.width_px);
        if !self.title.is_empty() {
            let title = Font::TITLE.fit(&self.title, width - 16.0);
            canvas.text(&title, (8.0, 15.0), Font::TITLE, Anchor::Start)?;
        }
        if self.bars.is_empty() {
            let at = (8.0, self.top() + 0.5 * ROW_PX);
            return canvas.text("nothing to show", at, Font::LABEL, Anchor::Start);
        }
        let values = self
            .bars
            .iter()
            .map(|b| Font::TICK.width_px(&b.value_text()));
        let value_px = values.fold(0.0, f64::max).min(0.3 * width);
        let stacked = self.stacked();
        let row_px = self.row_px();
        let left = if stacked {
            10.0
        } else {
            16.0 + self.label_px()
        };
        let right = width - value_px - 14.0;
        let frame = Frame { left, right, full };
        let foot = self.top() + self.bars.len() as f64 * row_px;
        self.draw_axis(canvas, &frame, foot)?;
        for (i, bar) in self.bars.iter().enumerate() {
            let row = self.top() + i as f64 * row_px;
            let y = if stacked {
                let label = Font::LABEL.fit(&bar.label, width - 20.0);
                canvas.text(&label, (left, row + 10.0), Font::LABEL, Anchor::Start)?;
                row + 27.0
            } else {
                let y = row + 0.5 * row_px;
                canvas.text(&bar.label, (left - 8.0, y), Font::LABEL, Anchor::End)?;
                y
            };
            let text = Font::TICK.fit(&bar.value_text(), value_px + 1.0);
            canvas.text(&text, (right + 6.0, y), Font::TICK, Anchor::Start)?;
            bar.draw(canvas, &frame, y)?;
        }
        if let Some(limit) = self.limit.filter(|v| v.is_finite()) {
            let pen = Pen {
                dashed: true,
                width: 14,
                ..Pen::hair(INK)
            };
            let x = frame.at(limit);
            canvas.line((x, self.top()), (x, foot), pen)?;
        }
        if stacked {
            return Ok(());
        }
        canvas.line((left, self.top()), (left, foot), Pen::hair(FRAME))
    }

    /// Numbers along the abscissa and what they are.
    fn draw_axis(&self, canvas: &mut Canvas<'_>, frame: &Frame, foot: f64) -> Drawn {
        if self.axis_label.is_empty() {
            return Ok(());
        }
        let scale = if self.percent { 100.0 } else { 1.0 };
        let count = ((frame.right - frame.left) / 60.0) as usize;
        let axis = Axis::exactly([0.0, frame.full * scale], false, count.clamp(2, 8));
        let name = axis.name(&self.axis_label);
        for (position, label) in &axis.ticks {
            let x = frame.left + position * (frame.right - frame.left);
            // Not through the labels.
            let from = if self.stacked() {
                foot - 5.0
            } else {
                self.top()
            };
            canvas.line((x, from), (x, foot), Pen::hair(GRID))?;
            canvas.text(label, (x, foot + 10.0), Font::TICK, Anchor::Middle)?;
        }
        let width = f64::from(self.width_px);
        let half = 0.5 * Font::LABEL.width_px(&name).min(width - 8.0);
        let middle = (0.5 * (frame.left + frame.right)).min(width - half - 4.0);
        let text = Font::LABEL.fit(&name, width - 8.0);
        canvas.text(
            &text,
            (middle.max(half + 4.0), foot + 29.0),
            Font::LABEL,
            Anchor::Middle,
        )
    }
}

impl Bar {
    fn draw(&self, canvas: &mut Canvas<'_>, frame: &Frame, y: f64) -> Drawn {
        let (top, bottom) = (y - 0.5 * BAR_PX, y + 0.5 * BAR_PX);
        let shade = parse_rgb(SHADE);
        canvas.rect((frame.left, top), (frame.right, bottom), shade)?;
        if self.value.is_finite() && self.value > 0.0 {
            let end = frame.at(self.value).max(frame.left + 1.0);
            canvas.rect((frame.left, top), (end, bottom), self.role.rgb())?;
        }
        if let Some(before) = self.before.filter(|b| b.is_finite() && *b > self.value) {
            let (from, to) = (frame.at(self.value.max(0.0)), frame.at(before));
            let pen = Pen {
                rgb: self.role.rgb(),
                width: 12,
                dashed: false,
            };
            let corners = [(from, top), (to, top), (to, bottom), (from, bottom)];
            canvas.path(&corners, pen)?;
            canvas.line((from, bottom), (from, top), pen)?;
        }
        if let Some(mark) = self.mark.filter(|m| m.is_finite()) {
            let mut pen = Pen::hair(INK);
            pen.width = 20;
            let x = frame.at(mark);
            canvas.line((x, y - 8.0), (x, y + 8.0), pen)?;
        }
        Ok(())
    }

    fn value_text(&self) -> String {
        if !self.text.is_empty() {
            self.text.clone()
        } else {
            crate::number::percent(self.value)
        }
    }
}
