//! A campaign as a table: plain text for a terminal, Markdown for `docs/`.

use std::fmt::Write;

use crate::Totals;

/// How a table is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Style {
    /// Columns padded with blanks.
    Text,
    /// Markdown.
    Markdown,
}

/// The figures, the calibration and the table of kinds.
///
/// ```
/// use simgap_blind::{Style, Totals, render};
/// let text = render(&Totals::of(&[]), Style::Markdown);
/// assert!(text.contains("| cases | 0 |"));
/// ```
#[must_use]
pub fn render(totals: &Totals, style: Style) -> String {
    let tables = [figures(totals), calibration(totals), kinds(totals)];
    let written: Vec<String> = tables.iter().map(|rows| write_table(rows, style)).collect();
    written.join("\n")
}

/// Rows of cells; the first is the header.
fn write_table(rows: &[Vec<String>], style: Style) -> String {
    let columns = rows.first().map_or(0, Vec::len);
    let width = |c: usize| {
        let cells = rows.iter().filter_map(|row| row.get(c));
        cells.map(|cell| cell.chars().count()).max().unwrap_or(0)
    };
    let widths: Vec<usize> = (0..columns).map(width).collect();
    let mut text = String::new();
    for (r, row) in rows.iter().enumerate() {
        let line = match style {
            Style::Text => {
                let padded = row
                    .iter()
                    .zip(&widths)
                    .map(|(cell, &w)| format!("{cell:<w$}"));
                padded.collect::<Vec<_>>().join("  ").trim_end().to_string()
            }
            Style::Markdown => format!("| {} |", row.join(" | ")),
        };
        text.push_str(&line);
        text.push('\n');
        if r == 0 && style == Style::Markdown {
            // Writing to a string does not fail.
            let _ = writeln!(text, "|{}", "---|".repeat(columns));
        }
    }
    text
}

fn row(cells: &[&str]) -> Vec<String> {
    cells.iter().map(|cell| (*cell).to_string()).collect()
}

fn percent(share: f64) -> String {
    if share.is_nan() {
        "-".to_string()
    } else {
        format!("{:.0} %", 100.0 * share)
    }
}

fn number(value: f64) -> String {
    if value.is_nan() {
        "-".to_string()
    } else {
        format!("{value:.3}")
    }
}

fn figures(t: &Totals) -> Vec<Vec<String>> {
    let lines: [(&str, String); 18] = [
        ("cases", t.cases.to_string()),
        ("whole answer right", percent(t.right)),
        ("effects of the catalogue", t.effects.to_string()),
        ("  kind and place right", percent(t.placed)),
        ("  kind right", percent(t.named)),
        ("  among the indistinguishable", percent(t.among_rivals)),
        ("  something else named", percent(t.wrong)),
        ("  missed", percent(t.missed)),
        ("  called unknown", percent(t.called_unknown)),
        ("mean probability on the truth", number(t.truth_probability)),
        ("cases of noise alone", t.quiet_cases.to_string()),
        ("  false alarms", percent(t.false_alarms)),
        ("foreign effects", t.foreign_cases.to_string()),
        ("  called unknown", percent(t.honest_unknown)),
        ("cases with an effect too many", percent(t.extra)),
        ("Brier score of stated probabilities", number(t.brier)),
        ("mean length of indistinguishable", number(t.rivals)),
        ("statements", {
            let counts = t.calibration.iter().map(|bin| bin.count);
            counts.sum::<usize>().to_string()
        }),
    ];
    let mut rows = vec![row(&["figure", "value"])];
    rows.extend(lines.map(|(name, value)| vec![name.to_string(), value]));
    rows
}

fn calibration(t: &Totals) -> Vec<Vec<String>> {
    let mut rows = vec![row(&["stated probability", "statements", "mean", "right"])];
    rows.extend(t.calibration.iter().map(|bin| {
        vec![
            format!("{} to {}", bin.from, bin.to),
            bin.count.to_string(),
            number(bin.stated),
            percent(bin.right),
        ]
    }));
    rows
}

fn kinds(t: &Totals) -> Vec<Vec<String>> {
    let mut rows = vec![row(&[
        "truth",
        "effects",
        "right",
        "outcomes",
        "said instead",
    ])];
    for (kind, of_kind) in &t.kinds {
        let count: usize = of_kind.outcomes.values().sum();
        let right: usize = of_kind
            .outcomes
            .iter()
            .filter(|(outcome, _)| outcome.is_right())
            .map(|(_, n)| n)
            .sum();
        let outcomes = of_kind.outcomes.iter();
        let outcomes: Vec<String> = outcomes
            .map(|(outcome, n)| format!("{} {n}", outcome.label()))
            .collect();
        let said = of_kind.said.iter();
        let said: Vec<String> = said.map(|(kind, n)| format!("{kind} {n}")).collect();
        rows.push(vec![
            kind.clone(),
            count.to_string(),
            right.to_string(),
            outcomes.join(", "),
            said.join(", "),
        ]);
    }
    rows
}
