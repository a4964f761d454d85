//! Every kind of bad input: exit status 2, one line on stderr that says file, line or column or
//! item, what was found and what is needed, and nothing written.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stderr
)]

use std::fmt::Write as _;
use std::io::Write as _;
use std::process::Stdio;

use crate::common::{self, Bench, MODEL, record};

/// A diagnosis of `A.csv` by `model.toml` into `out`.
const DIAGNOSE: [&str; 6] = ["diagnose", "model.toml", "--train", "A.csv", "--out", "out"];
/// A simulation of the same.
const SIMULATE: [&str; 6] = [
    "simulate",
    "model.toml",
    "--record",
    "A.csv",
    "--out",
    "pred.csv",
];

/// What the commands say of a bench, which must be the same.
fn both(bench: &Bench) -> String {
    let line = bench.refused(&DIAGNOSE);
    assert_eq!(
        bench.refused(&SIMULATE),
        line,
        "simulate says something else"
    );
    line
}

fn of_models(cases: &[(&str, String)]) -> String {
    let mut table = String::new();
    for (case, model) in cases {
        let bench = Bench::good();
        bench.write("model.toml", model);
        let line = without_kinds(&bench, &both(&bench));
        assert!(line.starts_with("model.toml: "), "{case}: no file: {line}");
        writeln!(table, "{case}: {line}").unwrap();
    }
    table
}

fn of_records(cases: &[(&str, String)], say: impl Fn(&Bench) -> String) -> String {
    let mut table = String::new();
    for (case, text) in cases {
        let bench = Bench::good();
        bench.write("A.csv", text);
        let line = say(&bench);
        assert!(line.starts_with("A.csv: "), "{case}: no file: {line}");
        writeln!(table, "{case}: {line}").unwrap();
    }
    table
}

/// The line with the list of all kinds cut out, which grows with the catalogue.
fn without_kinds(bench: &Bench, line: &str) -> String {
    let catalogue = bench.done(&["effects", "--format", "json"]);
    let catalogue: serde_json::Value = serde_json::from_str(&catalogue).unwrap();
    let effects = catalogue["effects"].as_array().unwrap();
    let kinds: Vec<&str> = effects
        .iter()
        .map(|e| e["kind"].as_str().unwrap())
        .collect();
    line.replace(&kinds.join(", "), "[kinds]")
}

fn replaced(from: &str, to: &str) -> String {
    assert!(MODEL.contains(from));
    MODEL.replacen(from, to, 1)
}

/// The good record with one line (counted from 1) replaced.
fn with_line(line: usize, text: &str) -> String {
    let good = record(60);
    let mut lines: Vec<&str> = good.lines().collect();
    lines[line - 1] = text;
    lines.join("\n") + "\n"
}

#[test]
fn verify_the_bench_itself_is_good() {
    let bench = Bench::good();
    bench.done(&DIAGNOSE);
    bench.done(&SIMULATE);
}

