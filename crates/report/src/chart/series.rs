//! One series of a chart.

use std::borrow::Cow;

use super::Role;

/// How the points of a series are shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mark {
    /// Joined by a line, broken at points that are not finite.
    Line,
    /// A dot each.
    Points,
    /// Held until the next point.
    Steps,
    /// A vertical line from the foot of the chart with a dot on top: a line spectrum.
    Stems,
}

/// A named list of points with the role that colours it.
#[derive(Debug, Clone, PartialEq)]
pub struct Series<'a> {
    /// Text of the legend; a series with an empty name has no entry.
    pub name: Cow<'a, str>,
    /// What it stands for.
    pub role: Role,
    /// Abscissae.
    pub x: Cow<'a, [f64]>,
    /// Ordinates, as many. Points that are not finite are skipped.
    pub y: Cow<'a, [f64]>,
    /// How it is shown.
    pub mark: Mark,
    /// Dashes instead of a full line.
    pub dashed: bool,
}

impl<'a> Series<'a> {
    /// A full line through the points (x, y); takes slices or vectors.
    #[must_use]
    pub fn new(
        name: impl Into<Cow<'a, str>>,
        role: Role,
        x: impl Into<Cow<'a, [f64]>>,
        y: impl Into<Cow<'a, [f64]>>,
    ) -> Self {
        Self {
            name: name.into(),
            role,
            x: x.into(),
            y: y.into(),
            mark: Mark::Line,
            dashed: false,
        }
    }

    /// The same from pairs.
    #[must_use]
    pub fn from_points(name: impl Into<Cow<'a, str>>, role: Role, points: &[(f64, f64)]) -> Self {
        let (x, y): (Vec<f64>, Vec<f64>) = points.iter().copied().unzip();
        Self::new(name, role, x, y)
    }

    /// Shown as `mark`.
    #[must_use]
    pub fn with_mark(mut self, mark: Mark) -> Self {
        self.mark = mark;
        self
    }

    /// Shown dashed.
    #[must_use]
    pub fn dashed(mut self) -> Self {
        self.dashed = true;
        self
    }
}
