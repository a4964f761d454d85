//! The pages under `docs/` against what they speak of: numbers of the code, keys of sources, links.
#![allow(clippy::unwrap_used)]

use std::fs;
use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|error| format!("{}: {error}", path.display()))
}

/// Every Markdown page below a folder, in a fixed order.
fn pages(folder: &Path) -> Vec<PathBuf> {
    let mut entries: Vec<PathBuf> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .collect();
    entries.sort();
    let mut found = Vec::new();
    for path in entries {
        if path.is_dir() {
            found.extend(pages(&path));
        } else if path.extension().is_some_and(|e| e == "md") {
            found.push(path);
        }
    }
    found
}

/// The value of a constant, or of a field in a list of fields, as its source file spells it.
fn value_in_code<'a>(source: &'a str, name: &str) -> Option<&'a str> {
    source.lines().find_map(|line| {
        let line = line.trim();
        if let Some((head, tail)) = line.split_once(" = ")
            && let Some((declared, _)) = head.split_once(": ")
            && declared.ends_with(&format!("const {name}"))
        {
            return tail.strip_suffix(';');
        }
        line.strip_prefix(&format!("{name}: "))?.strip_suffix(',')
    })
}

#[test]
fn verify_values_are_read_from_code() {
    let source = "/// EARNS: 5.0,\npub(crate) const EARNS: f64 = 6.0;\n    accuracy: 5e-4,\n";
    assert_eq!(value_in_code(source, "EARNS"), Some("6.0"));
    assert_eq!(value_in_code(source, "accuracy"), Some("5e-4"));
    assert_eq!(value_in_code(source, "ARNS"), None);
}

#[test]
fn verify_the_thresholds_are_those_of_the_code() {
    let page = read(&root().join("docs/theory/thresholds.md"));
    let mut rows = 0;
    let mut wrong = Vec::new();
    for line in page.lines().filter(|line| line.starts_with("| `")) {
        let ticked: Vec<&str> = line.split('`').skip(1).step_by(2).collect();
        let [name, value, file] = ticked[..3] else {
            continue;
        };
        rows += 1;
        let source = read(&root().join(file));
        let found = value_in_code(&source, name).unwrap_or("nothing of that name");
        if found != value {
            wrong.push(format!(
                "docs/theory/thresholds.md: {name} is {value}, but {file} has {found}: change the \
                 table and the sentences of docs/theory that say the number"
            ));
        }
    }
    assert!(rows >= 30, "{rows} rows");
    let (decide, _) = page.split_once("\n## ").unwrap();
    let deciding = decide
        .lines()
        .filter(|line| line.starts_with("| `"))
        .count();
    assert!(
        (10..=25).contains(&deciding),
        "{deciding} numbers decide, 25 at the most"
    );
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}

/// A name and a year, as `docs/references.md` spells its keys.
fn is_key(word: &str) -> bool {
    let name = word.trim_end_matches(|c: char| c.is_ascii_digit());
    word.len() == name.len() + 4
        && name.len() >= 3
        && name.chars().all(|c| c.is_ascii_lowercase() || c == '-')
}

#[test]
fn verify_the_sources_of_the_theory_resolve() {
    let references = read(&root().join("docs/references.md"));
    let mut cited = 0;
    for page in pages(&root().join("docs/theory")) {
        let text = read(&page);
        for key in text.split('`').skip(1).step_by(2).filter(|w| is_key(w)) {
            cited += 1;
            assert!(
                references.contains(&format!("- `{key}`")),
                "{}: {key} is not in docs/references.md",
                page.display()
            );
        }
    }
    assert!(cited >= 8, "{cited} citations");
}

/// The name by which a heading is linked to.
fn anchor(heading: &str) -> String {
    let kept = heading.to_lowercase();
    let kept = kept.trim_start_matches('#').trim().chars();
    kept.filter(|c| c.is_alphanumeric() || matches!(c, ' ' | '-' | '_'))
        .map(|c| if c == ' ' { '-' } else { c })
        .collect()
}

/// What the links of a page lead to, code blocks aside.
fn links(text: &str) -> Vec<&str> {
    let mut found = Vec::new();
    for (i, block) in text.split("```").enumerate() {
        if i % 2 == 0 {
            let targets = block.split("](").skip(1);
            found.extend(targets.filter_map(|rest| rest.split_once(')').map(|(target, _)| target)));
        }
    }
    found
}

/// The tables of ln Z on the page are those that the test of `inference` makes.
#[test]
fn verify_the_tables_of_log_marginal_likelihoods_are_those_of_the_test() {
    let page = read(&root().join("docs/theory/inference.md"));
    let folder = root().join("crates/inference/tests/val_nested_sampling/snapshots");
    for name in ["ten_sets", "beyond_a_quadratic", "many_peaks"] {
        let file = read(&folder.join(format!("val_nested_sampling__{name}.snap")));
        let table = file.splitn(3, "---\n").nth(2).unwrap_or(&file).trim();
        assert!(
            page.contains(table),
            "{name}: the page does not show\n{table}"
        );
    }
}

#[test]
fn verify_the_links_of_the_pages_lead_somewhere() {
    let mut all = pages(&root().join("docs"));
    all.push(root().join("README.md"));
    let (mut count, mut broken) = (0, Vec::new());
    for page in &all {
        let text = read(page);
        for target in links(&text) {
            if target.starts_with("http") {
                continue;
            }
            count += 1;
            let (path, heading) = target.split_once('#').unwrap_or((target, ""));
            let file = match path {
                "" => page.clone(),
                _ => page.parent().unwrap().join(path),
            };
            let headed = |text: &str| {
                let mut lines = text.lines().filter(|line| line.starts_with('#'));
                lines.any(|line| anchor(line) == heading)
            };
            if !file.exists() || !(heading.is_empty() || headed(&read(&file))) {
                broken.push(format!("{}: {target}", page.display()));
            }
        }
    }
    assert!(count >= 60, "{count} links");
    assert!(broken.is_empty(), "\n{}", broken.join("\n"));
}

#[test]
fn verify_the_records_of_the_tutorial_are_what_the_command_makes() {
    let differences = xtask::tutorial_records::differences().unwrap();
    assert!(differences.is_empty(), "\n{}", differences.join("\n"));
}

/// The contract and the Python module name every kind of input and output that a model file may have.
#[test]
fn verify_every_kind_of_input_and_output_is_in_the_contract() {
    use simgap_model::{InputKind, OutputKind};
    let contract = read(&root().join("docs/contract.md"));
    let builder = read(&root().join("crates/python/python/simgap/_model.py"));
    let inputs = InputKind::ALL.map(InputKind::name);
    let outputs = OutputKind::ALL.map(OutputKind::name);
    for kind in inputs.iter().chain(&outputs) {
        let is_word = |text: &str| {
            text.split(|c: char| !(c.is_alphanumeric() || c == '_'))
                .any(|word| word == *kind)
        };
        assert!(is_word(&contract), "docs/contract.md: {kind}");
        assert!(is_word(&builder), "_model.py: {kind}");
    }
}
