//! Cells of a line, and what they hold.

use std::borrow::Cow;

use super::stamp::{RawStamp, parse_stamp};

/// The separator that is any run of spaces and tabs.
pub(crate) const SPACES: char = ' ';

/// How cells are separated and numbers written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Dialect {
    pub(crate) separator: char,
    pub(crate) decimal_comma: bool,
}

impl Dialect {
    /// The separator in words.
    pub(crate) fn separated_by(self) -> &'static str {
        match self.separator {
            ';' => "semicolons",
            '\t' => "tabs",
            SPACES => "spaces",
            _ => "commas",
        }
    }
}

/// What a cell holds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Cell {
    Number(f64),
    Stamp(RawStamp),
    Missing,
    Text,
}

/// The cells of a line, trimmed; those in quotation marks without them. `None` when a quotation
/// mark is left open.
pub(crate) fn split(line: &str, separator: char) -> Option<Vec<Cow<'_, str>>> {
    if separator == SPACES {
        return spaced(line);
    }
    if !line.contains('"') {
        let cells = line.split(separator);
        return Some(cells.map(|cell| Cow::Borrowed(cell.trim())).collect());
    }
    let mut cells = Vec::new();
    let mut rest = line;
    loop {
        let start = rest.trim_start_matches([' ', '\u{a0}']);
        let Some(inner) = start.strip_prefix('"') else {
            match rest.split_once(separator) {
                Some((cell, tail)) => {
                    cells.push(Cow::Borrowed(cell.trim()));
                    rest = tail;
                    continue;
                }
                None => {
                    cells.push(Cow::Borrowed(rest.trim()));
                    return Some(cells);
                }
            }
        };
        let (cell, tail) = quoted(inner)?;
        cells.push(Cow::Owned(cell.trim().to_owned()));
        let tail = tail.trim_start_matches([' ', '\u{a0}']);
        match tail.strip_prefix(separator) {
            Some(tail) => rest = tail,
            None if tail.trim().is_empty() => return Some(cells),
            None => return None,
        }
    }
}

/// Cells between spaces; those in quotation marks may hold some.
fn spaced(line: &str) -> Option<Vec<Cow<'_, str>>> {
    if !line.contains('"') {
        return Some(line.split_whitespace().map(Cow::Borrowed).collect());
    }
    let mut cells = Vec::new();
    let mut rest = line.trim();
    while !rest.is_empty() {
        if let Some(inner) = rest.strip_prefix('"') {
            let (cell, tail) = quoted(inner)?;
            cells.push(Cow::Owned(cell.trim().to_owned()));
            rest = tail.trim_start();
            continue;
        }
        let (cell, tail) = rest.split_once(char::is_whitespace).unwrap_or((rest, ""));
        cells.push(Cow::Borrowed(cell));
        rest = tail.trim_start();
    }
    Some(cells)
}

/// The text up to the closing quotation mark, doubled ones made single, and what follows it.
fn quoted(text: &str) -> Option<(String, &str)> {
    let mut cell = String::new();
    let mut rest = text;
    loop {
        let (part, tail) = rest.split_once('"')?;
        cell += part;
        match tail.strip_prefix('"') {
            Some(tail) => {
                cell.push('"');
                rest = tail;
            }
            None => return Some((cell, tail)),
        }
    }
}

/// Words that stand where there is no number.
pub(crate) fn is_missing(cell: &str) -> bool {
    const WORDS: [&str; 17] = [
        "", "nan", "-nan", "1.#qnan", "-1.#ind", "na", "n/a", "#n/a", "#na", "null", "none", "-",
        "--", "---", "#value!", "#div/0!", "missing",
    ];
    cell.len() <= 8 && WORDS.iter().any(|word| cell.eq_ignore_ascii_case(word))
}

/// The number in a cell. With a decimal comma a point is a fault: it would be one for thousands.
pub(crate) fn number(cell: &str, decimal_comma: bool) -> Option<f64> {
    let starts = cell.trim_start_matches(['+', '-']);
    if !starts.starts_with(|c: char| c.is_ascii_digit() || c == '.' || c == ',') {
        // Not the words that a double understands.
        return None;
    }
    let value: f64 = if decimal_comma {
        if cell.contains('.') {
            return None;
        }
        if cell.contains(',') {
            cell.replacen(',', ".", 1).parse().ok()?
        } else {
            cell.parse().ok()?
        }
    } else {
        cell.parse().ok()?
    };
    value.is_finite().then_some(value)
}

/// What a cell holds.
pub(crate) fn classify(cell: &str, decimal_comma: bool) -> Cell {
    if let Some(value) = number(cell, decimal_comma) {
        return Cell::Number(value);
    }
    if is_missing(cell) {
        return Cell::Missing;
    }
    parse_stamp(cell).map_or(Cell::Text, Cell::Stamp)
}
