//! Points at what a message speaks of, as a compiler does: the line, and a caret below.
//!
//! Errors come from many crates; what they have in common is their line, which begins with the file
//! and says the line, or the item of a model file, and quotes the column and what was found. The
//! snapshots of the tests hold that form, so the place is read off it, and a message that has none
//! is simply not pointed at.

use std::fs::File;
use std::io::{BufRead, BufReader, Read};

use crate::text::{shown, styled};

const CARET: anstyle::Style = anstyle::Style::new()
    .bold()
    .fg_color(Some(anstyle::Color::Ansi(anstyle::AnsiColor::Red)));
const EDGE: anstyle::Style =
    anstyle::Style::new().fg_color(Some(anstyle::Color::Ansi(anstyle::AnsiColor::Blue)));
/// Lines are looked for in so many bytes of a file.
const MOST_BYTES: u64 = 64 << 20;
/// Characters of a line that are shown.
const SHOWN: usize = 90;
/// Words of a message among which a key is looked for.
const FIRST_WORDS: usize = 3;
/// Lines in which the header of a record is looked for.
const HEADER_LINES: usize = 50;

/// The line a message speaks of with a caret below; `None` where it speaks of none.
pub(crate) fn picture(message: &str) -> Option<String> {
    let (file, line) = place(message)?;
    let above = lines(file, line)?;
    let text = above.get(line - 1)?;
    // What is no text cannot be shown.
    if text.contains(|c: char| c.is_control() && c != '\t') {
        return None;
    }
    let (from, to) = span(&above, text, message);
    Some(drawn(file, line, text, from, to))
}

/// The file and the line: as the message says, or where the item, the column or the key stands that
/// it names.
fn place(message: &str) -> Option<(&str, usize)> {
    if let Some(named) = named_line(message) {
        return Some(named);
    }
    if let Some((file, item)) = named_item(message) {
        return Some((
            file,
            line_of_item(&lines(file, usize::MAX)?, item, message)?,
        ));
    }
    if let Some((file, name)) = message.split_once(": column '") {
        let name = name.split_once('\'')?.0;
        let above = lines(file, HEADER_LINES)?;
        let header = above
            .iter()
            .position(|line| cell_named(line, separator(line), name).is_some());
        return Some((file, header? + 1));
    }
    let (file, about) = message.split_once(": ")?;
    let key = about.split_once(" is \"")?.0;
    let found = lines(file, usize::MAX)?;
    let line = found.iter().position(|line| key_of(line) == Some(key))?;
    Some((file, line + 1))
}

/// The key of a line of a model file.
fn key_of(line: &str) -> Option<&str> {
    line.split_once('=').map(|(key, _)| key.trim())
}

/// `FILE: line N` and perhaps `, column M`.
fn named_line(message: &str) -> Option<(&str, usize)> {
    let (file, rest) = message.split_once(": line ")?;
    let digits: String = rest.chars().take_while(char::is_ascii_digit).collect();
    let line = digits.parse().ok().filter(|line| *line > 0)?;
    Some((file, line))
}

/// `FILE: [[table]] "name"`: the table with its name.
fn named_item(message: &str) -> Option<(&str, &str)> {
    let (file, item) = message.split_once(": [[")?;
    let end = item.find(": ").unwrap_or(item.len());
    Some((file, &item[..end]))
}

/// The first lines of a file, up to and with number `last`.
fn lines(file: &str, last: usize) -> Option<Vec<String>> {
    let mut reader = BufReader::new(File::open(file).ok()?.take(MOST_BYTES));
    let mut found = Vec::new();
    let mut bytes = Vec::new();
    while found.len() < last && reader.read_until(b'\n', &mut bytes).ok()? > 0 {
        let text = String::from_utf8_lossy(&bytes);
        let text = text
            .trim_start_matches('\u{feff}')
            .trim_end_matches(['\n', '\r']);
        found.push(text.to_string());
        bytes.clear();
    }
    Some(found)
}

/// The line of an item of a model file, of its key or value that the message quotes if it does.
fn line_of_item(lines: &[String], item: &str, message: &str) -> Option<usize> {
    let (table, name) = item.split_once("]]")?;
    let name = quoted(name).next()?;
    let header = format!("[[{table}]]");
    let starts = lines
        .iter()
        .enumerate()
        .filter(|(_, l)| l.trim().starts_with(&header));
    let block = |start: usize| {
        let rest = lines[start + 1..].iter();
        let len = rest
            .take_while(|line| !line.trim().starts_with('['))
            .count();
        start..start + 1 + len
    };
    let holds = |start: &usize| {
        let mut inside = lines[block(*start)].iter();
        inside.any(|line| line.contains(&format!("\"{name}\"")))
    };
    let start = starts.map(|(start, _)| start).find(holds)?;
    // What is wrong is what the message quotes or names after the item itself.
    let (_, about) = message.split_once(item)?;
    let words = first_words(about);
    let key = |line: &&usize| {
        let text = lines[**line].trim();
        quoted(about).any(|word| text.contains(&format!("\"{word}\"")))
            || key_of(text).is_some_and(|key| words.contains(&key))
            || (words.starts_with(&["unknown", "kind"]) && key_of(text) == Some("kind"))
    };
    let inside: Vec<usize> = block(start).collect();
    Some(inside.iter().find(key).copied().unwrap_or(start) + 1)
}

