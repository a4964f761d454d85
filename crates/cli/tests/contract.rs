//! What `docs/contract.md` promises of a diagnosis, checked on the embedded demo.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use std::sync::OnceLock;

use serde_json::Value;

use crate::common::schema::{check_schema, list, names, number, string};
use crate::common::{Bench, columns, rms, std_dev};

/// The demo, written and diagnosed once for all tests of this file.
fn demo() -> &'static Demo {
    static DEMO: OnceLock<Demo> = OnceLock::new();
    DEMO.get_or_init(|| {
        let bench = Bench::new();
        let stdout = bench.done(&["demo", "--out", "."]);
        Demo { bench, stdout }
    })
}

struct Demo {
    bench: Bench,
    stdout: String,
}

impl Demo {
    fn json(&self) -> Value {
        serde_json::from_str(&self.bench.read("diagnosis/diagnosis.json")).unwrap()
    }
}

#[test]
fn verify_the_files_of_a_result() {
    let written = names(&demo().bench, "diagnosis");
    let (pictures, others): (Vec<String>, Vec<String>) = written
        .into_iter()
        .partition(|name| name.starts_with("pictures/"));
    assert_eq!(
        others,
        [
            ".simgap-files.json",
            "corrected.toml",
            "diagnosis.json",
            "pictures",
            "predictions",
            "predictions/check.csv",
            "report.html"
        ]
    );
    for name in [
        "gap",
        "motion",
        "discrepancy",
        "spectrum",
        "share-places",
        "ranking",
    ] {
        let [svg, csv] = ["svg", "csv"].map(|end| format!("pictures/{name}.{end}"));
        assert!(
            pictures.contains(&svg) && pictures.contains(&csv),
            "{pictures:?}"
        );
        let (svg, csv) = (
            demo().bench.read(&format!("diagnosis/{svg}")),
            demo().bench.read(&format!("diagnosis/{csv}")),
        );
        assert!(
            svg.starts_with("<svg xmlns") && csv.lines().count() > 1,
            "{name}"
        );
    }
    assert_eq!(
        pictures.len() % 2,
        0,
        "a drawing and its data each: {pictures:?}"
    );
}

#[test]
fn verify_every_key_of_the_diagnosis() {
    check_schema(&demo().json());
}

#[test]
fn verify_the_answer_of_the_demo() {
    let json = demo().json();
    assert_eq!(json["verdict"]["status"], "effect");
    let mut named: Vec<String> = list(&json["verdict"]["effects"])
        .iter()
        .map(|effect| format!("{} {}", string(&effect["kind"]), effect["at"]))
        .collect();
    named.sort();
    assert_eq!(
        named,
        [
            r#"alternating_timing {"channel":"y"}"#,
            r#"coulomb_friction {"between":["mold","ground"]}"#
        ]
    );
    assert!(number(&json["gap"]["closed"]) > 0.9);
}

/// The figures of the gap are those of the predictions that lie beside them.
#[test]
fn verify_the_gap_is_that_of_the_predictions() {
    /// The figures and the columns are made by the same sums in another order.
    const ROUNDING: f64 = 1e-9;
    let demo = demo();
    let (_, cells) = columns(&demo.bench.read("diagnosis/predictions/check.csv"));
    let gap = &demo.json()["gap"];
    for (column, key) in [(2, "nominal"), (3, "corrected")] {
        let discrepancy = cells[1].iter().zip(&cells[column]).map(|(m, p)| m - p);
        let nrmse = rms(discrepancy) / std_dev(&cells[1]);
        for figure in [&gap[key], &gap["channels"][0][key]] {
            let off = (nrmse / number(figure) - 1.0).abs();
            assert!(off < ROUNDING, "{key}: {nrmse} here, {figure} there");
        }
    }
    let [nominal, corrected, floor] =
        ["nominal", "corrected", "noise_floor"].map(|k| number(&gap[k]));
    let left = (corrected.powi(2) - floor.powi(2)).max(0.0);
    let there = nominal.powi(2) - floor.powi(2);
    let closed = 1.0 - (left / there).sqrt();
    assert!((closed - number(&gap["closed"])).abs() < ROUNDING);
}

#[test]
fn verify_predictions_stand_on_the_record_s_own_stamps() {
    let demo = demo();
    let (header, cells) = columns(&demo.bench.read("diagnosis/predictions/check.csv"));
    assert_eq!(
        header,
        [
            "t [s]",
            "y measured [m]",
            "y nominal [m]",
            "y corrected [m]"
        ]
    );
    let (_, record) = columns(&demo.bench.read("check.csv"));
    assert_eq!(cells[0], record[0], "time stamps");
    assert_eq!(cells[1], record[2], "measured");
}

/// The corrected model is the one that made the corrected predictions.
#[test]
fn verify_the_corrected_model_simulates_the_corrected_predictions() {
    // Both fit the initial state of the record with the same model, but one counts the effects as
    // given and steps as finely as that corrected model asks for, the other as the nominal model
    // does. Both stop when the log-likelihood gains less than 0.02: a thousandth of the spread of
    // the discrepancy, which is 4e-3 of the motion here.
    const SAME: f64 = 1e-4;
    let demo = demo();
    let args = [
        "simulate",
        "diagnosis/corrected.toml",
        "--record",
        "check.csv",
    ];
    demo.bench
        .done(&[&args[..], &["--out", "again.csv"]].concat());
    let (header, again) = columns(&demo.bench.read("again.csv"));
    assert_eq!(header, ["t [s]", "y [m]"]);
    let (_, cells) = columns(&demo.bench.read("diagnosis/predictions/check.csv"));
    assert_eq!(again[0], cells[0]);
    let off = rms(again[1].iter().zip(&cells[3]).map(|(a, b)| a - b)) / std_dev(&cells[1]);
    assert!(off < SAME, "off by {off:e} of the motion");
    let nominal = rms(again[1].iter().zip(&cells[2]).map(|(a, b)| a - b)) / std_dev(&cells[1]);
    assert!(
        nominal > 100.0 * SAME,
        "the nominal model would have passed as well"
    );
}

#[test]
fn verify_no_colour_and_no_progress_off_a_terminal() {
    // That nothing stands on stderr was checked when the demo ran.
    let stdout = &demo().stdout;
    assert!(!stdout.contains(['\u{1b}', '\r']), "{stdout:?}");
    assert!(stdout.contains("gap (nrmse)"), "{stdout}");
    assert!(
        stdout.contains("report: ./diagnosis/report.html"),
        "{stdout}"
    );
}
