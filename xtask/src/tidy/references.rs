//! Rules on the keys by which comments cite their sources.
//!
//! A key is a name with a year (`harris1978`, `BoxMuller1958`), or the number of a standard
//! (`iso18571`), anywhere in a comment; or any word in backticks in a paragraph that says it names
//! a reference. Case and hyphens make no difference. `docs/references.md` lists each key once,
//! in a line that starts with a dash and the key in backticks.

use super::text::comment_lines;
use super::workspace::REFERENCES;
use super::{Finding, Workspace};

/// How a paragraph says that it names its sources; at least one key must follow.
const MARKS: [&str; 2] = ["Reference: ", "References: "];

/// A key as it is compared.
fn canonical(key: &str) -> String {
    key.to_ascii_lowercase().replace('-', "")
}

/// Whether a word is a name with a year, or a standard with its number.
fn is_key(word: &str) -> bool {
    let letters = word.trim_end_matches(|c: char| c.is_ascii_digit());
    if letters.eq_ignore_ascii_case("iso") {
        return word.len() > letters.len();
    }
    // One letter may tell two works of one year apart.
    let year_end = word.trim_end_matches(|c: char| c.is_ascii_lowercase());
    let word = if word.len() - year_end.len() == 1 {
        year_end
    } else {
        word
    };
    let name = word.trim_end_matches(|c: char| c.is_ascii_digit());
    let year = word[name.len()..].parse::<u32>().unwrap_or(0);
    let spelt = name.chars().all(|c| c.is_ascii_alphabetic() || c == '-');
    name.len() >= 3 && spelt && (1800..2100).contains(&year)
}

/// Words that may be keys.
fn words(text: &str) -> impl Iterator<Item = &str> {
    let breaks = |c: char| !(c.is_ascii_alphanumeric() || c == '-' || c == '_');
    text.split(breaks)
}

/// Words in backticks that are spelt like a key.
fn quoted(text: &str) -> impl Iterator<Item = &str> {
    let spelt = |word: &&str| {
        !word.is_empty() && word.chars().all(|c| c.is_ascii_alphanumeric() || c == '-')
    };
    text.split('`').skip(1).step_by(2).filter(spelt)
}

/// Keys in the comments of a file; a line number without a key is a paragraph that names none.
fn cited(text: &str) -> Vec<(usize, Option<&str>)> {
    let mut found = Vec::new();
    let mut paragraph: Option<(usize, usize)> = None;
    for (line, comment) in comment_lines(text) {
        let mark = MARKS.iter().find_map(|mark| {
            let closes = format!("{comment} ");
            closes
                .find(mark)
                .map(|at| (at + mark.len()).min(comment.len()))
        });
        let before = found.len();
        found.extend(
            words(comment)
                .filter(|word| is_key(word))
                .map(|key| (line, Some(key))),
        );
        if comment.is_empty() {
            if let Some((start, 0)) = paragraph.take() {
                found.push((start, None));
            }
            continue;
        }
        if mark.is_some() {
            paragraph = Some((line, 0));
        }
        if let Some((_, keys)) = &mut paragraph {
            let rest = &comment[mark.unwrap_or(0)..];
            found.extend(
                quoted(rest)
                    .filter(|word| !is_key(word))
                    .map(|key| (line, Some(key))),
            );
            *keys += found.len() - before;
        }
    }
    if let Some((start, 0)) = paragraph {
        found.push((start, None));
    }
    found
}

/// Keys that the page of references lists.
fn listed(page: &str) -> Vec<(usize, &str)> {
    page.lines()
        .enumerate()
        .filter_map(|(index, line)| {
            let (key, _) = line.strip_prefix("- `")?.split_once('`')?;
            Some((index + 1, key))
        })
        .collect()
}