/// The words in which a message says what it found.
fn first_words(about: &str) -> Vec<&str> {
    let found = about.split(", needed").next().unwrap_or_default();
    let words = found.trim_start_matches(':').split_whitespace();
    words.take(FIRST_WORDS).collect()
}

/// What stands in quotation marks of any kind.
fn quoted(text: &str) -> impl Iterator<Item = &str> {
    let mut rest = text;
    std::iter::from_fn(move || {
        let start = rest.find(['\'', '"', '`'])?;
        let mark = rest[start..].chars().next()?;
        let inside = &rest[start + 1..];
        let end = inside.find(mark)?;
        rest = &inside[end + 1..];
        Some(&inside[..end])
    })
}

/// Characters of the line that are pointed at: the cell of a column, else what the message quotes,
/// else all of it.
fn span(above: &[String], text: &str, message: &str) -> (usize, usize) {
    let about = message
        .split_once(": line ")
        .map_or(message, |(_, rest)| rest);
    if let Some(from) = character(about) {
        let word = |c: &char| c.is_alphanumeric() || "_-+.\"".contains(*c);
        let len = text.chars().skip(from).take_while(word).count();
        return (from, from + len.max(1));
    }
    let chars = |byte: usize| text[..byte].chars().count();
    let column = about
        .split_once("column '")
        .and_then(|(_, rest)| rest.split_once('\''));
    if let Some((from, to)) = column.and_then(|(name, _)| cell(above, text, name)) {
        return (chars(from), chars(to));
    }
    if about.contains(": time goes") || about.contains(": the time step") {
        let time = cell(above, text, "t").or_else(|| nth_cell(text, separator(text), 0));
        if let Some((from, to)) = time {
            return (chars(from), chars(to));
        }
    }
    if let Some((from, to)) = numbered(about).and_then(|n| nth_cell(text, separator(text), n)) {
        return (chars(from), chars(to));
    }
    for word in quoted(about).filter(|word| !word.is_empty()) {
        if let Some(from) = text.find(word) {
            return (chars(from), chars(from + word.len()));
        }
    }
    if let Some((from, to)) = key_or_value(text, message) {
        return (chars(from), chars(to));
    }
    let end = text.trim_end().len();
    let start = text.len() - text.trim_start().len();
    (chars(start.min(end)), chars(end))
}

/// What a line `key = value` is blamed for, in bytes: `key is ...` for its value, `unknown ... key`
/// for its key.
fn key_or_value(text: &str, message: &str) -> Option<(usize, usize)> {
    let key = key_of(text)?;
    let start = text.find(key)?;
    if message.contains(&format!(": {key} is ")) {
        let from = text.find('=')? + 1;
        let value = text[from..].split('#').next()?;
        let blank = value.len() - value.trim_start().len();
        return Some((from + blank, from + value.trim_end().len()));
    }
    message
        .contains(&format!(" {key},"))
        .then_some((start, start + key.len()))
}

/// The character of `N, column M: ...`, counted from 1 there.
fn character(about: &str) -> Option<usize> {
    let (line, rest) = about.split_once(", column ")?;
    let (column, _) = rest.split_once(':')?;
    let number = |digits: &str| digits.parse::<usize>().ok();
    number(line)?;
    number(column)?.checked_sub(1)
}

/// `column N`, counted from 1.
fn numbered(about: &str) -> Option<usize> {
    let (_, rest) = about.split_once("column ")?;
    let digits: String = rest.chars().take_while(char::is_ascii_digit).collect();
    digits.parse::<usize>().ok()?.checked_sub(1)
}

/// What separates the cells of a line; a comma beside another separator is a decimal sign.
fn separator(text: &str) -> char {
    let found = [';', '\t'].into_iter().find(|c| text.contains(*c));
    found.unwrap_or(',')
}

/// The cell of a line below the header cell of that name.
fn cell(above: &[String], text: &str, name: &str) -> Option<(usize, usize)> {
    let separator = separator(text);
    let header = above.iter().take(HEADER_LINES);
    let index = header
        .into_iter()
        .find_map(|line| cell_named(line, separator, name))?;
    nth_cell(text, separator, index)
}

/// The cell of a header that has this name, with or without a unit.
fn cell_named(line: &str, separator: char, name: &str) -> Option<usize> {
    let mut cells = line
        .split(separator)
        .map(|cell| cell.trim().trim_matches('"'));
    cells
        .position(|cell| cell == name || cell.split(['[', '(']).next().map(str::trim) == Some(name))
}

fn nth_cell(text: &str, separator: char, index: usize) -> Option<(usize, usize)> {
    let cell = text.split(separator).nth(index)?;
    let before = text.split(separator).take(index).map(|cell| cell.len() + 1);
    let start = before.sum::<usize>();
    let blank = cell.len() - cell.trim_start().len();
    let trimmed = cell.trim();
    let from = start + if trimmed.is_empty() { 0 } else { blank };
    Some((from, from + trimmed.len()))
}

