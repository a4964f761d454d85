//! A campaign as it is run: processes, seals, scores.
#![allow(clippy::unwrap_used, clippy::panic)]

use std::path::Path;
use std::sync::Mutex;

use clap::Parser;
use simgap_blind::{Role, foreign_effects};
use simgap_effects::catalogue;
use xtask::blind_check::{Args, Report, run};

#[derive(Parser)]
struct Cli {
    #[command(flatten)]
    args: Args,
}

fn args(words: &[&str]) -> Args {
    Cli::parse_from([&["blind-check"], words].concat()).args
}

fn program() -> &'static Path {
    Path::new(env!("CARGO_BIN_EXE_xtask"))
}

fn quiet(args: &Args) -> Report {
    run(args, program(), &|_| ()).unwrap()
}

/// The report but for how long it took.
fn timeless(report: &Report) -> String {
    let lines = report.text.lines();
    lines
        .filter(|line| !line.starts_with("One diagnosis"))
        .map(|line| line.split("; status").next().unwrap_or(line))
        .collect::<Vec<_>>()
        .join("\n")
}

#[test]
fn verify_the_report_does_not_depend_on_the_jobs() {
    let words = [
        "--cases",
        "2",
        "--seed",
        "3",
        "--kinds",
        "sensor_bias,noise",
        "--details",
    ];
    let one = quiet(&args(&[&words[..], &["--jobs", "1"]].concat()));
    let three = quiet(&args(&[&words[..], &["--jobs", "3"]].concat()));
    assert_eq!(timeless(&one), timeless(&three));
    assert_eq!(one.digest, three.digest);
    assert!(one.text.contains("sensor_bias (single)"), "{}", one.text);
    assert!(one.text.contains("noise only (clean)"), "{}", one.text);
}

#[test]
fn verify_the_digest_is_told_before_anything_is_diagnosed() {
    let told = Mutex::new(vec![]);
    let words = ["--cases", "1", "--seed", "4", "--kinds", "noise"];
    let report = run(&args(&words), program(), &|line| {
        told.lock().unwrap().push(line.to_string());
    });
    let told = told.into_inner().unwrap();
    assert!(told[0].ends_with(&report.unwrap().digest), "{told:?}");
    assert!(told[1].starts_with("case-0000: diagnosed in"), "{told:?}");
}

#[test]
fn verify_the_folder_of_a_case_gives_nothing_away() {
    let keep = tempfile::tempdir().unwrap();
    let folder = keep.path().to_str().unwrap();
    let foreign = foreign_effects()[0].kind();
    let kinds = format!("coulomb_friction,{foreign}");
    let words = [
        "--cases", "2", "--seed", "6", "--kinds", &kinds, "--keep", folder,
    ];
    quiet(&args(&words));
    let mut files = vec![];
    for case in ["case-0000", "case-0001"] {
        for file in std::fs::read_dir(keep.path().join("cases").join(case)).unwrap() {
            let path = file.unwrap().path();
            let text = std::fs::read_to_string(&path).unwrap();
            let kinds = catalogue().iter().map(|effect| effect.kind());
            for kind in kinds.chain([foreign]) {
                assert!(!text.contains(kind), "{}: {kind}", path.display());
            }
            files.push(path.file_name().unwrap().to_str().unwrap().to_string());
        }
    }
    files.sort();
    let each = ["a.csv", "b.csv", "c.csv", "model.toml"];
    assert_eq!(files, each.map(|file| [file, file]).concat());
    let truths = std::fs::read_to_string(keep.path().join("truths.jsonl")).unwrap();
    assert!(truths.contains("coulomb_friction") && truths.contains(foreign));
}

#[test]
fn verify_a_withheld_kind_is_scored_as_unknowable() {
    let words = ["--cases", "0", "--seed", "7", "--withhold", "sensor_bias"];
    let report = quiet(&args(&words));
    let [score] = &report.scores[..] else {
        panic!("{}", report.text);
    };
    assert_eq!(score.role, Role::Withheld);
    assert_eq!(score.verdicts[0].kind, "sensor_bias");
    assert_ne!(score.verdicts[0].said, "sensor_bias");
}

#[test]
fn verify_a_worker_that_fails_is_a_failed_case() {
    // Any program that knows no such task.
    let words = [
        "--cases",
        "1",
        "--seed",
        "3",
        "--kinds",
        "noise",
        "--check-thresholds",
    ];
    let report = run(&args(&words), &std::env::current_exe().unwrap(), &|_| ()).unwrap();
    assert_eq!(report.faults, ["1 cases could not be diagnosed"]);
    assert!(report.text.contains("failed: "), "{}", report.text);
}

#[test]
fn verify_an_unknown_kind_is_refused() {
    for words in [["--kinds", "gremlins"], ["--withhold", "gremlins"]] {
        let error = run(&args(&words), program(), &|_| ()).unwrap_err();
        assert!(
            error
                .to_string()
                .starts_with("recipe \"gremlins\": unknown kind")
        );
    }
}
