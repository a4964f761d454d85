//! Where in a table of text the header, the units and the numbers stand.

use std::borrow::Cow;

use super::cells::{Cell, Dialect, SPACES, classify, split};
use super::names::{campbell, example, names};
use super::table::Layout;
use crate::error::RecordError;
use crate::faults::TextFault;
use crate::heading::{Heading, heading, is_unit};
use crate::words::shortened;

/// Lines that are looked at.
const LOOKED_AT: usize = 2000;
/// So many rows of one shape begin a table, or as many as there are.
const LIKE_ROWS: usize = 3;

/// Dialects in the order in which they win a tie.
const DIALECTS: [Dialect; 8] = [
    Dialect {
        separator: ';',
        decimal_comma: false,
    },
    Dialect {
        separator: '\t',
        decimal_comma: false,
    },
    Dialect {
        separator: ',',
        decimal_comma: false,
    },
    Dialect {
        separator: ';',
        decimal_comma: true,
    },
    Dialect {
        separator: '\t',
        decimal_comma: true,
    },
    // Only in quotation marks.
    Dialect {
        separator: ',',
        decimal_comma: true,
    },
    Dialect {
        separator: SPACES,
        decimal_comma: false,
    },
    Dialect {
        separator: SPACES,
        decimal_comma: true,
    },
];

/// What is known of a layout before it is guessed.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Known<'a> {
    /// Separator and decimal sign, of a sheet of a workbook.
    pub(crate) dialect: Option<Dialect>,
    /// Names and units in place of a header.
    pub(crate) columns: &'a [Heading],
}

/// Guesses the layout from the first lines of a file.
pub(crate) fn guess<'a>(
    file: &str,
    lines: impl Iterator<Item = &'a str>,
    known: Known<'_>,
) -> Result<Layout, RecordError> {
    let lines: Vec<&str> = lines.take(LOOKED_AT).collect();
    if let Some(layout) = campbell(&lines) {
        return Ok(layout);
    }
    let mut best: Option<(f64, Block)> = None;
    let dialects = DIALECTS
        .into_iter()
        .filter(|dialect| known.dialect.is_none_or(|k| k == *dialect));
    for dialect in dialects {
        if let Some(block) = block(&lines, dialect)
            && best.as_ref().is_none_or(|(score, _)| block.score > *score)
        {
            best = Some((block.score, block));
        }
    }
    let Some((_, block)) = best else {
        return Err(no_table(file, &lines));
    };
    let undecided = known.dialect.is_none()
        && DIALECTS.iter().any(|&other| {
            let Dialect {
                separator,
                decimal_comma,
            } = block.dialect;
            other
                == Dialect {
                    separator,
                    decimal_comma: !decimal_comma,
                }
                && separator != ','
                && self::block(&lines, other).is_some_and(|tie| tie.score == block.score)
        });
    if !known.columns.is_empty() {
        return given(file, &block, undecided, known.columns);
    }
    headed(file, &lines, &block, undecided)
}

/// The layout under names that were given.
fn given(
    file: &str,
    block: &Block,
    undecided: bool,
    columns: &[Heading],
) -> Result<Layout, RecordError> {
    if columns.len() != block.width {
        return Err(RecordError::Text {
            file: file.to_owned(),
            fault: TextFault::ColumnCount {
                line: block.start as u64 + 1,
                found: columns.len(),
                needed: block.width,
            },
        });
    }
    Ok(Layout {
        dialect: block.dialect,
        undecided,
        header: None,
        units: None,
        first_row: block.start,
        headings: columns.to_vec(),
    })
}

fn no_table(file: &str, lines: &[&str]) -> RecordError {
    match lines.iter().find(|line| !line.trim().is_empty()) {
        None => RecordError::Empty {
            file: file.to_owned(),
        },
        Some(first) => RecordError::Text {
            file: file.to_owned(),
            fault: TextFault::NoTable {
                looked_at: lines.len(),
                first: shortened(first.trim()),
            },
        },
    }
}

/// Rows of numbers of one width.
struct Block {
    dialect: Dialect,
    /// Line of the first row.
    start: usize,
    width: usize,
    score: f64,
}

/// Width, and how many cells hold numbers or stamps; `None` if this is no row of a table.
fn shape(line: &str, dialect: Dialect) -> Option<(usize, usize)> {
    if line.trim().is_empty() {
        return None;
    }
    let cells = split(line, dialect.separator)?;
    let quoted = line.contains('"');
    let mut numbers = 0;
    for cell in &cells {
        match classify(
            cell,
            dialect.decimal_comma && (dialect.separator != ',' || quoted),
        ) {
            Cell::Number(_) | Cell::Stamp(_) => numbers += 1,
            Cell::Missing | Cell::Text => {}
        }
    }
    let first = classify(cells.first()?, dialect.decimal_comma);
    let starts = matches!(first, Cell::Number(_) | Cell::Stamp(_));
    let spaced = dialect.separator == SPACES;
    (cells.len() >= 2 && (numbers >= 2 || (starts && !spaced && numbers == 1 && cells.len() == 2)))
        .then_some((cells.len(), numbers))
}