#[test]
fn regress_model_files() {
    let effect = |text: &str| format!("{MODEL}\n[[effect]]\n{text}\n");
    let friction = "kind = \"coulomb_friction\"\n";
    let place = "between = [\"block\", \"ground\"]\n";
    let no_output = MODEL.split("[[output]]").next().unwrap().to_string();
    let second = "[[mass]]\nname = \"block\"\nvalue = 1.0\n";
    let cases = [
        ("empty", String::new()),
        ("broken TOML", replaced("value = 2.0", "value = = 2.0")),
        ("text for a number", replaced("2.0", "\"two\"")),
        (
            "unknown key",
            replaced("value = 2.0", "value = 2.0\nwieght = 1.0"),
        ),
        ("missing key", replaced("value = 2.0", "")),
        (
            "unknown table",
            format!("{MODEL}\n[[sprung]]\nname = \"a\"\n"),
        ),
        (
            "force of a law",
            format!(
                "{MODEL}\n[[law]]\nname = \"drag\"\nforce = \"c * w\"\n[[law.parameter]]\nname = \"c\"\nunit = \"N\"\nusual = 1.0\n"
            ),
        ),
        (
            "law of the catalogue",
            format!(
                "{MODEL}\n[[law]]\nname = \"backlash\"\nforce = \"c * v\"\n[[law.parameter]]\nname = \"c\"\nunit = \"N\"\nusual = 1.0\n"
            ),
        ),
        ("wrong schema", replaced("simgap-model/1", "simgap-model/9")),
        (
            "unknown node",
            replaced("[\"block\", \"ground\"]", "[\"blok\", \"ground\"]"),
        ),
        (
            "both ends the same",
            replaced("[\"block\", \"ground\"]", "[\"block\", \"block\"]"),
        ),
        ("negative mass", replaced("2.0", "-2.0")),
        ("no mass at all", replaced("2.0", "0.0")),
        ("not a number", replaced("2.0", "nan")),
        ("infinite stiffness", replaced("800.0", "inf")),
        ("duplicate name", format!("{MODEL}\n{second}")),
        (
            "a mass called ground",
            MODEL.replace("\"block\"", "\"ground\""),
        ),
        (
            "input on no mass",
            replaced("at = \"block\"", "at = \"blok\""),
        ),
        ("no output", no_output),
        (
            "unknown output kind",
            replaced("\"displacement\"", "\"jerk\""),
        ),
        (
            "force output at a mass",
            replaced("\"displacement\"", "\"force\""),
        ),
        ("gain of zero", format!("{MODEL}gain = 0.0\n")),
        (
            "unknown effect",
            effect(&format!("kind = \"gremlins\"\n{place}")),
        ),
        (
            "effect without place",
            effect(&format!("{friction}friction_force_n = 1.0")),
        ),
        (
            "effect with two places",
            effect(&format!(
                "{friction}{place}mass = \"block\"\nfriction_force_n = 1.0"
            )),
        ),
        (
            "effect at the wrong place",
            effect(&format!(
                "{friction}mass = \"block\"\nfriction_force_n = 1.0"
            )),
        ),
        ("missing parameter", effect(&format!("{friction}{place}"))),
        (
            "unknown parameter",
            effect(&format!(
                "{friction}{place}friction_force_n = 1.0\nfriction = 1.0"
            )),
        ),
        (
            "text for a parameter",
            effect(&format!("{friction}{place}friction_force_n = \"some\"")),
        ),
        (
            "parameter out of range",
            effect(&format!("{friction}{place}friction_force_n = -1.0")),
        ),
        (
            "effect between strangers",
            effect(&format!(
                "{friction}between = [\"block\", \"wall\"]\nfriction_force_n = 1.0"
            )),
        ),
    ];
    insta::assert_snapshot!(of_models(&cases));
}

#[test]
fn regress_model_paths() {
    let bench = Bench::good();
    let mut table = String::new();
    let long = vec![b'#'; (16 << 20) + 1];
    bench.write("long.toml", long);
    bench.write("latin.toml", b"name = \"\xe9\"");
    for model in ["none.toml", "", ".", "A.csv", "latin.toml", "long.toml"] {
        let line = bench.refused(&["diagnose", model, "--train", "A.csv", "--out", "out"]);
        writeln!(table, "\"{model}\": {line}").unwrap();
    }
    insta::assert_snapshot!(table);
}

#[test]
fn regress_record_paths() {
    let bench = Bench::good();
    let mut table = String::new();
    let mut say = |option: &str, path: &str| {
        let args = ["diagnose", "model.toml", "--train", "A.csv", "--out", "out"];
        let mut args = args.to_vec();
        if option == "--train" {
            args[3] = path;
        } else {
            args.extend([option, path]);
        }
        writeln!(table, "{option} \"{path}\": {}", bench.refused(&args)).unwrap();
    };
    for path in ["none.csv", ".", "", "A.csv/B.csv"] {
        say("--train", path);
        say("--check", path);
    }
    insta::assert_snapshot!(table);
}

