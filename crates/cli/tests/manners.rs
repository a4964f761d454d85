//! What the program does to the places it writes to, and to records that are given twice.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stderr
)]
#![cfg(unix)]

use std::fmt::Write as _;
use std::fs;
use std::os::unix::fs::{FileTypeExt as _, symlink};
use std::process::{Command, Stdio};

use crate::common::{Bench, record, text};

const SIMULATE: [&str; 5] = ["simulate", "model.toml", "--record", "A.csv", "--out"];

fn simulate(out: &str) -> Vec<&str> {
    SIMULATE.into_iter().chain([out]).collect()
}

/// A record of another motion.
fn other(rows: usize) -> String {
    record(rows + 7)
        .lines()
        .enumerate()
        .fold(String::new(), |mut text, (k, line)| {
            match (k, line.split_once(',')) {
                (0, _) => writeln!(text, "{line}").unwrap(),
                (k, Some((_, rest))) if k > 7 => {
                    writeln!(text, "{:.2},{rest}", (k - 8) as f64 * 0.01).unwrap();
                }
                _ => {}
            }
            text
        })
}

#[test]
fn regress_what_is_never_replaced() {
    let bench = Bench::good();
    let made = Command::new("mkfifo").arg(bench.path("fifo")).status();
    assert!(made.unwrap().success());
    let _socket = std::os::unix::net::UnixListener::bind(bench.path("socket")).unwrap();
    symlink("fifo", bench.path("link")).unwrap();
    fs::create_dir(bench.path("out")).unwrap();
    symlink("/dev/null", bench.path("out/report.html")).unwrap();
    let is_there = |name: &str| fs::symlink_metadata(bench.path(name)).unwrap().file_type();
    let mut table = String::new();
    // Reading a FIFO would wait for ever, so the folder is not compared here.
    for args in [
        simulate("fifo"),
        simulate("socket"),
        simulate("link"),
        simulate("/dev/null"),
        simulate("/dev/stdout"),
        vec!["init", "--force", "--out", "fifo"],
        vec!["diagnose", "model.toml", "--train", "A.csv", "--out", "out"],
        vec![
            "diagnose",
            "model.toml",
            "--train",
            "A.csv",
            "--out",
            "/dev/null",
        ],
    ] {
        let output = bench.run(&args);
        assert_eq!(output.status.code(), Some(2), "{args:?}");
        assert_eq!(text(&output.stdout), "", "{args:?}");
        write!(table, "{}: {}", args.join(" "), text(&output.stderr)).unwrap();
    }
    insta::assert_snapshot!(table);
    assert!(is_there("fifo").is_fifo() && is_there("socket").is_socket());
    assert!(is_there("link").is_symlink() && is_there("out/report.html").is_symlink());
    assert!(
        fs::metadata("/dev/null")
            .unwrap()
            .file_type()
            .is_char_device()
    );
    assert_eq!(fs::read_dir(bench.path("out")).unwrap().count(), 1);
}

#[test]
fn verify_a_symbolic_link_is_written_through() {
    let bench = Bench::good();
    bench.write("elsewhere/real.csv", "old");
    symlink("elsewhere/real.csv", bench.path("link.csv")).unwrap();
    bench.done(&simulate("link.csv"));
    bench.done(&simulate("plain.csv"));
    assert!(
        fs::symlink_metadata(bench.path("link.csv"))
            .unwrap()
            .is_symlink()
    );
    assert_eq!(bench.read("elsewhere/real.csv"), bench.read("plain.csv"));
    assert_eq!(bench.files("elsewhere").len(), 1);
}

