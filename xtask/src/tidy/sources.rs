//! Rules on the sources: what is absent from them.

use super::text::{code_lines, grouped_std_imports, has_word};
use super::{Finding, Source, Workspace};

/// Programs: they print, and know what time it is. `python` is one too: it ends work by a budget of seconds.
const PROGRAMS: [&str; 3] = ["cli", "python", "xtask"];

/// Who reads and writes files. `record` for everybody else: tables of numbers, and text put in
/// place in one step. `report` makes pages in memory; `app` writes them for the program and for Python, `fleet` the table.
const TOUCH_FILES: [&str; 5] = ["record", "app", "fleet", "cli", "xtask"];

/// What prints, what reads a clock, what opens a socket.
const LOUD: [(&str, &str); 13] = [
    ("println!", "a library does not print"),
    ("print!", "a library does not print"),
    ("eprintln!", "a library does not print"),
    ("eprint!", "a library does not print"),
    ("dbg!", "a library does not print"),
    ("stdout", "a library does not print"),
    ("stderr", "a library does not print"),
    ("Instant::now", "a library reads no clock"),
    ("SystemTime", "a library reads no clock"),
    ("UNIX_EPOCH", "a library reads no clock"),
    ("std::net", "a library opens no socket"),
    ("TcpStream", "a library opens no socket"),
    ("UdpSocket", "a library opens no socket"),
];

/// What reads or writes a file.
const FILE_ACCESS: [&str; 5] = [
    "std::fs",
    "fs::",
    "File::open",
    "File::create",
    "OpenOptions",
];

/// Longest file of a crate, tests inside it included.
const MOST_LINES: usize = 450;

/// Files that are longer for now, with the length they must not exceed.
const LONGER: [(&str, usize); 0] = [];

/// Whether a line of code names something: a word, or a path or macro that ends in no word.
fn names(code: &str, token: &str) -> bool {
    if token.ends_with(|c: char| c.is_alphanumeric()) {
        return has_word(code, token);
    }
    let part_of_name = |c: char| c.is_alphanumeric() || c == '_';
    code.match_indices(token)
        .any(|(at, _)| !code[..at].chars().next_back().is_some_and(part_of_name))
}

/// Every use of a token in the code of a file, grouped imports of std included.
fn uses(source: &Source, token: &str) -> Vec<usize> {
    let lines = code_lines(&source.text);
    let imports = grouped_std_imports(&lines);
    let plain = lines.iter().filter(|(_, code)| names(code, token));
    let grouped = imports.iter().filter(|(_, path)| names(path, token));
    plain
        .map(|(line, _)| *line)
        .chain(grouped.map(|(line, _)| *line))
        .collect()
}

/// Libraries never print, read no clock and open no socket.
#[must_use]
pub fn libraries_are_silent_and_still(workspace: &Workspace) -> Vec<Finding> {
    let mut findings = Vec::new();
    let libraries = workspace
        .sources
        .iter()
        .filter(|source| source.is_shipped() && !PROGRAMS.contains(&source.folder()));
    for source in libraries {
        for (token, reason) in LOUD {
            for line in uses(source, token) {
                findings.push(Finding::in_source(
                    source,
                    line,
                    format!("{token}: {reason}"),
                ));
            }
        }
    }
    findings
}

/// Only `record`, `app`, `fleet`, `cli` and `xtask` touch files.
#[must_use]
pub fn who_may_touch_files(workspace: &Workspace) -> Vec<Finding> {
    let mut findings = Vec::new();
    let others = workspace
        .sources
        .iter()
        .filter(|source| source.is_shipped() && !TOUCH_FILES.contains(&source.folder()));
    for source in others {
        for token in FILE_ACCESS {
            for line in uses(source, token) {
                let who = TOUCH_FILES.join(", ");
                let message = format!("{token}: only {who} touch files");
                findings.push(Finding::in_source(source, line, message));
            }
        }
    }
    findings
}

/// `integrate` knows no effect by name, in code, comments or tests.
#[must_use]
pub fn integrators_know_no_effect(workspace: &Workspace) -> Vec<Finding> {
    let mut findings = Vec::new();
    for source in &workspace.sources {
        if source.folder() != "integrate" {
            continue;
        }
        for (index, line) in source.text.lines().enumerate() {
            for kind in &workspace.kinds {
                if has_word(line, kind) {
                    let message = format!("{kind}: integrate knows no effect by name");
                    findings.push(Finding::in_source(source, index + 1, message));
                }
            }
        }
    }
    findings
}

/// The published numbers are embedded when `tables` is built; no other code forms a path to
/// them, so that none can write there. A mention in backticks is prose.
#[must_use]
pub fn published_numbers_are_only_embedded(workspace: &Workspace) -> Vec<Finding> {
    // Not written out, so that this file does not name the path itself.
    let path = concat!("crates/tables/fix", "tures");
    let prose = format!("`{path}");
    let folder = concat!("\"fix", "tures\"");
    let mut findings = Vec::new();
    for source in workspace
        .sources
        .iter()
        .filter(|source| source.is_shipped())
    {
        for (line, code) in code_lines(&source.text) {
            let embeds = source.folder() == "tables" && code.contains("include_str!(");
            let forms = code.replace(&prose, "").contains(path) || code.contains(folder);
            if forms && !embeds {
                let message = format!("{path} may only be embedded, by tables");
                findings.push(Finding::in_source(source, line, message));
            }
        }
    }
    findings
}