#[test]
fn regress_records() {
    let good = record(60);
    let swapped = |a: usize, b: usize| {
        let mut lines: Vec<&str> = good.lines().collect();
        lines.swap(a - 1, b - 1);
        lines.join("\n")
    };
    let header = |text: &str| with_line(1, text);
    let cases = [
        ("empty file", String::new()),
        ("header only", "t [s],u [N],y [m]\n".to_string()),
        (
            "two rows",
            good.lines().take(3).collect::<Vec<_>>().join("\n"),
        ),
        ("input column missing", header("t [s],v [N],y [m]")),
        ("input in metres", header("t [s],u [m],y [m]")),
        ("output in volts", header("t [s],u [N],y [V]")),
        ("time in metres", header("t [m],u [N],y [m]")),
        ("no unit", header("t [s],u,y [m]")),
        ("the same column twice", header("t [s],y [m],y [m]")),
        ("NaN", with_line(7, "0.05,1.0,NaN")),
        ("infinite", with_line(7, "0.05,inf,0.0")),
        ("text", with_line(7, "0.05,off,0.0")),
        ("empty cell", with_line(7, "0.05,,0.0")),
        ("short row", with_line(7, "0.05,1.0")),
        ("long row", with_line(7, "0.05,1.0,0.0,0.0")),
        ("decimal commas", good.replace('.', ",")),
        ("uneven time", with_line(30, "0.2838,1.0,0.0")),
        (
            "missing row",
            good.lines()
                .enumerate()
                .filter(|(k, _)| *k != 30)
                .map(|(_, l)| format!("{l}\n"))
                .collect(),
        ),
        ("reversed time", swapped(20, 21)),
        ("repeated time", with_line(30, "0.27,1.0,0.0")),
    ];
    insta::assert_snapshot!(of_records(&cases, both));
}

/// What only a diagnosis needs.
#[test]
fn regress_records_to_compare_with() {
    let flat: String = record(60)
        .lines()
        .enumerate()
        .map(|(k, line)| match line.rsplit_once(',') {
            Some((rest, _)) if k > 0 => format!("{rest},0.25\n"),
            _ => format!("{line}\n"),
        })
        .collect();
    let cases = [
        ("output column missing", with_line(1, "t [s],u [N],x [m]")),
        ("flat output", flat),
    ];
    insta::assert_snapshot!(of_records(&cases, |bench| bench.refused(&DIAGNOSE)));
}

#[test]
fn regress_a_check_record_is_read_as_closely() {
    let bench = Bench::good();
    bench.write("C.csv", with_line(9, "0.07,1.0,?"));
    let mut args = DIAGNOSE.to_vec();
    args.extend(["--check", "C.csv"]);
    insta::assert_snapshot!(bench.refused(&args), @"C.csv: line 9: column 'y' holds '?', but a number is needed");
}

/// Rows stream in through a pipe: no file of that size has to be made.
#[test]
fn regress_more_rows_than_the_limit() {
    let bench = Bench::good();
    let args = [
        "simulate",
        "model.toml",
        "--record",
        "/dev/stdin",
        "--out",
        "pred.csv",
    ];
    let mut command = bench.simgap(&args);
    command
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped());
    let mut child = command.spawn().unwrap();
    let mut pipe = child.stdin.take().unwrap();
    let writer = std::thread::spawn(move || {
        let block = "0,0,0\n".repeat(10_000);
        let header = pipe.write_all(b"t [s],u [N],y [m]\n");
        // The reader stops at the limit and closes the pipe: that ends the loop.
        let mut blocks = 0_usize;
        while header.is_ok() && pipe.write_all(block.as_bytes()).is_ok() {
            blocks += 1;
            assert!(blocks < 2_000, "the reader goes on and on");
        }
    });
    let output = child.wait_with_output().unwrap();
    writer.join().unwrap();
    assert_eq!(output.status.code(), Some(2));
    insta::assert_snapshot!(common::text(&output.stderr), @"simgap: /dev/stdin: more than 5000000 rows found, which is the limit; split the record or lower its sample rate");
    assert!(!bench.path("pred.csv").exists());
}