/// Every key in a comment is listed in `docs/references.md`, and every paragraph that says it
/// names a reference does.
#[must_use]
pub fn every_reference_resolves(workspace: &Workspace) -> Vec<Finding> {
    let page = listed(&workspace.references);
    let known: Vec<String> = page.iter().map(|(_, key)| canonical(key)).collect();
    let mut findings = Vec::new();
    for source in &workspace.sources {
        for (line, key) in cited(&source.text) {
            let message = match key {
                None => "a reference without a key, needed is one of docs/references.md".to_owned(),
                Some(key) if !known.contains(&canonical(key)) => {
                    format!("{key} is not listed in {REFERENCES}")
                }
                Some(_) => continue,
            };
            findings.push(Finding::in_source(source, line, message));
        }
    }
    findings
}

/// `docs/references.md` lists nothing twice, and nothing that no comment cites.
#[must_use]
pub fn every_source_listed_is_cited(workspace: &Workspace) -> Vec<Finding> {
    let cited: Vec<String> = workspace
        .sources
        .iter()
        .flat_map(|source| cited(&source.text))
        .filter_map(|(_, key)| key.map(canonical))
        .collect();
    let page = listed(&workspace.references);
    let mut findings = Vec::new();
    for (index, (line, key)) in page.iter().enumerate() {
        let twice = page[..index]
            .iter()
            .any(|(_, other)| canonical(other) == canonical(key));
        let message = if twice {
            format!("{key} is listed twice")
        } else if !cited.contains(&canonical(key)) {
            format!("{key} is cited nowhere")
        } else {
            continue;
        };
        findings.push(Finding {
            file: REFERENCES.to_owned(),
            line: *line,
            message,
        });
    }
    findings
}

#[cfg(test)]
mod tests {
    use super::super::Source;
    use super::*;

    fn messages(rule: super::super::Rule, text: &str, page: &str) -> Vec<String> {
        let workspace = Workspace {
            sources: vec![Source {
                path: "a.rs".into(),
                text: text.into(),
            }],
            references: page.into(),
            ..Workspace::default()
        };
        rule(&workspace).iter().map(Finding::to_string).collect()
    }

    #[test]
    fn verify_what_is_a_key() {
        let keys = [
            "harris1978",
            "Russell1997b",
            "box-muller1958",
            "ISO18571",
            "iso10816",
        ];
        assert!(keys.iter().all(|key| is_key(key)));
        let others = [
            "1978",
            "f1978",
            "table1",
            "version2",
            "iso",
            "x86",
            "abc9999",
            "Park_1975",
        ];
        for other in others {
            assert!(!is_key(other), "{other}");
        }
    }

    #[test]
    fn verify_keys_are_found_however_they_are_written() {
        let page = "- `harris1978`: x\n- `fnv`: y\n- `box-muller1958`: z\n";
        let text = "/// Reference: \\[Harris1978\\], chapter 2.\n\n// See BoxMuller1958.\n\
            /// Valid. Reference: `fnv`.\nfn f() {}\n";
        assert_eq!(messages(every_reference_resolves, text, page), [""; 0]);
        assert_eq!(messages(every_source_listed_is_cited, text, page), [""; 0]);
    }

    #[test]
    fn verify_unresolved_keys_are_found() {
        let text = "fn f() {} // after Nobody1999\n/// x. Reference:\n/// `folk`.\n";
        assert_eq!(
            messages(every_reference_resolves, text, ""),
            [
                "a.rs:1: Nobody1999 is not listed in docs/references.md",
                "a.rs:3: folk is not listed in docs/references.md",
            ]
        );
        let text = "/// Reference: a good book.\n";
        assert_eq!(
            messages(every_reference_resolves, text, ""),
            ["a.rs:1: a reference without a key, needed is one of docs/references.md"]
        );
    }

    #[test]
    fn verify_idle_and_double_entries_are_found() {
        let page = "- `fnv`: x\n- `FNV`: x\n- `harris1978`: y\n";
        assert_eq!(
            messages(every_source_listed_is_cited, "// Reference: `fnv`\n", page),
            [
                "docs/references.md:2: FNV is listed twice",
                "docs/references.md:3: harris1978 is cited nowhere",
            ]
        );
    }
}
