//! A thin layer over the SVG backend of plotters.
//!
//! The backend places on whole pixels, fixes the size of the picture and knows no dashes. So the
//! canvas is ten times as large as the picture, which rounds coordinates to a tenth of a pixel;
//! the `viewBox` scales it back; and dashed lines are drawn with a marked opacity that is
//! rewritten to a dash pattern at the end.

use plotters::prelude::{
    DrawingBackend, FontDesc, FontFamily, FontStyle, FontTransform, RGBColor, SVGBackend,
    ShapeStyle, TextStyle,
};
use plotters::style::Color;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::palette::{INK, SOFT_INK, parse_rgb};
use super::{ChartError, ChartSize};

/// Canvas units per pixel.
const UNITS: f64 = 10.0;
/// The backend divides font sizes by this.
const BACKEND_FONT_DIVISOR: f64 = 1.24;
/// Width of a character over the font size, on the safe side for a sans-serif face.
const CHARACTER_WIDTH: f64 = 0.56;
/// Opacity that marks a dashed line until the end.
const DASH_MARK: f64 = 0.984_375;
/// Height of a row of the title, px.
const TITLE_ROW_PX: u32 = 20;
/// Dash and gap in canvas units.
const DASH_PATTERN: &str = "60 40";

/// Where the anchor of a text lies in it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Anchor {
    Start,
    Middle,
    End,
}

/// How a text is set.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Font {
    pub(crate) size_px: f64,
    pub(crate) bold: bool,
    pub(crate) colour: &'static str,
}

impl Font {
    pub(crate) const TICK: Font = Font {
        size_px: 12.0,
        bold: false,
        colour: SOFT_INK,
    };
    pub(crate) const LABEL: Font = Font {
        size_px: 13.0,
        bold: false,
        colour: INK,
    };
    pub(crate) const TITLE: Font = Font {
        size_px: 14.0,
        bold: true,
        colour: INK,
    };

    /// Estimated width of a text, px.
    pub(crate) fn width_px(self, text: &str) -> f64 {
        let factor = if self.bold { 1.08 } else { 1.0 };
        text.chars().count() as f64 * CHARACTER_WIDTH * self.size_px * factor
    }

    /// The text, cut with an ellipsis where it would be wider than `limit_px`.
    pub(crate) fn fit(self, text: &str, limit_px: f64) -> String {
        if self.width_px(text) <= limit_px {
            return text.to_owned();
        }
        let keep = (limit_px / self.width_px("x")).floor().max(2.0) as usize - 1;
        let kept: String = text.chars().take(keep).collect();
        format!("{}…", kept.trim_end())
    }
}

/// Marks of one colour.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Pen {
    pub(crate) rgb: RGBColor,
    /// Tenths of a pixel.
    pub(crate) width: u32,
    pub(crate) dashed: bool,
}

impl Pen {
    pub(crate) fn hair(colour: &str) -> Self {
        Self {
            rgb: parse_rgb(colour),
            width: 10,
            dashed: false,
        }
    }

    fn style(self) -> ShapeStyle {
        ShapeStyle {
            color: self.rgb.mix(if self.dashed { DASH_MARK } else { 1.0 }),
            filled: false,
            stroke_width: self.width,
        }
    }
}

/// Writing to memory does not fail, but the backend cannot say so.
pub(crate) type Drawn = Result<(), std::io::Error>;

fn failed(error: impl std::fmt::Display) -> std::io::Error {
    std::io::Error::other(error.to_string())
}

/// Takes pixels, passes tenths of pixels on to plotters.
pub(crate) struct Canvas<'a>(SVGBackend<'a>);

fn units(px: f64) -> i32 {
    // Twice the largest canvas keeps the sums of the backend inside an i32.
    (px * UNITS).round().clamp(-80_000.0, 80_000.0) as i32
}

fn point((x, y): (f64, f64)) -> (i32, i32) {
    (units(x), units(y))
}

