//! The names above a table of text.

use std::borrow::Cow;

use super::cells::{Dialect, SPACES, split};
use super::table::Layout;
use crate::heading::Heading;

/// The four lines of a Campbell logger (TOA5): the logger, names, units, and how each was made.
pub(super) fn campbell(lines: &[&str]) -> Option<Layout> {
    let dialect = Dialect {
        separator: ',',
        decimal_comma: false,
    };
    let cells = |k: usize| split(lines.get(k)?, ',');
    if cells(0)?.first()? != "TOA5" {
        return None;
    }
    let (names, units) = (cells(1)?, cells(2)?);
    let headings = names.iter().enumerate();
    let headings = headings.map(|(k, name)| {
        // The stamp is in "TS", a running number in "RN": no units.
        let unit = units.get(k).map_or("", |unit| {
            if matches!(unit.as_ref(), "TS" | "RN") {
                ""
            } else {
                unit
            }
        });
        Heading::new(name, unit)
    });
    Some(Layout {
        dialect,
        undecided: false,
        header: Some(1),
        units: Some(2),
        first_row: 4,
        headings: headings.collect(),
    })
}

/// The names in a line, however they are separated, without the sign of a comment.
pub(super) fn names<'a>(line: &'a str, separator: char, width: usize) -> Option<Vec<Cow<'a, str>>> {
    let plain = line.trim_start();
    let plain = match plain.strip_prefix(['#', '%']) {
        Some(rest) => rest.trim_start_matches(['#', '%', ' ']),
        None => line,
    };
    if separator != SPACES {
        return fitted(split(plain, separator)?, width);
    }
    // Names hold spaces; so they may stand between two, or between commas.
    let wide = plain
        .split("  ")
        .map(str::trim)
        .filter(|cell| !cell.is_empty());
    let wide: Vec<Cow<'a, str>> = wide.map(Cow::Borrowed).collect();
    let others = ['\t', ',', ';']
        .into_iter()
        .filter_map(|other| split(plain, other));
    let all = std::iter::once(bracketed(plain))
        .chain([wide])
        .chain(others);
    all.into_iter().find(|cells| cells.len() == width)
}

/// Words between spaces, each with the unit in brackets that follows it.
fn bracketed(line: &str) -> Vec<Cow<'_, str>> {
    let mut cells: Vec<Cow<'_, str>> = Vec::new();
    for word in split(line, SPACES).unwrap_or_default() {
        match cells.last_mut() {
            Some(last) if word.starts_with(['[', '(']) && !last.ends_with([']', ')']) => {
                *last = Cow::Owned(format!("{last} {word}"));
            }
            _ => cells.push(word),
        }
    }
    cells
}

/// Names for so many columns, for a message.
pub(super) fn example(width: usize) -> String {
    let names = ["t [s]", "u [N]", "y [mm]"];
    let name = |k: usize| match (k, width) {
        (1, 2) => names[2].to_owned(),
        _ => names
            .get(k)
            .map_or_else(|| format!("c{} [V]", k + 1), |&name| name.to_owned()),
    };
    const SHOWN: usize = 8;
    let mut list = (0..width.min(SHOWN))
        .map(name)
        .collect::<Vec<_>>()
        .join(",");
    if width > SHOWN {
        list += ",...";
    }
    list
}

/// As many names as there are columns; a separator at the end of every row, or of the header
/// alone, makes no column.
fn fitted(mut cells: Vec<Cow<'_, str>>, width: usize) -> Option<Vec<Cow<'_, str>>> {
    let ends_empty = cells.len() > 1 && cells.last().is_some_and(|cell| cell.is_empty());
    if ends_empty {
        cells.pop();
    }
    (cells.len() == width || cells.len() + 1 == width).then_some(cells)
}