/// A run of rows of one width, without other lines than blank ones.
struct Run {
    start: usize,
    width: usize,
    rows: usize,
    /// Whether it goes on to the last line that is looked at.
    last: bool,
    /// Share of the cells that hold numbers, summed over the rows.
    share: f64,
}

fn runs(lines: &[&str], dialect: Dialect) -> Vec<Run> {
    let mut runs: Vec<Run> = Vec::new();
    let mut open = false;
    for (k, line) in lines.iter().enumerate() {
        if line.trim().is_empty() {
            continue;
        }
        let Some((width, numbers)) = shape(line, dialect) else {
            open = false;
            continue;
        };
        let share = numbers as f64 / width as f64;
        match runs.last_mut() {
            Some(run) if open && run.width == width => {
                run.rows += 1;
                run.share += share;
            }
            _ => runs.push(Run {
                start: k,
                width,
                rows: 1,
                last: false,
                share,
            }),
        }
        open = true;
    }
    if let (true, Some(run)) = (open, runs.last_mut()) {
        run.last = true;
    }
    runs
}

/// The best table under a dialect: it begins with the first run of its width, and a spoilt row
/// within does not end it. Rows count by the share of their cells that are numbers, so that cells
/// joined by a wrong separator lose.
fn block(lines: &[&str], dialect: Dialect) -> Option<Block> {
    let runs = runs(lines, dialect);
    let mut best: Option<Block> = None;
    for (k, run) in runs.iter().enumerate() {
        let like = || runs[k..].iter().filter(|other| other.width == run.width);
        let score = like().map(|run| run.share).sum();
        let enough = run.rows >= LIKE_ROWS || run.last;
        if enough && best.as_ref().is_none_or(|best| score > best.score) {
            best = Some(Block {
                dialect,
                start: run.start,
                width: run.width,
                score,
            });
        }
    }
    best
}

/// The header above a block, and the units between.
fn headed(
    file: &str,
    lines: &[&str],
    block: &Block,
    undecided: bool,
) -> Result<Layout, RecordError> {
    let above: Vec<(usize, Vec<Cow<'_, str>>)> = (0..block.start)
        .rev()
        .filter(|&k| !is_rule(lines[k]))
        .take(2)
        .filter_map(|k| Some((k, names(lines[k], block.dialect.separator, block.width)?)))
        .collect();
    let (header, units) = match &above[..] {
        [units, header] if are_units(&units.1) && !is_bracketed(&header.1) => (header, Some(units)),
        [header, ..] => (header, None),
        [] => {
            return Err(RecordError::Text {
                file: file.to_owned(),
                fault: TextFault::NoHeader {
                    line: block.start as u64 + 1,
                    width: block.width,
                    example: example(block.width),
                },
            });
        }
    };
    let mut headings: Vec<Heading> = header.1.iter().map(|cell| heading(cell)).collect();
    if let Some((_, units)) = units {
        for (heading, unit) in headings.iter_mut().zip(units) {
            *heading = Heading::new(&heading.name, without_brackets(unit));
        }
    }
    Ok(Layout {
        dialect: block.dialect,
        undecided,
        header: Some(header.0),
        units: units.map(|(line, _)| *line),
        first_row: block.start,
        headings,
    })
}

/// A blank line or a line of dashes.
fn is_rule(line: &str) -> bool {
    line.chars().all(|c| {
        matches!(
            c,
            '-' | '=' | '_' | '+' | '|' | ' ' | '\t' | '\r' | ';' | ','
        )
    })
}

fn is_bracketed(cells: &[Cow<'_, str>]) -> bool {
    cells.iter().any(|cell| !heading(cell).unit.is_empty())
}

/// Whether a row holds units: at least half of what is written there is known, all of it short.
fn are_units(cells: &[Cow<'_, str>]) -> bool {
    const LONGEST: usize = 10;
    let written = || {
        let cells = cells.iter().map(|cell| without_brackets(cell));
        cells.filter(|cell| !matches!(*cell, "" | "-"))
    };
    let known = written().filter(|cell| is_unit(cell)).count();
    known > 0 && known * 2 >= written().count() && written().all(|c| c.chars().count() <= LONGEST)
}

fn without_brackets(cell: &str) -> &str {
    let inner = |open, close| cell.strip_prefix(open)?.strip_suffix(close);
    inner('[', ']')
        .or_else(|| inner('(', ')'))
        .unwrap_or(cell)
        .trim()
}

/// Whether a file begins with a header of the contract's own form: cells separated by commas, one
/// at least with its unit in square brackets.
pub(crate) fn starts_by_contract(head: &[u8]) -> bool {
    let head = head.strip_prefix(b"\xef\xbb\xbf").unwrap_or(head);
    let first = head
        .split(|&byte| byte == b'\n')
        .map(|line| line.trim_ascii())
        .find(|line| !line.is_empty());
    let Some(Ok(line)) = first.map(std::str::from_utf8) else {
        return false;
    };
    if line.contains([';', '\t', '\r']) {
        return false;
    }
    let cells = split(line, ',').unwrap_or_default();
    let unit = |cell: &Cow<'_, str>| cell.ends_with(']') && !heading(cell).unit.is_empty();
    cells.iter().any(unit)
}