impl Canvas<'_> {
    pub(crate) fn line(&mut self, from: (f64, f64), to: (f64, f64), pen: Pen) -> Drawn {
        self.0
            .draw_line(point(from), point(to), &pen.style())
            .map_err(failed)
    }

    pub(crate) fn path(&mut self, points: &[(f64, f64)], pen: Pen) -> Drawn {
        let mut path: Vec<(i32, i32)> = points.iter().copied().map(point).collect();
        path.dedup();
        if path.len() == 1 {
            // A single point shows as a dot.
            return self.dot(points[0], f64::from(pen.width) / UNITS, pen.rgb);
        }
        self.0.draw_path(path, &pen.style()).map_err(failed)
    }

    pub(crate) fn rect(&mut self, from: (f64, f64), to: (f64, f64), rgb: RGBColor) -> Drawn {
        let style = ShapeStyle::from(rgb.to_rgba()).filled();
        self.0
            .draw_rect(point(from), point(to), &style, true)
            .map_err(failed)
    }

    pub(crate) fn dot(&mut self, at: (f64, f64), radius_px: f64, rgb: RGBColor) -> Drawn {
        let style = ShapeStyle::from(rgb.to_rgba()).filled();
        self.0
            .draw_circle(point(at), units(radius_px).unsigned_abs(), &style, true)
            .map_err(failed)
    }

    /// Text whose vertical middle lies at `at`.
    pub(crate) fn text(&mut self, text: &str, at: (f64, f64), font: Font, anchor: Anchor) -> Drawn {
        self.set_text(text, at, font, anchor, FontTransform::None)
    }

    /// Text running upwards, centred at `at`.
    pub(crate) fn text_upwards(&mut self, text: &str, at: (f64, f64), font: Font) -> Drawn {
        self.set_text(text, at, font, Anchor::Middle, FontTransform::Rotate270)
    }

    fn set_text(
        &mut self,
        text: &str,
        at: (f64, f64),
        font: Font,
        anchor: Anchor,
        transform: FontTransform,
    ) -> Drawn {
        // Control characters are not legal in XML.
        let clean: String = text.chars().filter(|c| !c.is_control()).collect();
        let h_pos = match anchor {
            Anchor::Start => HPos::Left,
            Anchor::Middle => HPos::Center,
            Anchor::End => HPos::Right,
        };
        let face = if font.bold {
            FontStyle::Bold
        } else {
            FontStyle::Normal
        };
        let size = font.size_px * UNITS * BACKEND_FONT_DIVISOR;
        let desc = FontDesc::new(FontFamily::SansSerif, size, face).transform(transform);
        let rgb = parse_rgb(font.colour);
        let style = TextStyle::from(desc)
            .color(&rgb)
            .pos(Pos::new(h_pos, VPos::Center));
        self.0.draw_text(&clean, &style, point(at)).map_err(failed)
    }
}

/// A picture without a visible title as a file of its own: white behind it and its title, which is
/// also its accessible name, above it in as many rows as it needs.
pub(crate) fn standalone(svg: &str, title: &str, size: ChartSize) -> String {
    let rows = wrapped(title, f64::from(size.width_px) - 24.0);
    let above = 8 + TITLE_ROW_PX * rows.len() as u32;
    let (width, height) = (size.width_px, size.height_px + above);
    let name = crate::markup::escape(title);
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
         viewBox=\"0 0 {width} {height}\" role=\"img\">\n<title>{name}</title>\n\
         <rect width=\"{width}\" height=\"{height}\" fill=\"#FFFFFF\"/>\n"
    );
    for (i, row) in rows.iter().enumerate() {
        out.push_str(&format!(
            "<text x=\"12\" y=\"{}\" font-family=\"sans-serif\" font-size=\"14\" \
             font-weight=\"bold\" fill=\"{INK}\">{}</text>\n",
            TITLE_ROW_PX * (i as u32 + 1),
            crate::markup::escape(row)
        ));
    }
    let inner = svg.replacen("<svg ", &format!("<svg y=\"{above}\" "), 1);
    out.push_str(&inner);
    out.push_str("\n</svg>\n");
    out
}

/// The words of a title in rows of that width.
fn wrapped(title: &str, limit_px: f64) -> Vec<String> {
    let mut rows: Vec<String> = Vec::new();
    for word in title.split_whitespace() {
        let word = Font::TITLE.fit(word, limit_px);
        match rows.last_mut() {
            Some(row) if Font::TITLE.width_px(&format!("{row} {word}")) <= limit_px => {
                row.push(' ');
                row.push_str(&word);
            }
            _ => rows.push(word),
        }
    }
    rows
}

