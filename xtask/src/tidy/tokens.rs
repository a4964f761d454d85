//! Tokens of Rust, without a compiler: names, `::` and single signs. Literals are set aside.

use super::text::code_lines;

/// A name, `::`, or one sign.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Token<'a> {
    /// Line, from 1.
    pub(super) line: usize,
    /// Text.
    pub(super) text: &'a str,
}

impl Token<'_> {
    /// Whether it is a name or a keyword.
    pub(super) fn is_name(&self) -> bool {
        self.text
            .starts_with(|c: char| c.is_alphabetic() || c == '_')
    }
}

/// The tokens of the code of a file: no comments, no `#[cfg(test)]` modules, no literals.
pub(super) fn tokens(text: &str) -> Vec<Token<'_>> {
    let mut found = Vec::new();
    // Quote and signs that end the string that a line above has begun.
    let mut open: Option<String> = None;
    for (line, code) in code_lines(text) {
        let mut rest = code;
        while !rest.is_empty() {
            if let Some(end) = &open {
                let Some(after) = after_string(rest, end) else {
                    break;
                };
                rest = after;
                open = None;
                continue;
            }
            if let Some((end, inside)) = string_start(rest) {
                open = Some(end);
                rest = inside;
                continue;
            }
            let length = token_length(rest);
            let (text, after) = rest.split_at(length);
            if !text.starts_with(|c: char| c.is_whitespace() || c.is_ascii_digit() || c == '\'') {
                found.push(Token { line, text });
            }
            rest = after;
        }
    }
    found
}

/// What ends the string that begins here, and the text inside it.
fn string_start(rest: &str) -> Option<(String, &str)> {
    if let Some(inside) = rest.strip_prefix('"') {
        return Some(("\"".to_owned(), inside));
    }
    let raw = rest.strip_prefix('r').or_else(|| rest.strip_prefix("br"))?;
    let inside = raw.trim_start_matches('#');
    let signs = &raw[..raw.len() - inside.len()];
    inside
        .strip_prefix('"')
        .map(|inside| (format!("\"{signs}."), inside))
}

/// What follows the end of a string; nothing if it goes on in the next line.
///
/// The end of a raw string is marked with a point after it: in one, a backslash is itself.
fn after_string<'a>(rest: &'a str, end: &str) -> Option<&'a str> {
    if let Some(raw_end) = end.strip_suffix('.') {
        return rest.split_once(raw_end).map(|(_, after)| after);
    }
    let mut escaped = false;
    for (at, c) in rest.char_indices() {
        match c {
            _ if escaped => escaped = false,
            '\\' => escaped = true,
            '"' => return Some(&rest[at + 1..]),
            _ => {}
        }
    }
    None
}

/// Length in bytes of the token that a text begins with: a name, a number, a character in quotes or
/// a lifetime, `::`, or one sign.
fn token_length(rest: &str) -> usize {
    let part_of_name = |c: char| c.is_alphanumeric() || c == '_';
    let name_length = |text: &str| text.find(|c| !part_of_name(c)).unwrap_or(text.len());
    let mut signs = rest.chars();
    let first = signs.next().map_or(0, char::len_utf8);
    if rest.starts_with("::") {
        return 2;
    }
    if let Some(quoted) = rest.strip_prefix('\'') {
        let escape = usize::from(quoted.starts_with('\\'));
        let sign = quoted[escape..].chars().next().map_or(0, char::len_utf8);
        let closed = quoted[escape + sign..].find('\'');
        return match closed {
            // '\u{b5}' is longer than one sign after the backslash.
            Some(more) if more == 0 || escape == 1 => 1 + escape + sign + more + 1,
            _ => 1 + name_length(quoted),
        };
    }
    name_length(rest).max(first)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(text: &str) -> Vec<&str> {
        tokens(text).iter().map(|token| token.text).collect()
    }

    #[test]
    fn verify_tokens_of_paths() {
        assert_eq!(
            texts("use crate::a::{b, self};\n"),
            [
                "use", "crate", "::", "a", "::", "{", "b", ",", "self", "}", ";"
            ]
        );
        assert_eq!(tokens("\nfn f\n(").last().map(|token| token.line), Some(3));
        assert!(tokens("_a")[0].is_name() && !tokens("::")[0].is_name());
    }

    #[test]
    fn verify_literals_and_comments_are_set_aside() {
        assert_eq!(
            texts("f(\"crate::a \\\" crate::b\", x)"),
            ["f", "(", ",", "x", ")"]
        );
        assert_eq!(
            texts("f(\"a \\\n  crate::b\", x)"),
            ["f", "(", ",", "x", ")"]
        );
        assert_eq!(texts("f(r#\"crate::\\\"#, x)"), ["f", "(", ",", "x", ")"]);
        assert_eq!(
            texts("f('\"', '\\'', '\\u{b5}', 'a, 12.5, x)").join(" "),
            "f ( , , , , . , x )"
        );
        assert_eq!(texts("x // crate::a\n"), ["x"]);
        assert_eq!(
            texts("#[cfg(test)]\nmod t {\n    use super::*;\n}\n"),
            [""; 0]
        );
    }
}