/// No unsafe code, tests and benches included.
#[must_use]
pub fn nothing_is_unsafe(workspace: &Workspace) -> Vec<Finding> {
    let mut findings = Vec::new();
    // Not written out, so that this file passes its own rule.
    let word = ["un", "safe"].concat();
    for source in &workspace.sources {
        for (line, code) in code_lines(&source.text) {
            if has_word(code, &word) && !code.contains('"') {
                findings.push(Finding::in_source(
                    source,
                    line,
                    format!("{word} code is forbidden"),
                ));
            }
        }
    }
    findings
}

/// Files of the crates stay short enough to be read in one go.
#[must_use]
pub fn files_are_short(workspace: &Workspace) -> Vec<Finding> {
    let mut findings = Vec::new();
    for source in &workspace.sources {
        if !(source.is_shipped() && source.path.starts_with("crates/")) {
            continue;
        }
        let longer = LONGER.iter().find(|(path, _)| *path == source.path);
        let most = longer.map_or(MOST_LINES, |(_, most)| *most);
        let found = source.text.lines().count();
        if found > most {
            let message = format!("{found} lines, needed is {most} at most: one idea a file");
            findings.push(Finding::in_source(source, most + 1, message));
        }
    }
    findings
}

#[cfg(test)]
mod tests {
    use super::*;

    fn workspace(path: &str, text: &str) -> Workspace {
        Workspace {
            sources: vec![Source {
                path: path.to_owned(),
                text: text.to_owned(),
            }],
            kinds: vec!["coulomb_friction".to_owned()],
            ..Workspace::default()
        }
    }

    fn lines(rule: super::super::Rule, path: &str, text: &str) -> Vec<usize> {
        let findings = rule(&workspace(path, text));
        assert!(findings.iter().all(|finding| finding.file == path));
        findings.iter().map(|finding| finding.line).collect()
    }

    const NONE: [usize; 0] = [];

    #[test]
    fn verify_a_library_that_prints_or_reads_a_clock_is_found() {
        let rule = libraries_are_silent_and_still;
        for (token, _) in LOUD {
            let text = format!("//! {token}\nfn f() {{\n    {token}();\n}}\n");
            assert!(
                lines(rule, "crates/model/src/a.rs", &text).contains(&3),
                "{token}"
            );
            assert_eq!(lines(rule, "crates/cli/src/a.rs", &text), NONE);
            assert_eq!(lines(rule, "crates/model/tests/a.rs", &text), NONE);
        }
        assert_eq!(
            lines(rule, "crates/model/src/a.rs", "use std::{fmt, net};\n"),
            [1]
        );
        assert_eq!(
            lines(rule, "crates/model/src/a.rs", "Instant::new(0);\n"),
            NONE
        );
        assert_eq!(lines(rule, "crates/model/src/a.rs", "my_print!();\n"), NONE);
    }

    #[test]
    fn verify_a_library_that_touches_files_is_found() {
        let rule = who_may_touch_files;
        for text in [
            "use std::fs;\n",
            "use std::{fs::File, fmt};\n",
            "File::open(p)?;\n",
        ] {
            assert!(
                !lines(rule, "crates/report/src/a.rs", text).is_empty(),
                "{text}"
            );
            assert_eq!(lines(rule, "crates/record/src/a.rs", text), NONE);
            assert_eq!(lines(rule, "crates/report/examples/a.rs", text), NONE);
        }
        assert_eq!(
            lines(rule, "crates/report/src/a.rs", "let offs = 1;\n"),
            NONE
        );
    }

    #[test]
    fn verify_an_integrator_that_names_an_effect_is_found() {
        let rule = integrators_know_no_effect;
        let text = "// a\n// as coulomb_friction does\n";
        assert_eq!(lines(rule, "crates/integrate/src/a.rs", text), [2]);
        assert_eq!(lines(rule, "crates/simulate/src/a.rs", text), NONE);
        let text = "fn verify_sliding_with_coulomb_friction() {}\n";
        assert_eq!(lines(rule, "crates/integrate/tests/a.rs", text), NONE);
    }

    #[test]
    fn verify_code_that_could_write_published_numbers_is_found() {
        let rule = published_numbers_are_only_embedded;
        let path = ["crates/tables", "fixtures"].join("/");
        let text = format!("fs::write(\"{path}/table1.toml\", x);\n");
        assert_eq!(lines(rule, "xtask/src/a.rs", &text), [1]);
        let text = format!("root.join(\"{}\").join(\"paper\")\n", "fixtures");
        assert_eq!(lines(rule, "xtask/src/a.rs", &text), [1]);
        let text = format!("const T: &str = include_str!(\"../{path}/table1.toml\");\n");
        assert_eq!(lines(rule, "crates/tables/src/a.rs", &text), NONE);
        assert_eq!(lines(rule, "crates/mold/src/a.rs", &text), [1]);
        let text = format!("    numbers stand in `{path}/` \\\n");
        assert_eq!(lines(rule, "xtask/src/a.rs", &text), NONE);
    }

    #[test]
    fn verify_unsafe_code_is_found() {
        let text = format!(
            "#![forbid({}_code)]\n{0} {{ f() }}\n",
            ["un", "safe"].concat()
        );
        assert_eq!(
            lines(nothing_is_unsafe, "crates/model/tests/a.rs", &text),
            [2]
        );
    }

    #[test]
    fn verify_long_files_are_found() {
        let text = "//\n".repeat(MOST_LINES);
        assert_eq!(lines(files_are_short, "crates/model/src/a.rs", &text), NONE);
        let text = "//\n".repeat(MOST_LINES + 1);
        assert_eq!(
            lines(files_are_short, "crates/model/src/a.rs", &text),
            [MOST_LINES + 1]
        );
        assert_eq!(
            lines(files_are_short, "crates/model/tests/a.rs", &text),
            NONE
        );
    }
}