#[test]
fn regress_places_to_write() {
    let bench = Bench::good();
    bench.write("file", "in the way");
    bench.write("full/report.html/inside", "in the way");
    bench.write("odd/predictions", "in the way");
    bench.write("deep/predictions/A.csv/inside", "in the way");
    let mut table = String::new();
    for out in [
        "file",
        "file/below",
        "/proc/simgap/out",
        "full",
        "odd",
        "deep",
        "",
    ] {
        let line = bench.refused(&["diagnose", "model.toml", "--train", "A.csv", "--out", out]);
        writeln!(table, "diagnose --out \"{out}\": {line}").unwrap();
    }
    for out in [
        "full",
        "file/below",
        "/proc/pred.csv",
        "A.csv",
        "./model.toml",
    ] {
        let line = bench.refused(&["simulate", "model.toml", "--record", "A.csv", "--out", out]);
        writeln!(table, "simulate --out \"{out}\": {line}").unwrap();
    }
    let line = bench.refused(&["demo", "--out", "file"]);
    writeln!(table, "demo --out \"file\": {line}").unwrap();
    // The model and a record lie where the results would go.
    let good = |name: &str| std::fs::read_to_string(bench.path(name)).unwrap();
    bench.write("again/corrected.toml", good("model.toml"));
    bench.write("again/predictions/A.csv", good("A.csv"));
    let (model, record) = ("again/corrected.toml", "again/predictions/A.csv");
    for (model, train) in [(model, "A.csv"), ("model.toml", record)] {
        let line = bench.refused(&["diagnose", model, "--train", train, "--out", "again"]);
        writeln!(table, "diagnose {model} --train {train}: {line}").unwrap();
    }
    insta::assert_snapshot!(table);
}

#[test]
fn verify_a_channel_has_one_unit_in_all_records() {
    let bench = Bench::good();
    let record = std::fs::read_to_string(bench.path("A.csv")).unwrap();
    let header = record.lines().next().unwrap();
    let names: Vec<&str> = header.split(',').collect();
    let last = names.last().unwrap();
    let (name, _) = last.split_once(" [").unwrap();
    let turned = header.replace(last, &format!("{name} [deg]"));
    bench.write("B.csv", record.replacen(header, &turned, 1));
    let args = [
        "diagnose",
        "model.toml",
        "--train",
        "A.csv",
        "--train",
        "B.csv",
    ];
    let line = bench.refused(&[&args[..], &["--out", "out"]].concat());
    assert!(line.contains("B.csv: column"), "{line}");
    assert!(line.contains("is in deg, and in"), "{line}");
    assert!(
        line.contains("in A.csv: needed is one unit for all records"),
        "{line}"
    );
}

#[test]
fn verify_a_member_has_two_ends() {
    let bench = Bench::good();
    let model = std::fs::read_to_string(bench.path("model.toml")).unwrap();
    let begin = model.find("between = [").unwrap();
    let end = begin + model[begin..].find(']').unwrap();
    let three = format!("{}, \"ground\"{}", &model[..end], &model[end..]);
    bench.write("three.toml", three);
    let line = bench.refused(&["modes", "three.toml"]);
    assert!(line.contains("invalid length 3"), "{line}");
}

