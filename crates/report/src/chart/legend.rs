//! The legend: rows above the plot, so that it never lies on data.

use super::canvas::{Anchor, Canvas, Drawn, Font, Pen};
use super::{Mark, Series};

const KEY_PX: f64 = 26.0;
const GAP_PX: f64 = 18.0;
/// Height of a row.
pub(crate) const ROW_PX: f64 = 19.0;

/// Position of each entry: row, and distance from the left.
pub(crate) struct Legend<'a> {
    entries: Vec<(&'a Series<'a>, usize, f64)>,
    pub(crate) rows: usize,
    width_px: f64,
}

impl<'a> Legend<'a> {
    /// Wraps the named series into rows of `width_px`.
    pub(crate) fn new(series: &'a [Series<'a>], width_px: f64) -> Self {
        let mut entries = Vec::new();
        let (mut row, mut x) = (0, 0.0);
        for one in series.iter().filter(|s| !s.name.is_empty()) {
            let needed = KEY_PX + Font::LABEL.width_px(&one.name).min(width_px - KEY_PX);
            if x > 0.0 && x + needed > width_px {
                row += 1;
                x = 0.0;
            }
            entries.push((one, row, x));
            x += needed + GAP_PX;
        }
        let rows = if entries.is_empty() { 0 } else { row + 1 };
        Self {
            entries,
            rows,
            width_px,
        }
    }

    pub(crate) fn draw(&self, canvas: &mut Canvas<'_>, left: f64, top: f64) -> Drawn {
        for (series, row, x) in &self.entries {
            let (x, y) = (left + x, top + (*row as f64 + 0.5) * ROW_PX);
            let rgb = series.role.rgb();
            match series.mark {
                Mark::Points => canvas.dot((x + 0.5 * KEY_PX - 4.0, y), 3.0, rgb)?,
                _ => {
                    let pen = Pen {
                        rgb,
                        width: series.role.line_width().max(20),
                        dashed: series.dashed,
                    };
                    canvas.line((x, y), (x + KEY_PX - 8.0, y), pen)?;
                }
            }
            let name = Font::LABEL.fit(&series.name, self.width_px - KEY_PX);
            canvas.text(&name, (x + KEY_PX, y), Font::LABEL, Anchor::Start)?;
        }
        Ok(())
    }
}
