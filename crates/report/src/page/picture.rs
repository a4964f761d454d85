//! One picture: drawn in the page, written beside it as a drawing and as data.

use crate::chart::{
    BarChart, ChartError, ChartSize, LineChart, bars_csv, lines_csv, live_json, standalone,
};
use crate::markup::{Html, escape};

/// Two of them stand side by side on a wide page, and each still reads on a narrow one.
pub(crate) const SIZE: ChartSize = ChartSize::new(460, 280);

/// A picture as files of its own.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PictureFile {
    /// Name without extension, of small letters, digits and hyphens, such as `motion`.
    pub name: String,
    /// The drawing.
    pub svg: String,
    /// Its data as comma-separated values, one header row.
    pub csv: String,
}

/// A picture with its title and what a reader must know about it.
pub(super) struct Picture {
    slug: &'static str,
    title: String,
    note: String,
    /// The note is about the script, and not for paper.
    hint: bool,
    svg: String,
    size: ChartSize,
    csv: String,
    live: Option<String>,
    wide: bool,
}

impl Picture {
    /// A line chart. Its title stands in the page above it. `budget` is the number of points the
    /// script may show; none leaves the drawing as it is.
    pub(super) fn lines(
        slug: &'static str,
        mut chart: LineChart<'_>,
        budget: Option<usize>,
        home: Option<[f64; 2]>,
    ) -> Result<Self, ChartError> {
        let title = std::mem::take(&mut chart.title);
        Ok(Self {
            slug,
            svg: named(&chart.to_svg()?, &title),
            size: chart.size,
            csv: lines_csv(&chart),
            live: budget.and_then(|budget| live_json(&chart, budget, home)),
            title,
            note: String::new(),
            hint: false,
            wide: false,
        })
    }

    /// A bar chart.
    pub(super) fn bars(slug: &'static str, mut chart: BarChart) -> Result<Self, ChartError> {
        chart.width_px = SIZE.width_px;
        let title = std::mem::take(&mut chart.title);
        Ok(Self {
            slug,
            svg: named(&chart.to_svg()?, &title),
            size: chart.size(),
            csv: bars_csv(&chart),
            live: None,
            title,
            note: String::new(),
            hint: false,
            wide: false,
        })
    }

    /// With words below it.
    pub(super) fn with_note(mut self, note: impl Into<String>) -> Self {
        self.note = note.into();
        self
    }

    /// With words below it on how to use it on a screen.
    pub(super) fn with_hint(mut self, hint: impl Into<String>) -> Self {
        self.hint = true;
        self.with_note(hint)
    }

    /// Over the whole width where the script draws it.
    pub(super) fn wide(mut self) -> Self {
        self.wide = true;
        self
    }

    /// Puts it into the page, and its files to the others.
    pub(super) fn show(self, html: &mut Html, files: &mut Vec<PictureFile>) {
        let attributes: &[(&str, &str)] = if self.wide { &[("class", "wide")] } else { &[] };
        html.within("figure", attributes, |html| {
            html.element("figcaption", &[], &self.title);
            html.raw(&self.svg);
            if let Some(live) = &self.live {
                html.raw("<script type=\"application/json\">");
                html.raw(live);
                html.raw("</script>\n");
            }
            if !self.note.is_empty() {
                let class = if self.hint { "note tools" } else { "note" };
                html.element("p", &[("class", class)], &self.note);
            }
        });
        files.push(PictureFile {
            name: free_name(self.slug, files),
            svg: standalone(&self.svg, &self.title, self.size),
            csv: self.csv,
        });
    }
}

/// The slug, with a number from the second of its kind on.
fn free_name(slug: &str, files: &[PictureFile]) -> String {
    let same = |file: &&PictureFile| {
        let rest = file.name.strip_prefix(slug);
        rest.is_some_and(|rest| {
            let digits = rest.strip_prefix('-').unwrap_or(rest);
            digits.chars().all(|c| c.is_ascii_digit())
        })
    };
    match files.iter().filter(same).count() {
        0 => slug.to_owned(),
        n => format!("{slug}-{}", n + 1),
    }
}

/// A drawing without a visible title, given an accessible name.
fn named(svg: &str, title: &str) -> String {
    let name = format!("<title>{}</title>", escape(title));
    svg.replacen("<title></title>", &name, 1)
}