/// Root may write where the mode forbids it, so this says nothing there.
#[cfg(unix)]
#[test]
fn verify_a_folder_without_the_right_to_write() {
    use std::os::unix::fs::PermissionsExt as _;
    let bench = Bench::good();
    std::fs::create_dir(bench.path("locked")).unwrap();
    let mode = |mode| std::fs::Permissions::from_mode(mode);
    std::fs::set_permissions(bench.path("locked"), mode(0o555)).unwrap();
    if std::fs::write(bench.path("locked/probe"), "").is_ok() {
        std::fs::remove_file(bench.path("locked/probe")).unwrap();
        eprintln!("skipped: this user may write anywhere");
        return;
    }
    for out in ["locked", "locked/below"] {
        let line = bench.refused(&["diagnose", "model.toml", "--train", "A.csv", "--out", out]);
        assert!(
            line.contains("locked") && line.contains("cannot be written"),
            "{line}"
        );
    }
    std::fs::set_permissions(bench.path("locked"), mode(0o755)).unwrap();
}

/// A model that grows without bound predicts nothing that a file can hold.
#[test]
fn regress_a_prediction_that_runs_away() {
    let bench = Bench::good();
    bench.write(
        "model.toml",
        replaced("damping = 4.0", "damping = -40000.0"),
    );
    insta::assert_snapshot!(both(&bench));
}

#[test]
fn regress_arguments() {
    let bench = Bench::good();
    bench.write("other/A.csv", record(60));
    let diagnose = |more: &[&str]| {
        let mut args = DIAGNOSE.to_vec();
        args.extend(more);
        bench.refused(&args)
    };
    let mut table = String::new();
    let mut note = |case: &str, line: String| writeln!(table, "{case}: {line}").unwrap();
    note("nothing", bench.refused(&[]));
    note("unknown command", bench.refused(&["diagnoze"]));
    note("diagnose alone", bench.refused(&["diagnose"]));
    note(
        "no --train",
        bench.refused(&["diagnose", "model.toml", "--out", "out"]),
    );
    note(
        "no --out",
        bench.refused(&["diagnose", "model.toml", "--train", "A.csv"]),
    );
    note("--train without a value", diagnose(&["--train"]));
    note("unknown option", diagnose(&["--trian", "A.csv"]));
    note("two models", diagnose(&["model.toml"]));
    note("--out twice", diagnose(&["--out", "elsewhere"]));
    note("--format xml", diagnose(&["--format", "xml"]));
    note("--jobs 0", diagnose(&["--jobs", "0"]));
    note("--jobs 100000", diagnose(&["--jobs", "100000"]));
    note("--jobs two", diagnose(&["--jobs", "two"]));
    note("--jobs -1", diagnose(&["--jobs=-1"]));
    note("--seed 1.5", diagnose(&["--seed", "1.5"]));
    let line = diagnose(&["--withhold", "gremlins"]);
    note("--withhold gremlins", without_kinds(&bench, &line));
    note(
        "the same stem twice in --check",
        diagnose(&["--check", "A.csv", "--check", "other/A.csv"]),
    );
    note(
        "the same stem twice in --train, without --check",
        diagnose(&["--train", "other/A.csv"]),
    );
    note(
        "simulate without --record",
        bench.refused(&["simulate", "model.toml", "--out", "p.csv"]),
    );
    insta::assert_snapshot!(table);
}

#[test]
fn verify_help_and_version_are_no_fault() {
    let bench = Bench::new();
    for args in [
        vec!["--help"],
        vec!["-h"],
        vec!["help"],
        vec!["diagnose", "--help"],
        vec!["help", "simulate"],
    ] {
        let help = bench.done(&args);
        assert!(help.contains("Usage: simgap"), "{args:?}: {help}");
    }
    let version = bench.done(&["--version"]);
    assert_eq!(version, format!("simgap {}\n", env!("CARGO_PKG_VERSION")));
}

/// A name with a line end in it must not make two lines of one.
#[test]
fn verify_one_line_whatever_the_names_hold() {
    let bench = Bench::good();
    let line = bench.refused(&[
        "diagnose",
        "mo\ndel.toml",
        "--train",
        "A.csv",
        "--out",
        "out",
    ]);
    assert!(line.starts_with("mo del.toml: "), "{line}");
}
