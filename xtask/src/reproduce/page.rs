//! A page of the reproduction: one source for Markdown, text and JSON.

use std::fmt::Write as _;

use serde_json::{Map, Value, json};
use simgap_report::chart::LineChart;

use super::ReproduceError;
use super::number::{round_to, significant};

/// Said on every page.
pub(crate) const REBUILT: &str = "The measured data of the paper is lost. Only its tables and text \
remain; every record used here is rebuilt from them, not measured.";

/// What became of a published number or claim.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// To the digits printed.
    Reproduced,
    /// Within the tolerance stated beside it.
    WithinTolerance,
    /// Does not follow from what is printed; the note says why.
    NotReproducible,
}

impl Verdict {
    /// In words.
    #[must_use]
    pub fn text(self) -> &'static str {
        match self {
            Self::Reproduced => "reproduced",
            Self::WithinTolerance => "within tolerance",
            Self::NotReproducible => "not reproducible",
        }
    }
}

/// A published number beside ours.
#[derive(Debug, Clone, PartialEq)]
pub struct Comparison {
    /// What is compared.
    pub item: String,
    /// Unit.
    pub unit: &'static str,
    /// As printed in the paper.
    pub printed: String,
    /// Value of it.
    pub published: f64,
    /// Ours.
    pub ours: f64,
    /// What a difference may be to count as "within tolerance".
    pub tolerance: f64,
}

/// Half a unit of the last digit of a printed number.
pub(crate) fn print_resolution(printed: &str) -> f64 {
    let decimals = printed
        .split_once('.')
        .map_or(0, |(_, decimals)| decimals.len());
    0.5 * 10_f64.powi(-i32::try_from(decimals).unwrap_or(0))
}

impl Comparison {
    /// Ours less published.
    #[must_use]
    pub fn difference(&self) -> f64 {
        self.ours - self.published
    }

    /// Half a unit of the last digit printed.
    #[must_use]
    pub fn print_resolution(&self) -> f64 {
        print_resolution(&self.printed)
    }

    /// Reproduced to the digits printed, within the tolerance, or not.
    #[must_use]
    pub fn verdict(&self) -> Verdict {
        let off = self.difference().abs();
        if off <= self.print_resolution() {
            Verdict::Reproduced
        } else if off <= self.tolerance {
            Verdict::WithinTolerance
        } else {
            Verdict::NotReproducible
        }
    }
}

/// A cell of a table.
#[derive(Debug, Clone, PartialEq)]
pub enum Cell {
    /// Words.
    Text(String),
    /// A number and its significant digits.
    Number(f64, usize),
}

impl Cell {
    /// Words.
    pub fn text(text: impl Into<String>) -> Self {
        Self::Text(text.into())
    }

    fn shown(&self) -> String {
        match self {
            Self::Text(text) => text.clone(),
            Self::Number(value, digits) => significant(*value, *digits),
        }
    }

    fn json(&self) -> Value {
        match self {
            Self::Text(text) => json!(text),
            Self::Number(value, digits) => json!(round_to(*value, *digits)),
        }
    }
}

/// A table with a caption.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    /// Caption.
    pub title: String,
    /// Column heads, with units.
    pub columns: Vec<String>,
    /// Rows.
    pub rows: Vec<Vec<Cell>>,
}

impl Table {
    /// A table without rows.
    #[must_use]
    pub fn new(title: &str, columns: &[&str]) -> Self {
        let columns = columns.iter().map(|column| (*column).to_owned()).collect();
        Self {
            title: title.to_owned(),
            columns,
            rows: vec![],
        }
    }

    /// Published, ours, difference, tolerance, verdict.
    #[must_use]
    pub fn comparisons(title: &str, comparisons: &[Comparison]) -> Self {
        let mut table = Self::new(
            title,
            &[
                "item",
                "unit",
                "published",
                "ours",
                "difference",
                "tolerance",
                "verdict",
            ],
        );
        for row in comparisons {
            // A difference below the printed digits is shown as 0: it would be rounding.
            let difference = row.difference();
            let shown = if difference.abs() < 1e-7 * row.published.abs() {
                0.0
            } else {
                difference
            };
            table.rows.push(vec![
                Cell::text(&row.item),
                Cell::text(row.unit),
                Cell::text(&row.printed),
                Cell::Number(row.ours, 8),
                Cell::Number(shown, 3),
                Cell::Number(row.tolerance, 3),
                Cell::text(row.verdict().text()),
            ]);
        }
        table
    }

    fn json(&self) -> Value {
        let rows: Vec<Value> = self
            .rows
            .iter()
            .map(|row| {
                let cells = self.columns.iter().cloned().zip(row.iter().map(Cell::json));
                Value::Object(cells.collect::<Map<String, Value>>())
            })
            .collect();
        json!({ "title": self.title, "rows": rows })
    }

    fn markdown(&self) -> String {
        let mut text = format!("**{}**\n\n| {} |\n", self.title, self.columns.join(" | "));
        text.push_str(&format!("|{}\n", "---|".repeat(self.columns.len())));
        for row in &self.rows {
            let cells: Vec<String> = row
                .iter()
                .map(|cell| cell.shown().replace('|', "\\|"))
                .collect();
            text.push_str(&format!("| {} |\n", cells.join(" | ")));
        }
        text
    }

