//! The reproduction of the paper: golden values, and what `--check` sees.
#![allow(clippy::unwrap_used)]

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use simgap_mold::TwoDof;
use xtask::reproduce::{
    Block, Comparison, Context, Outcome, Page, Verdict, check_files, generate, pages, write_files,
};

mod golden;
mod mutations;

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

/// One test for each page: every number of every table, every sentence and every caption.
macro_rules! regress_page {
    ($($test:ident: $stem:literal),+ $(,)?) => {
        /// The pages held by a snapshot.
        const HELD: &[&str] = &[$($stem),+];
        $(
            #[test]
            fn $test() {
                let page = PAGES.iter().find(|page| page.stem == $stem).unwrap();
                insta::assert_json_snapshot!($stem, page.json());
            }
        )+
    };
}

regress_page! {
    regress_page_table1: "table1",
    regress_page_table2: "table2",
    regress_page_table3: "table3",
    regress_page_table4: "table4",
    regress_page_table5: "table5",
    regress_page_peaks: "peaks",
    regress_page_readings: "readings",
    regress_page_diagnosed: "diagnosed",
    regress_page_differentiators: "differentiators",
    regress_page_figures: "figures",
    regress_page_machine: "machine",
    regress_page_sweep: "sweep",
    regress_page_claims: "claims",
}

#[test]
fn verify_every_page_is_held() {
    let stems: Vec<&str> = PAGES.iter().map(|page| page.stem).collect();
    let mut held = HELD.to_vec();
    held.sort_unstable();
    let mut sorted = stems.clone();
    sorted.sort_unstable();
    assert_eq!(held, sorted);
}

/// Rows of a table of a page, by the start of its title.
fn rows(stem: &str, title: &str) -> Vec<serde_json::Value> {
    let page = PAGES.iter().find(|page| page.stem == stem).unwrap().json();
    let tables = page["tables"].as_array().unwrap().clone();
    let table = tables
        .iter()
        .find(|table| table["title"].as_str().unwrap().starts_with(title))
        .unwrap();
    table["rows"].as_array().unwrap().clone()
}

/// Every line of the page of peaks, in frequency, height and phase, is the one that follows in closed form from what the
/// records and models were built of.
fn peaks_off(page: &serde_json::Value) -> [Vec<String>; 4] {
    let context = Context::new().unwrap();
    let published = |freq: f64| TwoDof::published(freq).unwrap();
    let base = context.stated.image_base.si();
    let restored = |freq: f64| published(freq).restored(base - freq, base + freq).unwrap();
    [
        (
            "Table 2, displacement",
            golden::displacement(&context),
            golden::DISPLACEMENT,
        ),
        (
            "Table 2, pressure",
            golden::pressure(&context),
            golden::PRESSURE,
        ),
        (
            "Lines of m₁, stiffnesses as printed",
            golden::motion(&context, published),
            golden::MOTION,
        ),
        (
            "Lines of m₁, restored",
            golden::motion(&context, restored),
            golden::MOTION,
        ),
    ]
    .map(|(title, expected, tolerance)| {
        let found = golden::found(page, title);
        assert!(found.len() >= 18, "{title}: {} lines", found.len());
        golden::off(&found, &expected, tolerance)
    })
}

#[test]
fn verify_every_peak_against_closed_forms() {
    let page = PAGES.iter().find(|page| page.stem == "peaks").unwrap();
    let off = peaks_off(&page.json());
    assert!(off.iter().all(Vec::is_empty), "{off:#?}");
}

/// All 91 printed lines of both channels of Table 2 stand on the page, and all are found.
#[test]
fn val_park_table2_both_channels() {
    for (channel, count) in [("pressure", 42), ("displacement", 49)] {
        let rows = rows("peaks", &format!("Table 2, {channel}"));
        let printed = rows.iter().filter(|row| row["printed [Hz]"].is_number());
        let verdicts: Vec<&str> = printed
            .map(|row| row["verdict"].as_str().unwrap())
            .collect();
        assert_eq!(verdicts, vec!["reproduced"; count], "{channel}");
    }
}

/// Fig. 15 for all six rows: the restored model has the lines stated, the printed one misses them by more than
/// what they are printed to.
#[test]
fn val_park_fig15_all_rows() {
    for (set, wanted) in [
        ("restored stiffnesses", "reproduced"),
        ("stiffnesses as printed", "not reproducible"),
    ] {
        let rows = rows("peaks", &format!("Fig. 15 and section 3.2, {set}"));
        assert_eq!(rows.len(), 12, "{set}");
        for row in rows {
            assert_eq!(row["verdict"], wanted, "{row}");
        }
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
