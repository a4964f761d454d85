//! Text for a terminal: lines of a bearable length, tables, figures, colours.

pub(crate) use simgap_app::text::shown;
use simgap_report::lines::wrap;

/// Longest line, characters.
pub(crate) const WIDTH: usize = 100;

/// Colours are written freely; [`crate::stdout::say`] takes them out where no terminal shows them.
pub(crate) const STRONG: anstyle::Style = anstyle::Style::new().bold();
/// What only names what follows.
pub(crate) const FAINT: anstyle::Style = anstyle::Style::new().dimmed();

/// A word in a style.
pub(crate) fn styled(style: anstyle::Style, text: &str) -> String {
    format!("{style}{text}{style:#}")
}

/// A name on the left, the text wrapped on its right, `indent` characters from the edge.
pub(crate) fn named(out: &mut String, name: &str, text: &str, indent: usize) {
    const EDGE: usize = 2;
    for (i, line) in wrap(&shown(text), WIDTH - indent).into_iter().enumerate() {
        let name = if i == 0 { name } else { "" };
        let pad = " ".repeat(indent.saturating_sub(EDGE + name.chars().count()));
        let name = if name.is_empty() {
            String::new()
        } else {
            styled(FAINT, name)
        };
        out.push_str(&" ".repeat(EDGE));
        out.push_str(&format!("{name}{pad}{line}\n"));
    }
}

/// Rows of cells under each other, two spaces between; the cells of `right` columns end flush.
pub(crate) fn table(out: &mut String, head: &[&str], rows: &[Vec<String>], right: &[usize]) {
    let width = |column: usize| {
        let cells = rows.iter().filter_map(|row| row.get(column));
        let longest = cells.map(|cell| cell.chars().count()).max();
        longest.unwrap_or(0).max(head[column].chars().count())
    };
    let widths: Vec<usize> = (0..head.len()).map(width).collect();
    let line = |cells: &mut dyn Iterator<Item = &str>| {
        let mut line = String::from(" ");
        for (column, cell) in cells.enumerate() {
            let pad = " ".repeat(widths[column] - cell.chars().count());
            line.push(' ');
            if right.contains(&column) {
                line.push_str(&format!("{pad}{cell} "));
            } else {
                line.push_str(&format!("{cell}{pad} "));
            }
        }
        line.trim_end().to_string()
    };
    let head = line(&mut head.iter().copied());
    out.push_str(&styled(FAINT, &head));
    out.push('\n');
    for row in rows {
        out.push_str(&line(&mut row.iter().map(String::as_str)));
        out.push('\n');
    }
}

/// A number with four digits that matter, without a string of zeros.
pub(crate) fn figure(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{value}");
    }
    // Rounded to four digits, and then the fewest digits that say the same.
    let rounded: f64 = format!("{value:.3e}").parse().unwrap_or(value);
    if (1e-4..1e6).contains(&rounded.abs()) {
        format!("{rounded}")
    } else {
        format!("{rounded:e}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verify_figures_have_four_digits() {
        let told = [0.0, 1.0, -0.1, 2.0 / 3.0, 12_345.6, 1.0e-9 / 3.0, 8.0e9];
        let told = told.map(figure);
        assert_eq!(
            told,
            ["0", "1", "-0.1", "0.6667", "12350", "3.333e-10", "8e9"]
        );
    }

    #[test]
    fn verify_lines_are_wrapped_and_names_stay_on_the_left() {
        let mut out = String::new();
        named(&mut out, "law", &"word ".repeat(40), 10);
        let out = anstream::adapter::strip_str(&out).to_string();
        let lines: Vec<&str> = out.lines().collect();
        assert_eq!(lines.len(), 3);
        assert!(lines[0].starts_with("  law     word"), "{out}");
        assert!(lines[1].starts_with("          word"), "{out}");
        assert!(lines.iter().all(|line| line.chars().count() <= WIDTH));
    }
}