    fn plain(&self) -> String {
        let shown: Vec<Vec<String>> = self
            .rows
            .iter()
            .map(|row| row.iter().map(Cell::shown).collect())
            .collect();
        let width = |column: usize| {
            let rows = shown.iter().map(|row| row[column].chars().count());
            rows.chain([self.columns[column].chars().count()])
                .max()
                .unwrap_or(0)
        };
        let widths: Vec<usize> = (0..self.columns.len()).map(width).collect();
        let line = |cells: &[String]| {
            let mut text = String::new();
            for (cell, width) in cells.iter().zip(&widths) {
                let _ = write!(text, "{cell:<width$}  ");
            }
            format!("{}\n", text.trim_end())
        };
        let mut text = format!("{}\n{}", self.title, line(&self.columns));
        shown.iter().for_each(|row| text.push_str(&line(row)));
        text
    }
}

/// A part of a page.
#[derive(Debug, Clone, PartialEq)]
pub enum Block {
    /// A paragraph.
    Text(String),
    /// A table.
    Table(Table),
    /// A picture: file stem, caption, chart.
    Figure(&'static str, String, LineChart<'static>),
}

/// A page.
#[derive(Debug, Clone, PartialEq)]
pub struct Page {
    /// File stem.
    pub stem: &'static str,
    /// Title.
    pub title: String,
    /// One line for the index.
    pub summary: String,
    /// Content in order.
    pub blocks: Vec<Block>,
}

impl Page {
    /// The files of the page: path from the root of the workspace, and text.
    ///
    /// # Errors
    /// [`ReproduceError::Json`] and [`ReproduceError::Chart`].
    pub fn files(&self) -> Result<Vec<(String, String)>, ReproduceError> {
        let stem = self.stem;
        let json =
            serde_json::to_string_pretty(&self.json()).map_err(|source| ReproduceError::Json {
                page: stem.to_owned(),
                source,
            })?;
        let mut files = vec![
            (format!("docs/reproduction/{stem}.md"), self.markdown()),
            (format!("fixtures/reproduction/{stem}.txt"), self.plain()),
            (
                format!("fixtures/reproduction/{stem}.json"),
                format!("{json}\n"),
            ),
        ];
        for block in &self.blocks {
            if let Block::Figure(name, _, chart) = block {
                files.push((format!("docs/reproduction/{name}.svg"), chart.to_svg()?));
            }
        }
        Ok(files)
    }

    /// Tables and statements as JSON.
    #[must_use]
    pub fn json(&self) -> Value {
        let tables: Vec<Value> = self
            .blocks
            .iter()
            .filter_map(|block| match block {
                Block::Table(table) => Some(table.json()),
                _ => None,
            })
            .collect();
        let statements: Vec<&str> = self
            .blocks
            .iter()
            .filter_map(|block| match block {
                Block::Text(text) => Some(text.as_str()),
                Block::Figure(_, caption, _) => Some(caption.as_str()),
                Block::Table(_) => None,
            })
            .collect();
        json!({
            "schema": "simgap-reproduction/1",
            "page": self.stem,
            "title": self.title,
            "data": REBUILT,
            "tables": tables,
            "statements": statements,
        })
    }

    fn markdown(&self) -> String {
        let mut text = format!(
            "<!-- Generated by `cargo xtask reproduce-paper`; do not edit. -->\n\n# {}\n\n> {REBUILT}\n",
            self.title
        );
        for block in &self.blocks {
            text.push('\n');
            match block {
                Block::Text(paragraph) => text.push_str(&format!("{paragraph}\n")),
                Block::Table(table) => text.push_str(&table.markdown()),
                Block::Figure(name, caption, _) => {
                    text.push_str(&format!("![{caption}]({name}.svg)\n\n*{caption}*\n"));
                }
            }
        }
        text
    }

    fn plain(&self) -> String {
        let mut text = format!("{}\n{REBUILT}\n", self.title);
        for block in &self.blocks {
            match block {
                Block::Text(paragraph) => text.push_str(&format!("\n{paragraph}\n")),
                Block::Table(table) => text.push_str(&format!("\n{}", table.plain())),
                Block::Figure(name, caption, _) => {
                    text.push_str(&format!("\nPicture {name}.svg: {caption}\n"));
                }
            }
        }
        text
    }
}

/// The index of the pages.
pub(crate) fn index(pages: &[Page]) -> String {
    let mut text = format!(
        "<!-- Generated by `cargo xtask reproduce-paper`; do not edit. -->\n\n\
         # The paper, reproduced\n\n> {REBUILT}\n\n\
         Y. H. Park, *Dynamic analysis of multi-body dynamics model of mold oscillator including \
         self-excitation of supporting system* (`park-mold`). `cargo xtask reproduce-paper` writes \
         these pages and the same tables as text and JSON in `fixtures/reproduction/`; with `--check` \
         it compares them byte for byte with what is committed. The published numbers are in \
         `crates/tables/fixtures/` and no tool writes them.\n\n\
         A published number is *reproduced* when ours agrees to the digits printed, *within \
         tolerance* when it agrees within the tolerance stated beside it and explained on the page, \
         and *not reproducible* when it does not follow from what is printed.\n\n\
         | page | what it holds |\n|---|---|\n"
    );
    for page in pages {
        text.push_str(&format!(
            "| [{}]({}.md) | {} |\n",
            page.title, page.stem, page.summary
        ));
    }
    text
}
