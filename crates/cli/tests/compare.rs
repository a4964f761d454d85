//! `simgap compare`: what it writes and prints, and what it refuses.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use std::fmt::Write as _;

use crate::common::{Bench, columns};
use serde_json::Value;

const ARGUMENTS: [&str; 5] = ["compare", "--measured", "m.csv", "--simulated", "s.csv"];

fn motion(t: f64) -> f64 {
    (6.9 * t).sin() + 0.4 * (17.1 * t).cos()
}

/// A record of a drive and a motion, with a sample every `step` seconds.
fn trace(step: f64, rows: usize, y: impl Fn(f64) -> f64) -> String {
    let mut text = String::from("t [s],u [N],y [mm]\n");
    for k in 0..rows {
        let t = step * k as f64;
        // What is printed has an end; without it nothing would be left to explain.
        let noise = 2e-3 * (1e4 * (1.0 + 7.0 * t).sin()).sin();
        writeln!(text, "{t:.4},{:.6},{:.6}", (3.0 * t).sin(), y(t) + noise).unwrap();
    }
    text
}

/// A sensor that is 20 ms late, and a simulation at another rate.
fn late() -> Bench {
    let bench = Bench::new();
    bench.write("m.csv", trace(0.01, 1500, |t| motion(t - 0.02)));
    bench.write("s.csv", trace(0.004, 4000, motion));
    bench
}

#[test]
fn verify_a_late_sensor_is_found_and_written_down() {
    let bench = late();
    let stdout = bench.done(&[&ARGUMENTS[..], &["--out", "out"]].concat());
    assert!(
        stdout.contains("the measurement chain explains the gap"),
        "{stdout}"
    );
    assert!(
        stdout.to_lowercase().contains("sensor delay of "),
        "{stdout}"
    );
    assert!(stdout.contains("report: out/comparison.html"), "{stdout}");
    assert!(!stdout.contains('\u{1b}'), "{stdout:?}");
    let text = bench.read("out/comparison.json");
    let json: Value = serde_json::from_str(&text).unwrap();
    let printed = bench.done(&[&ARGUMENTS[..], &["--format", "json"]].concat());
    assert_eq!(printed, text, "the same bytes, printed or written");
    assert_eq!(json["schema"], "simgap-comparison/1");
    assert_eq!(json["chain"]["status"], "effect");
    let delay = json["chain"]["effects"][0]["parameters"][0]["value"]
        .as_f64()
        .unwrap();
    assert!((delay - 0.02).abs() < 1e-3, "{delay}");
    assert_eq!(json["inputs"][0]["channel"], "u");
    assert_eq!(json["time"]["resampled"], true);
    for key in [
        "channels",
        "bands",
        "times",
        "states",
        "records",
        "locations",
    ] {
        assert!(json["where"][key].is_array(), "{key}");
    }
    let agreement = &json["channels"][0];
    for metric in ["sprague_geers", "russell", "iso18571"] {
        assert!(agreement[metric].is_object(), "{metric}");
    }
    assert!(json["look"][0]["linear_share"].as_f64().unwrap() > 0.9);
    let (header, cells) = columns(&bench.read("out/compared.csv"));
    assert_eq!(
        header,
        [
            "t [s]",
            "y measured [m]",
            "y simulated [m]",
            "y corrected [m]"
        ]
    );
    let off = |k: usize| -> f64 {
        cells[1]
            .iter()
            .zip(&cells[k])
            .map(|(a, b)| (a - b).powi(2))
            .sum()
    };
    assert!(off(3) < 1e-2 * off(2), "the corrected trace is no nearer");
    assert!(bench.read("out/comparison.html").contains("ensor delay"));
}

#[test]
fn verify_columns_of_other_names_are_paired() {
    let bench = late();
    let renamed = bench.read("s.csv").replace("y [mm]", "x_carriage [mm]");
    bench.write("s.csv", renamed);
    let paired = [
        &ARGUMENTS[..],
        &["--pair", "y=x_carriage", "--format", "json"],
    ]
    .concat();
    let json: Value = serde_json::from_str(&bench.done(&paired)).unwrap();
    assert_eq!(json["channels"][0]["simulated"], "x_carriage");
    assert_eq!(json["chain"]["effects"][0]["kind"], "sensor_delay");
}

#[test]
fn regress_comparisons_that_are_refused() {
    let mut lines = String::new();
    let mut refused = |case: &str, bench: &Bench, more: &[&str]| {
        let line = bench.refused(&[&ARGUMENTS[..], more].concat());
        writeln!(lines, "{case}: {line}").unwrap();
    };
    let bench = late();
    refused("a pair without a sign", &bench, &["--pair", "y"]);
    refused("a pair that is not there", &bench, &["--pair", "y=z"]);
    refused(
        "a column twice",
        &bench,
        &["--pair", "y=y", "--pair", "u=y"],
    );
    refused("an input that is not there", &bench, &["--input", "v"]);
    let other_unit = late();
    other_unit.write("s.csv", other_unit.read("s.csv").replace("y [mm]", "y [N]"));
    refused("another quantity", &other_unit, &[]);
    let other_name = late();
    let renamed = other_name
        .read("s.csv")
        .replace("u [N],y [mm]", "a [N],b [mm]");
    other_name.write("s.csv", renamed);
    refused("nothing in common", &other_name, &[]);
    let moved = late();
    let text = moved.read("s.csv");
    let (head, rows) = text.split_once('\n').unwrap();
    let rows: Vec<String> = rows.lines().map(|row| format!("9{row}")).collect();
    // Stamps from 90.0000 s to 97.9960 s.
    moved.write("s.csv", format!("{head}\n{}\n", rows[..2000].join("\n")));
    refused("another time", &moved, &[]);
    let flat = late();
    let still = trace(0.01, 1500, |_| 0.0);
    let still: Vec<&str> = still
        .lines()
        .skip(1)
        .map(|l| l.rsplit_once(',').unwrap().0)
        .collect();
    flat.write(
        "m.csv",
        format!("t [s],u [N],y [mm]\n{},0\n", still.join(",0\n")),
    );
    refused("nothing moves", &flat, &[]);
    refused("no such file", &Bench::new(), &[]);
    insta::assert_snapshot!(lines);
}

/// A logger's own names and layout, and the uneven steps of a solver.
#[test]
fn verify_a_logger_and_a_solver_meet() {
    let bench = late();
    let table = bench.read("m.csv").replace(',', ";").replace('.', ",");
    let table = table.replace("t [s];u [N];y [mm]", "Zeit (s);Kraft (N);Weg (mm)");
    bench.write("m.csv", format!("Logger 7\n{table}"));
    let mut uneven = String::from("t [s],y [mm]\n");
    let mut t: f64 = 0.0;
    while t < 15.5 {
        writeln!(uneven, "{t:.6},{:.7}", motion(t)).unwrap();
        t += 0.002 * (1.0 + 0.8 * (3.0 * t).sin());
    }
    bench.write("s.csv", uneven);
    let mapped = [&ARGUMENTS[..], &["--map", "y=Weg", "--format", "json"]].concat();
    let json: Value = serde_json::from_str(&bench.done(&mapped)).unwrap();
    assert_eq!(
        json["chain"]["effects"][0]["kind"], "sensor_delay",
        "{json}"
    );
    let notes = json["notes"].to_string();
    assert!(
        notes.contains("s.csv") && notes.contains("m.csv"),
        "{notes}"
    );
}