/// What an earlier run wrote and this one does not is gone; what others put there stays, as does what they changed.
#[test]
fn verify_no_stale_files_stay_and_no_others_go() {
    let bench = Bench::good();
    for name in ["B.csv", "C.csv", "D.csv"] {
        bench.write(name, other(60 + usize::from(name.as_bytes()[0])));
    }
    let diagnose = |check: &[&str]| {
        let mut args = vec!["diagnose", "model.toml", "--train", "A.csv", "--out", "out"];
        args.extend(check.iter().flat_map(|name| ["--check", name]));
        bench.done(&args);
    };
    diagnose(&["B.csv", "D.csv"]);
    assert!(bench.path("out/predictions/B.csv").is_file());
    bench.write("out/predictions/mine.csv", "mine");
    bench.write("out/notes.txt", "mine");
    bench.write("out/predictions/D.csv", "changed by hand");
    diagnose(&["C.csv"]);
    let names: Vec<String> = bench
        .files("out/predictions")
        .keys()
        .map(|path| path.display().to_string())
        .collect();
    assert_eq!(names, ["C.csv", "D.csv", "mine.csv"]);
    assert_eq!(bench.read("out/predictions/D.csv"), "changed by hand");
    assert_eq!(bench.read("out/notes.txt"), "mine");
    // Beside these, the folder is that of a first run.
    let again = bench.files("out");
    fs::rename(bench.path("out"), bench.path("used")).unwrap();
    diagnose(&["C.csv"]);
    for (path, bytes) in bench.files("out") {
        assert_eq!(again.get(&path), Some(&bytes), "{}", path.display());
    }
    assert_eq!(again.len(), bench.files("out").len() + 3);
}

/// A list that names files elsewhere moves nothing.
#[test]
fn verify_a_forged_list_of_files_harms_nothing() {
    let bench = Bench::good();
    bench.write("B.csv", other(80));
    bench.write("precious", "");
    let forged = r#"{"schema":"simgap-files/1","commands":{"compare":[
        {"file":"../precious","bytes":0,"fnv1a":"cbf29ce484222325"}]}}"#;
    bench.write("out/.simgap-files.json", forged);
    let args = [
        "compare",
        "--measured",
        "A.csv",
        "--simulated",
        "A.csv",
        "--out",
        "out",
    ];
    bench.done(&args);
    assert!(bench.path("precious").is_file());
    assert!(!bench.read("out/.simgap-files.json").contains("precious"));
}

/// A limit on the size of files stands for a disk that fills: the result of the earlier run stays whole.
#[test]
fn verify_a_full_disk_leaves_the_old_result() {
    let bench = Bench::good();
    bench.write("B.csv", other(80));
    let args = "diagnose model.toml --train A.csv --check B.csv --out out";
    bench.done(&args.split(' ').collect::<Vec<_>>());
    bench.write("B.csv", other(90));
    let before = bench.everything();
    let refused = |out: &str| {
        let program = env!("CARGO_BIN_EXE_simgap");
        let limited = format!("trap '' XFSZ; ulimit -f 8; exec {program} {args}");
        let mut shell = Command::new("sh");
        shell.args(["-c", &limited.replace("--out out", &format!("--out {out}"))]);
        shell.current_dir(bench.path("")).stdin(Stdio::null());
        bench.refused_command(shell)
    };
    let line = refused("out");
    assert!(line.contains("cannot be written"), "{line}");
    refused("fresh");
    assert_eq!(bench.everything(), before);
}

#[test]
fn verify_a_stdout_that_cannot_be_written_is_told() {
    let bench = Bench::good();
    let full = || {
        fs::OpenOptions::new()
            .write(true)
            .open("/dev/full")
            .unwrap()
    };
    for args in [
        vec!["check", "A.csv"],
        vec!["check", "A.csv", "--format", "json"],
        vec!["effects"],
        vec!["effects", "dropouts"],
        vec!["completions", "bash"],
        vec!["man"],
        vec!["init"],
        vec!["--help"],
        vec!["--version"],
    ] {
        let output = bench.simgap(&args).stdout(full()).output().unwrap();
        let told = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{args:?}: {told}");
        assert!(
            told.starts_with("simgap: stdout: cannot be written"),
            "{told}"
        );
        assert_eq!(told.lines().count(), 1, "{told}");
    }
    // Open for reading alone.
    let reading = fs::File::open(bench.path("A.csv")).unwrap();
    let output = bench.simgap(&["effects"]).stdout(reading).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    // With neither stream the status still tells.
    let mut both = bench.simgap(&["effects"]);
    let status = both.stdout(full()).stderr(full()).status().unwrap();
    assert_eq!(status.code(), Some(2));
    // A reader that has seen enough is no fault.
    let mut child = bench
        .simgap(&["man"])
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    assert_eq!(child.wait().unwrap().code(), Some(0));
}