/// Runs `draw` on a canvas of `size` and returns the SVG. `title` is its accessible name.
pub(crate) fn draw_svg(
    title: &str,
    size: ChartSize,
    draw: impl FnOnce(&mut Canvas<'_>) -> Drawn,
) -> Result<String, ChartError> {
    let mut raw = String::new();
    let full = (size.width_px * UNITS as u32, size.height_px * UNITS as u32);
    {
        let mut canvas = Canvas(SVGBackend::with_string(&mut raw, full));
        draw(&mut canvas)
            .and_then(|()| canvas.0.present().map_err(failed))
            .map_err(|source| ChartError::Draw {
                chart: title.to_owned(),
                source,
            })?;
    }
    let body = raw.split_once('\n').map_or("", |(_, body)| body);
    let head = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{}\" height=\"{}\" viewBox=\"0 0 {} {}\" \
         role=\"img\" stroke-linejoin=\"round\" stroke-linecap=\"round\">\n<title>{}</title>\n",
        size.width_px,
        size.height_px,
        full.0,
        full.1,
        crate::markup::escape(title),
    );
    // The text of labels cannot match: quotes in it are escaped by the backend.
    let body = body
        .replace(
            &format!(" opacity=\"{DASH_MARK}\""),
            &format!(" stroke-linecap=\"butt\" stroke-dasharray=\"{DASH_PATTERN}\""),
        )
        .replace(" opacity=\"1\"", "")
        .replace("\n</text>", "</text>")
        .replace(" \"/>", "\"/>");
    Ok(head + &gathered_dots(&body))
}

/// Dots of one size and colour that follow one another as a single path of points with round ends:
/// a fifth of the text.
fn gathered_dots(body: &str) -> String {
    let mut out = String::with_capacity(body.len());
    let mut open: Option<(&str, &str)> = None;
    for line in body.lines() {
        let dot = attributes_of_dot(line);
        let look = dot.map(|(_, _, r, fill)| (r, fill));
        if open.is_some() && open != look {
            out.push_str("\"/>\n");
            open = None;
        }
        match dot {
            None => {
                out.push_str(line);
                out.push('\n');
            }
            Some((x, y, r, fill)) => {
                if open.is_none() {
                    let width = 2 * r.parse::<u32>().unwrap_or(0);
                    out.push_str(&format!(
                        "<path fill=\"none\" stroke=\"{fill}\" stroke-width=\"{width}\" d=\""
                    ));
                    open = look;
                }
                out.push_str(&format!("M{x} {y}h0"));
            }
        }
    }
    if open.is_some() {
        out.push_str("\"/>\n");
    }
    out.truncate(out.trim_end().len());
    out
}

/// Centre, radius and colour of a line that is a filled circle of the backend.
fn attributes_of_dot(line: &str) -> Option<(&str, &str, &str, &str)> {
    let circle = line.strip_prefix("<circle ")?;
    let value = |name: &str| {
        let (_, after) = circle.split_once(&format!("{name}=\""))?;
        after.split_once('"').map(|(value, _)| value)
    };
    Some((value("cx")?, value("cy")?, value("r")?, value("fill")?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verify_dots_of_one_look_become_one_path() {
        let body = "<circle cx=\"1\" cy=\"2\" r=\"3\" fill=\"#A\"/>\n\
                    <circle cx=\"4\" cy=\"5\" r=\"3\" fill=\"#A\"/>\n\
                    <circle cx=\"6\" cy=\"7\" r=\"3\" fill=\"#B\"/>\n<rect/>";
        let a = "<path fill=\"none\" stroke=\"#A\" stroke-width=\"6\" d=\"M1 2h0M4 5h0\"/>";
        let b = "<path fill=\"none\" stroke=\"#B\" stroke-width=\"6\" d=\"M6 7h0\"/>";
        assert_eq!(gathered_dots(body), format!("{a}\n{b}\n<rect/>"));
    }
}