/// The place, the line and the caret.
fn drawn(file: &str, line: usize, text: &str, from: usize, to: usize) -> String {
    // A long line is cut, with what is pointed at inside.
    let start = if from > SHOWN * 2 / 3 {
        from - SHOWN / 2
    } else {
        0
    };
    let part: String = text.chars().skip(start).take(SHOWN).collect();
    let (from_shown, to_shown) = (from - start, (to.max(from + 1) - start).min(SHOWN + 1));
    let number = line.to_string();
    let margin = " ".repeat(number.len());
    let bar = styled(EDGE, "|");
    let cut = if start > 0 { "..." } else { "" };
    let carets = "^".repeat(to_shown.saturating_sub(from_shown).max(1));
    format!(
        "{margin}{} {}:{line}:{}\n{margin} {bar}\n{} {bar} {cut}{}\n{margin} {bar} {}{}\n",
        styled(EDGE, "-->"),
        shown(file),
        from + 1,
        styled(EDGE, &number),
        shown(&part),
        " ".repeat(cut.len() + from_shown),
        styled(CARET, &carets)
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pointed(above: &[&str], message: &str) -> String {
        let above: Vec<String> = above.iter().map(ToString::to_string).collect();
        let (_, line) = named_line(message).unwrap_or(("", above.len()));
        let text = &above[line - 1];
        let (from, to) = span(&above, text, message);
        text.chars().skip(from).take(to - from).collect()
    }

    #[test]
    fn verify_the_cell_of_a_column_is_pointed_at() {
        let rows = ["t [s],u [N],y [m]", "0.00,1.5,0.1", "0.01, off ,0.1"];
        let point = |message: &str| pointed(&rows, message);
        assert_eq!(
            point("A.csv: line 3: column 'u' holds 'off', needed"),
            "off"
        );
        assert_eq!(point("A.csv: line 2: column 'y' holds"), "0.1");
        assert_eq!(point("A.csv: line 1: column 2 is headed 'u [N]'"), "u [N]");
        assert_eq!(point("A.csv: line 2: 3 cells found"), "0.00,1.5,0.1");
        assert_eq!(point("A.csv: line 3: time goes from 1 s to 0 s"), "0.01");
        let german = ["Zeit (s);Weg (mm)", "0,00;1,5"];
        assert_eq!(pointed(&german, "B.csv: line 2: column 'Weg' holds"), "1,5");
        let model = ["[[mass]]", "wieght = 1.0"];
        assert_eq!(
            pointed(
                &model,
                "m: line 2, column 1: unknown field `wieght`, expected"
            ),
            "wieght"
        );
    }

    #[test]
    fn verify_items_of_a_model_are_found() {
        let text = "[[spring]]\nname = \"a\"\n\n[[spring]]\nname = \"rod\"\nbetween = [\"blok\", \"ground\"]\nstiffness = inf\n";
        let lines: Vec<String> = text.lines().map(str::to_string).collect();
        let line = |message: &str| {
            let (_, item) = named_item(message).unwrap_or_default();
            line_of_item(&lines, item, message)
        };
        assert_eq!(
            line("m: [[spring]] \"rod\": unknown node \"blok\", needed"),
            Some(6)
        );
        assert_eq!(
            line("m: [[spring]] \"rod\": stiffness is inf, needed is"),
            Some(7)
        );
        assert_eq!(
            line("m: [[spring]] \"rod\": the name is used twice"),
            Some(5)
        );
        assert_eq!(line("m: [[mass]] \"rod\": value is 0"), None);
    }

    #[test]
    fn verify_the_key_or_the_value_is_pointed_at() {
        let blamed = |text: &str, message: &str| {
            key_or_value(text, message).map(|(from, to)| text[from..to].to_owned())
        };
        let about = |what: &str| format!("m: [[mass]] \"a\": {what}, needed is another");
        let value = blamed("value = -5.0   # kg", &about("value is -5"));
        assert_eq!(value.as_deref(), Some("-5.0"));
        let key = blamed("  force = 1.0", &about("unknown parameter force"));
        assert_eq!(key.as_deref(), Some("force"));
        assert_eq!(blamed("name = \"a\"", &about("value is -5")), None);
        assert_eq!(blamed("[[mass]]", &about("value is -5")), None);
    }

    #[test]
    fn verify_long_lines_are_cut_around_what_is_pointed_at() {
        let text = format!("{}wrong{}", "x".repeat(300), "y".repeat(300));
        let drawn = drawn("A.csv", 12, &text, 300, 305);
        let plain = anstream::adapter::strip_str(&drawn).to_string();
        let rows: Vec<&str> = plain.lines().collect();
        assert_eq!(rows[0], "  --> A.csv:12:301");
        let at = rows[3].find('^').unwrap_or(0);
        assert_eq!(&rows[2][at..at + 5], "wrong");
        assert_eq!(rows[3].matches('^').count(), 5);
        assert!(rows.iter().all(|row| row.chars().count() < 110));
    }
}
