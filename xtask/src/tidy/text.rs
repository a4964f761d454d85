//! Lines of Rust, without a compiler: code, comments, words.

/// A line divided into its code and its comment.
///
/// Strings and character literals are followed within the line; a string over several lines is
/// taken for code, which errs on the side of a finding.
pub(super) fn split_comment(line: &str) -> (&str, &str) {
    let bytes = line.as_bytes();
    let mut in_string = false;
    let mut at = 0;
    while at < bytes.len() {
        match bytes[at] {
            b'\\' if in_string => at += 1,
            b'\'' if !in_string && bytes[at..].starts_with(b"'\"'") => at += 2,
            b'\'' if !in_string && bytes[at..].starts_with(b"'\\\"'") => at += 3,
            b'"' => in_string = !in_string,
            b'/' if !in_string && bytes[at..].starts_with(b"//") => return line.split_at(at),
            _ => {}
        }
        at += 1;
    }
    (line, "")
}

/// The code of a file with its line numbers, from 1: no comments, no `#[cfg(test)]` modules.
pub(super) fn code_lines(text: &str) -> Vec<(usize, &str)> {
    let mut lines = Vec::new();
    let mut all = text.lines().enumerate().peekable();
    while let Some((index, line)) = all.next() {
        let module_follows = all
            .peek()
            .is_some_and(|(_, next)| next.starts_with("mod ") && next.trim_end().ends_with('{'));
        if line == "#[cfg(test)]" && module_follows {
            // Formatted code closes the module at the margin.
            for (_, inner) in all.by_ref() {
                if inner == "}" {
                    break;
                }
            }
            continue;
        }
        let (code, _) = split_comment(line);
        if !code.trim().is_empty() {
            lines.push((index + 1, code));
        }
    }
    lines
}

/// The comments of a file with their line numbers, from 1, without the slashes; an empty text
/// where a line has none.
pub(super) fn comment_lines(text: &str) -> Vec<(usize, &str)> {
    text.lines()
        .enumerate()
        .map(|(index, line)| {
            let (_, comment) = split_comment(line);
            (index + 1, comment.trim_start_matches(['/', '!']).trim())
        })
        .collect()
}

/// Whether a text holds a word: no letter, digit or underscore on either side of it.
pub(super) fn has_word(text: &str, word: &str) -> bool {
    let part_of_name = |c: char| c.is_alphanumeric() || c == '_';
    text.match_indices(word).any(|(at, _)| {
        let before = text[..at].chars().next_back();
        let after = text[at + word.len()..].chars().next();
        !before.is_some_and(part_of_name) && !after.is_some_and(part_of_name)
    })
}

/// What `use std::{...}` brings in, one `std::x` for each, with the line of the `use`.
pub(super) fn grouped_std_imports(lines: &[(usize, &str)]) -> Vec<(usize, String)> {
    let mut found = Vec::new();
    for (start, (line, code)) in lines.iter().enumerate() {
        let Some((_, rest)) = code.split_once("std::{") else {
            continue;
        };
        let mut group = rest.to_owned();
        for (_, next) in &lines[start + 1..] {
            if group.contains(';') {
                break;
            }
            group.push_str(next);
        }
        let mut depth = 0_i32;
        let mut item = String::new();
        for c in group.chars().chain([',']) {
            match c {
                '{' => depth += 1,
                '}' | ';' => depth -= 1,
                ',' if depth == 0 => {
                    found.push((*line, format!("std::{}", item.trim())));
                    item.clear();
                }
                _ => {}
            }
            if c != ',' || depth > 0 {
                item.push(c);
            }
            if depth < 0 {
                found.push((*line, format!("std::{}", item.trim())));
                break;
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verify_comments_are_told_from_strings() {
        assert_eq!(
            split_comment("let a = 1; // one"),
            ("let a = 1; ", "// one")
        );
        assert_eq!(split_comment(r#"f("http://x")"#), (r#"f("http://x")"#, ""));
        assert_eq!(
            split_comment(r#"f("\"//") // y"#),
            (r#"f("\"//") "#, "// y")
        );
        assert_eq!(split_comment("c == '\"' // z"), ("c == '\"' ", "// z"));
        assert_eq!(split_comment("/// doc"), ("", "/// doc"));
    }

    #[test]
    fn verify_test_modules_are_left_out_and_nothing_after_them() {
        let text = "fn a() {}\n#[cfg(test)]\nmod tests {\n    fn b() {}\n}\nfn c() {} // d\n";
        assert_eq!(code_lines(text), [(1, "fn a() {}"), (6, "fn c() {} ")]);
        let text = "#[cfg(test)]\nuse x::y;\nfn c() {}\n";
        assert_eq!(code_lines(text).len(), 3);
    }

    #[test]
    fn verify_words() {
        assert!(has_word("use std::fs;", "fs"));
        assert!(!has_word("offs", "fs") && !has_word("fs_x", "fs"));
        assert!(has_word("fsx fs", "fs"));
    }

    #[test]
    fn verify_grouped_imports() {
        let names = |text: &str| -> Vec<String> {
            let found = grouped_std_imports(&code_lines(text));
            found.into_iter().map(|(_, name)| name).collect()
        };
        assert_eq!(names("use std::{fmt, fs};"), ["std::fmt", "std::fs}"]);
        assert_eq!(
            names("use std::{\n    collections::{A, B},\n    net::IpAddr,\n};"),
            ["std::collections::{A, B}", "std::net::IpAddr", "std::}"]
        );
    }
}
