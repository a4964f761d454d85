//! Pages changed a little: which check says so.

use std::fs;
use std::path::Path;

use xtask::reproduce::{Block, Cell, Outcome, Page, check_files};

use crate::{FILES, PAGES, peaks_off};

/// A page with its cells changed; the head of the column comes along.
fn changed(page: &Page, change: impl Fn(&str, &mut Cell)) -> Page {
    let mut page = page.clone();
    for block in &mut page.blocks {
        if let Block::Table(table) = block {
            for row in &mut table.rows {
                for (column, cell) in table.columns.iter().zip(row) {
                    change(column, cell);
                }
            }
        }
    }
    page
}

/// Whether the snapshot that holds a page is another than the page.
fn differs_from_snapshot(page: &Page) -> bool {
    let name = format!("tests/snapshots/reproduce__{}.snap", page.stem);
    let text = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(name)).unwrap();
    let (_, body) = text.split_once("\n---\n").unwrap();
    let held: serde_json::Value = serde_json::from_str(body).unwrap();
    held != page.json()
}

/// Whether `reproduce-paper --check` names the text and the JSON of a page, and no other page.
fn is_named_by_check(page: &Page) -> bool {
    let mut files = FILES.clone();
    files.extend(page.files().unwrap());
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let Outcome::Differs(lines) = check_files(&root, &files).unwrap() else {
        return false;
    };
    let of_page = |line: &String| line.contains(&format!("/{}.", page.stem));
    lines.len() == 3 && lines.iter().all(of_page)
}

fn peaks() -> &'static Page {
    PAGES.iter().find(|page| page.stem == "peaks").unwrap()
}

/// Red in the closed forms of every table of lines, in the snapshot and in `--check`.
fn assert_red(page: &Page, what: &str) {
    for (table, off) in peaks_off(&page.json()).iter().enumerate() {
        assert!(!off.is_empty(), "{what}: table {table} is not red");
    }
    assert!(differs_from_snapshot(page), "{what}: the snapshot is green");
    assert!(is_named_by_check(page), "{what}: --check is green");
}

#[test]
fn verify_pages_as_they_are_are_green() {
    for page in PAGES.iter() {
        assert!(!differs_from_snapshot(page), "{}", page.stem);
    }
}

#[test]
fn verify_heights_two_per_cent_up_are_red() {
    let page = changed(peaks(), |column, cell| {
        if let (true, Cell::Number(height, _)) = (column.starts_with("height"), cell) {
            *height *= 1.02;
        }
    });
    assert_red(&page, "heights");
}

/// A bin of 20 s.
#[test]
fn verify_frequencies_one_bin_up_are_red() {
    let page = changed(peaks(), |column, cell| {
        if let (true, Cell::Number(freq, _)) = (column == "found [Hz]", cell) {
            *freq += 0.05;
        }
    });
    assert_red(&page, "frequencies");
}

#[test]
fn verify_phases_one_degree_up_are_red() {
    let page = changed(peaks(), |column, cell| {
        if let (true, Cell::Text(text)) = (column == "phase [°]", cell)
            && let Ok(degrees) = text.parse::<f64>()
        {
            *text = format!("{:.2}", degrees + 1.0);
        }
    });
    assert_red(&page, "phases");
}

/// The last line of each table less: no closed form misses it, the snapshot does.
#[test]
fn verify_a_line_less_is_red() {
    let mut page = peaks().clone();
    for block in &mut page.blocks {
        if let Block::Table(table) = block {
            table.rows.pop();
        }
    }
    assert!(differs_from_snapshot(&page) && is_named_by_check(&page));
}

/// Every number of every sentence and caption of every page, one digit of it another.
#[test]
fn verify_another_digit_in_the_prose_is_red() {
    let mut tried = 0;
    for page in PAGES.iter() {
        for at in 0..page.blocks.len() {
            let digits = match &page.blocks[at] {
                Block::Text(text) => text.clone(),
                Block::Figure(_, caption, _) => caption.clone(),
                Block::Table(_) => continue,
            };
            for (place, digit) in digits.char_indices().filter(|(_, c)| c.is_ascii_digit()) {
                let other = if digit == '9' {
                    '0'
                } else {
                    (digit as u8 + 1) as char
                };
                let mut text = digits.clone();
                text.replace_range(place..=place, &other.to_string());
                let mut page = page.clone();
                match &mut page.blocks[at] {
                    Block::Text(own) | Block::Figure(_, own, _) => *own = text,
                    Block::Table(_) => {}
                }
                tried += 1;
                // The text alone: the JSON of a page has it whole.
                let statements = page.json()["statements"].clone();
                let held = PAGES.iter().find(|held| held.stem == page.stem).unwrap();
                assert_ne!(
                    statements,
                    held.json()["statements"],
                    "{} {place}",
                    page.stem
                );
            }
        }
        let statement = page
            .blocks
            .iter()
            .position(|block| matches!(block, Block::Text(_)));
        if let Some(Block::Text(text)) = statement.map(|at| &page.blocks[at]) {
            let mut page = page.clone();
            page.blocks[statement.unwrap()] = Block::Text(format!("{text} 1"));
            assert!(
                differs_from_snapshot(&page) && is_named_by_check(&page),
                "{}",
                page.stem
            );
        }
    }
    assert!(tried > 100, "{tried}");
}

/// A number of any table of any page, in its last digit shown.
#[test]
fn verify_another_digit_in_a_table_is_red() {
    for page in PAGES.iter() {
        let one = |first: bool| {
            let mut page = page.clone();
            for block in &mut page.blocks {
                let Block::Table(table) = block else { continue };
                let mut cells: Vec<&mut Cell> = table.rows.iter_mut().flatten().collect();
                if !first {
                    cells.reverse();
                }
                let number = cells.into_iter().find(|cell| {
                    matches!(cell, Cell::Number(value, _) if *value != 0.0 && value.is_finite())
                });
                if let Some(Cell::Number(value, digits)) = number {
                    let exponent = value.abs().log10().floor() - (*digits as f64 - 1.0);
                    *value += 10_f64.powf(exponent);
                    return Some(page);
                }
            }
            None
        };
        for page in [one(true), one(false)].into_iter().flatten() {
            assert!(differs_from_snapshot(&page), "{}", page.stem);
        }
    }
}
