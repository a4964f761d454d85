//! Labelled horizontal bars.

use super::canvas::{Anchor, Canvas, Drawn, Font, Pen, draw_svg};
use super::palette::{FRAME, INK, SHADE, parse_rgb};
use super::{ChartError, ChartSize, Role};

const ROW_PX: f64 = 24.0;
const BAR_PX: f64 = 14.0;
const TITLE_PX: f64 = 30.0;

/// One bar.
#[derive(Debug, Clone, PartialEq)]
pub struct Bar {
    /// Text on its left.
    pub label: String,
    /// Its length.
    pub value: f64,
    /// A value marked on it by a tick, such as what would be expected by chance.
    pub mark: Option<f64>,
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
    /// Width of the picture, px.
    pub width_px: u32,
}

impl BarChart {
    /// A chart of shares: a full-width bar is 1.
    #[must_use]
    pub fn shares(title: impl Into<String>, bars: Vec<Bar>) -> Self {
        Self {
            title: title.into(),
            bars,
            full: Some(1.0),
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
        let rows = self.bars.len().max(1) as f64;
        let height = self.top() + rows * ROW_PX + 6.0;
        let size = ChartSize::new(self.width_px, (height.max(60.0)) as u32).check()?;
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
        let widest = |texts: &mut dyn Iterator<Item = f64>| texts.fold(0.0, f64::max);
        let label_px =
            widest(&mut self.bars.iter().map(|b| Font::LABEL.width_px(&b.label))).min(0.52 * width);
        let value_px = widest(
            &mut self
                .bars
                .iter()
                .map(|b| Font::TICK.width_px(&b.value_text())),
        )
        .min(0.3 * width);
        let left = 8.0 + label_px + 8.0;
        let right = width - value_px - 14.0;
        for (i, bar) in self.bars.iter().enumerate() {
            let y = self.top() + (i as f64 + 0.5) * ROW_PX;
            let label = Font::LABEL.fit(&bar.label, label_px + 1.0);
            canvas.text(&label, (left - 8.0, y), Font::LABEL, Anchor::End)?;
            canvas.rect(
                (left, y - 0.5 * BAR_PX),
                (right, y + 0.5 * BAR_PX),
                parse_rgb(SHADE),
            )?;
            let at = |v: f64| left + (v / full).clamp(0.0, 1.0) * (right - left);
            if bar.value.is_finite() && bar.value > 0.0 {
                let end = at(bar.value).max(left + 1.0);
                canvas.rect(
                    (left, y - 0.5 * BAR_PX),
                    (end, y + 0.5 * BAR_PX),
                    bar.role.rgb(),
                )?;
            }
            if let Some(mark) = bar.mark.filter(|m| m.is_finite()) {
                let mut pen = Pen::hair(INK);
                pen.width = 20;
                canvas.line((at(mark), y - 9.0), (at(mark), y + 9.0), pen)?;
            }
            let text = Font::TICK.fit(&bar.value_text(), value_px + 1.0);
            canvas.text(&text, (right + 6.0, y), Font::TICK, Anchor::Start)?;
        }
        let foot = self.top() + self.bars.len() as f64 * ROW_PX;
        canvas.line((left, self.top()), (left, foot), Pen::hair(FRAME))
    }
}

impl Bar {
    fn value_text(&self) -> String {
        if !self.text.is_empty() {
            self.text.clone()
        } else {
            crate::number::percent(self.value)
        }
    }
}