#[test]
fn regress_records_given_twice() {
    let bench = Bench::good();
    let a = record(60);
    bench.write("copy.csv", &a);
    bench.write("B.csv", other(90));
    let part: Vec<&str> = a.lines().take(41).collect();
    bench.write("part.csv", part.join("\n") + "\n");
    bench.write("longer.csv", record(80));
    // The same samples from another clock, in another unit.
    let later = a
        .replace("y [m]", "y [mm]")
        .lines()
        .fold(String::new(), |mut text, line| {
            match line
                .split(',')
                .map(str::parse::<f64>)
                .collect::<Result<Vec<_>, _>>()
            {
                Ok(cells) => writeln!(
                    text,
                    "{:.2},{},{}",
                    cells[0] + 5.0,
                    cells[1],
                    cells[2] * 1e3
                ),
                Err(_) => writeln!(text, "{line}"),
            }
            .unwrap();
            text
        });
    bench.write("later.csv", later);
    let mut table = String::new();
    let mut note = |more: &[&str]| {
        let mut args = vec!["diagnose", "model.toml", "--out", "out"];
        args.extend(more);
        writeln!(table, "{}: {}", more.join(" "), bench.refused(&args)).unwrap();
    };
    note(&["--train", "A.csv", "--check", "A.csv"]);
    note(&[
        "--train", "B.csv", "--train", "A.csv", "--check", "copy.csv",
    ]);
    note(&["--train", "A.csv", "--check", "part.csv"]);
    note(&["--train", "A.csv", "--check", "longer.csv"]);
    note(&["--train", "A.csv", "--check", "later.csv"]);
    note(&[
        "--train", "A.csv", "--train", "copy.csv", "--check", "B.csv",
    ]);
    note(&["--train", "A.csv", "--train", "copy.csv"]);
    insta::assert_snapshot!(table);
}

/// Against a model: a sign, and a column that two records have in common.
#[test]
fn regress_records_checked_against_a_model() {
    let bench = Bench::good();
    let turned = record(800).lines().fold(String::new(), |mut text, line| {
        match line
            .rsplit_once(',')
            .map(|(rest, y)| (rest, y.parse::<f64>()))
        {
            Some((rest, Ok(y))) => writeln!(text, "{rest},{:.8}", -y).unwrap(),
            _ => writeln!(text, "{line}").unwrap(),
        }
        text
    });
    bench.write("A.csv", record(800));
    bench.write("turned.csv", turned);
    let args = ["check", "turned.csv", "A.csv", "--model", "model.toml"];
    let told = bench.done(&args);
    let audit: Vec<&str> = told
        .lines()
        .skip_while(|line| !line.contains("audit"))
        .collect();
    insta::assert_snapshot!(audit.join("\n"));
    let json = bench.done(&[&args[..], &["--format", "json"]].concat());
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    let found = json["audit"].as_array().unwrap();
    let of_topic = |topic: &str| found.iter().find(|f| f["topic"] == topic).unwrap();
    assert_eq!(of_topic("sign")["record"], "turned.csv");
    assert_eq!(of_topic("identical")["record"], "A.csv");
    let still = record(800).lines().fold(String::new(), |mut text, line| {
        match line.rsplit_once(',') {
            Some((rest, y)) if y.parse::<f64>().is_ok() => writeln!(text, "{rest},0.0031"),
            _ => writeln!(text, "{line}"),
        }
        .unwrap();
        text
    });
    bench.write("still.csv", still);
    let told = bench.done(&["check", "still.csv", "--model", "model.toml"]);
    assert!(
        told.contains("'y' stands still: is the sensor connected?"),
        "{told}"
    );
    bench.write("bad.toml", "");
    let line = bench.refused(&["check", "A.csv", "--model", "bad.toml"]);
    assert!(line.starts_with("bad.toml: "), "{line}");
}
