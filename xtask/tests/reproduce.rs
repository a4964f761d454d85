//! The reproduction of the paper: golden values, and what `--check` sees.
#![allow(clippy::unwrap_used)]

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use xtask::reproduce::{
    Block, Comparison, Context, Outcome, Page, Verdict, check_files, generate, pages, write_files,
};

/// Generated once for all tests.
static FILES: LazyLock<BTreeMap<String, String>> = LazyLock::new(|| generate().unwrap());

/// Computed a second time, for all tests.
static PAGES: LazyLock<Vec<Page>> = LazyLock::new(|| pages().unwrap());

fn fresh(name: &str) -> PathBuf {
    let root = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    if root.exists() {
        fs::remove_dir_all(&root).unwrap();
    }
    fs::create_dir_all(&root).unwrap();
    root
}

/// Every number of every page, as JSON: a change of any computed value shows here.
#[test]
fn regress_pages() {
    for page in PAGES.iter() {
        insta::assert_json_snapshot!(page.stem, page.json());
    }
}

/// The one number for Table 4, from the committed code, to three digits.
#[test]
fn val_park_one_timing_error() {
    let timing = Context::new().unwrap().timing;
    assert_eq!(format!("{:.3}", 1e3 * timing.value), "0.617");
    assert_eq!(format!("{:.3}", timing.r_squared), "0.994");
    assert_eq!(format!("{:.3}", timing.worst_relative_error), "0.063");
}

/// What is committed is what the committed code generates.
#[test]
fn verify_committed_files_are_as_generated() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let outcome = check_files(&root, &FILES).unwrap();
    assert!(
        outcome.is_clean(),
        "{outcome}\nrun `cargo xtask reproduce-paper`"
    );
}

#[test]
fn verify_generation_is_deterministic() {
    for page in PAGES.iter() {
        for (name, text) in page.files().unwrap() {
            assert!(FILES[&name] == text, "{name}");
        }
    }
}

/// Published numbers are never rewritten by a tool.
#[test]
fn verify_only_generated_directories_are_written() {
    for name in FILES.keys() {
        let allowed =
            name.starts_with("docs/reproduction/") || name.starts_with("fixtures/reproduction/");
        assert!(allowed, "{name}");
    }
}

#[test]
fn verify_every_page_says_that_the_data_is_rebuilt() {
    for (name, text) in FILES.iter() {
        if !name.ends_with(".svg") {
            assert!(text.contains("rebuilt from them, not measured"), "{name}");
        }
    }
}

/// Every picture a page shows is generated, and every generated picture is shown.
#[test]
fn verify_pictures_and_pages_agree() {
    let mut shown: Vec<String> = Vec::new();
    for page in PAGES.iter() {
        for block in &page.blocks {
            if let Block::Figure(name, caption, _) = block {
                assert!(!caption.is_empty());
                shown.push(format!("docs/reproduction/{name}.svg"));
            }
        }
    }
    shown.sort();
    let drawn: Vec<String> = FILES
        .keys()
        .filter(|name| name.ends_with(".svg"))
        .cloned()
        .collect();
    assert_eq!(shown, drawn);
}

#[test]
fn verify_check_names_what_differs() {
    let root = fresh("check");
    let count = FILES.len();
    assert_eq!(write_files(&root, &FILES).unwrap(), Outcome::Written(count));
    assert_eq!(check_files(&root, &FILES).unwrap(), Outcome::Same(count));

    let changed = root.join("fixtures/reproduction/table4.txt");
    let text = fs::read_to_string(&changed).unwrap();
    let (head, tail) = text.split_once("75236.49").unwrap();
    let line = 1 + head.matches('\n').count();
    fs::write(&changed, format!("{head}75236.48{tail}")).unwrap();
    fs::remove_file(root.join("docs/reproduction/fig15.svg")).unwrap();
    fs::write(root.join("docs/reproduction/fig99.svg"), "").unwrap();
    let outcome = check_files(&root, &FILES).unwrap();
    assert!(!outcome.is_clean());
    assert_eq!(
        outcome,
        Outcome::Differs(vec![
            "docs/reproduction/fig15.svg: missing".to_owned(),
            format!("fixtures/reproduction/table4.txt: differs from line {line} on"),
            "docs/reproduction/fig99.svg: not generated".to_owned(),
        ])
    );

    write_files(&root, &FILES).unwrap();
    assert_eq!(check_files(&root, &FILES).unwrap(), Outcome::Same(count));
    assert!(!root.join("docs/reproduction/fig99.svg").exists());
}

#[test]
fn verify_verdicts() {
    let verdict = |printed: &str, ours: f64, tolerance: f64| {
        let published = printed.replace(',', "").parse().unwrap();
        Comparison {
            item: String::new(),
            unit: "N",
            printed: printed.to_owned(),
            published,
            ours,
            tolerance,
        }
        .verdict()
    };
    assert_eq!(verdict("2.499", 2.4994, 0.0), Verdict::Reproduced);
    assert_eq!(verdict("2.499", 2.4996, 0.001), Verdict::WithinTolerance);
    assert_eq!(verdict("2.499", 2.5222, 0.005), Verdict::NotReproducible);
    assert_eq!(verdict("8,287,639", 8_287_639.4, 0.0), Verdict::Reproduced);
    assert_eq!(verdict("33", f64::NAN, 1e9), Verdict::NotReproducible);
}
