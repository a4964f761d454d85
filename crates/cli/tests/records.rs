//! Records of loggers and measurement programs, given to the commands.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use crate::common::{Bench, record};

/// The record of the bench as a logger would write it: other names, units in a row of their own,
/// semicolons, decimal commas.
fn logged() -> String {
    let good = record(60);
    let rows: Vec<&str> = good.lines().skip(1).collect();
    let rows = rows.join("\n").replace(',', ";").replace('.', ",");
    format!("Logger 7\nZeit;Kraft;Pos_Block\ns;N;m\n{rows}\n")
}

const MAP: [&str; 4] = ["--map", "u=Kraft", "--map", "y=Pos_Block"];

#[test]
fn verify_a_logger_file_and_a_map_predict_as_the_plain_record() {
    let bench = Bench::good();
    bench.write("L.csv", logged());
    let plain = [
        "simulate",
        "model.toml",
        "--record",
        "A.csv",
        "--out",
        "plain.csv",
    ];
    let mut mapped = vec![
        "simulate",
        "model.toml",
        "--record",
        "L.csv",
        "--out",
        "mapped.csv",
    ];
    mapped.extend(MAP);
    bench.done(&plain);
    bench.done(&mapped);
    assert_eq!(bench.read("mapped.csv"), bench.read("plain.csv"));
}

#[test]
fn verify_a_diagnosis_notes_what_was_guessed() {
    let bench = Bench::good();
    bench.write("L.csv", logged());
    let mut args = vec!["diagnose", "model.toml", "--train", "L.csv", "--out", "out"];
    args.extend(MAP);
    bench.done(&args);
    let json = bench.read("out/diagnosis.json");
    for note in [
        "L.csv: read as a table separated by semicolons with a decimal comma, header in line 2, units in line 3",
        "L.csv: 'u' read from column 'Kraft'",
        "L.csv: 'y' read from column 'Pos_Block'",
    ] {
        assert!(json.contains(note), "{note} not in {json}");
    }
    // The command that repeats it has what was read as what.
    let page = bench.read("out/report.html");
    assert!(page.contains("--map u=Kraft --map y=Pos_Block"));
}

#[test]
fn regress_faults_of_a_map() {
    let bench = Bench::good();
    bench.write("L.csv", logged());
    let say = |record: &str, entries: &[&str]| {
        let mut args = vec![
            "simulate",
            "model.toml",
            "--record",
            record,
            "--out",
            "p.csv",
        ];
        for entry in entries {
            args.extend(["--map", entry]);
        }
        bench.refused(&args)
    };
    let lines = [
        say("L.csv", &["y=Pos_Block"]),
        say("L.csv", &["u=Kraft", "y=Pos_Blok"]),
        say("L.csv", &["u=Kraft", "y=Pos_Block [kN]"]),
        say("L.csv", &["u=Kraft", "yy=Pos_Block"]),
        say("L.csv", &["u=Kraft", "u=Pos_Block"]),
        say("L.csv", &["Kraft"]),
        say("L.csv", &[]),
    ];
    insta::assert_snapshot!(lines.join("\n"));
}

#[test]
fn verify_mend_fills_a_plain_record() {
    let bench = Bench::good();
    let good = record(60);
    let mut lines: Vec<String> = good.lines().map(str::to_owned).collect();
    let cells: Vec<&str> = lines[6].split(',').collect();
    lines[6] = format!("{},{},NaN", cells[0], cells[1]);
    bench.write("A.csv", lines.join("\n"));
    let args = [
        "simulate",
        "model.toml",
        "--record",
        "A.csv",
        "--out",
        "p.csv",
    ];
    assert!(bench.refused(&args).contains("line 7"));
    bench.done(&[&args[..], &["--mend"]].concat());
}
