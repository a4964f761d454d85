//! What `docs/contract.md` promises of the ways to run the program, checked on a small case: the
//! oscillator with dry friction that its model lacks.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use std::sync::OnceLock;

use serde_json::Value;

use crate::common::schema::{check_schema, diagnosis, list, names, number, string};
use crate::common::{Bench, MODEL, columns, rms, std_dev, text};

/// Records of 5 s at 100 Hz, made by the program itself from a model with friction, then diagnosed
/// with the model that lacks it; once for all tests of this file.
fn small() -> &'static Small {
    static SMALL: OnceLock<Small> = OnceLock::new();
    SMALL.get_or_init(|| {
        let bench = Bench::new();
        bench.write("model.toml", MODEL);
        let friction =
            "[[effect]]\nkind = \"coulomb_friction\"\nbetween = [\"block\", \"ground\"]\n";
        bench.write(
            "truth.toml",
            format!("{MODEL}\n{friction}friction_force_n = 1.0\n"),
        );
        for (seed, name) in ["train-1.csv", "train-2.csv", "check.csv"]
            .iter()
            .enumerate()
        {
            bench.write(name, measured(&bench, seed as f64));
        }
        let small = Small { bench };
        small.diagnose("diagnosis", &[]);
        small
    })
}

/// A motion of the true plant with a little noise.
fn measured(bench: &Bench, seed: f64) -> String {
    let drive = |t: f64| {
        6.0 * ((9.0 + seed) * t).sin() + 4.0 * (17.0 * t + seed).cos() + 3.0 * (31.0 * t).sin()
    };
    let time: Vec<f64> = (0..500).map(|k| f64::from(k) * 0.01).collect();
    let mut inputs = String::from("t [s],u [N]\n");
    for &t in &time {
        inputs += &format!("{t:.2},{:.6}\n", drive(t));
    }
    bench.write("inputs.csv", inputs);
    bench.done(&[
        "simulate",
        "truth.toml",
        "--record",
        "inputs.csv",
        "--out",
        "y.csv",
    ]);
    let (_, cells) = columns(&bench.read("y.csv"));
    let mut text = String::from("t [s],u [N],y [m]\n");
    for (k, &t) in time.iter().enumerate() {
        // The digits of a sine of large argument: noise enough, and the same on every machine.
        let noise = 1e-5 * (1e4 * (12.9898 * k as f64 + 78.233 * seed).sin()).fract();
        text += &format!("{t:.2},{:.6},{:.8}\n", drive(t), cells[1][k] + noise);
    }
    text
}

struct Small {
    bench: Bench,
}

impl Small {
    fn json(&self) -> Value {
        diagnosis(&self.bench, "diagnosis")
    }

    /// `diagnose` on the three records, which must succeed.
    fn diagnose(&self, out: &str, more: &[&str]) -> String {
        self.diagnose_in("", out, more)
    }

    /// `diagnose` on three records of these names in a folder.
    fn diagnose_in(&self, folder: &str, out: &str, more: &[&str]) -> String {
        let [first, second, check] =
            ["train-1.csv", "train-2.csv", "check.csv"].map(|name| format!("{folder}{name}"));
        let mut args = vec![
            "diagnose",
            "model.toml",
            "--train",
            &first,
            "--train",
            &second,
        ];
        args.extend(["--check", &check, "--out", out]);
        args.extend(more);
        self.bench.done(&args)
    }
}

#[test]
fn verify_the_small_case_is_understood() {
    let json = small().json();
    check_schema(&json);
    let effects = list(&json["verdict"]["effects"]);
    let named: Vec<&str> = effects.iter().map(|e| string(&e["kind"])).collect();
    assert_eq!(named, ["coulomb_friction"]);
    let level = &effects[0]["parameters"][0];
    assert_eq!(level["name"], "friction_force_n");
    assert!((number(&level["value"]) - 1.0).abs() < 0.05, "{level}");
}

#[test]
fn verify_json_on_stdout_is_the_file() {
    let small = small();
    let printed = small.diagnose("as-json", &["--format", "json"]);
    assert_eq!(printed, small.bench.read("as-json/diagnosis.json"));
}

#[test]
fn verify_the_same_bytes_whatever_the_jobs() {
    let small = small();
    small.diagnose("one", &["--jobs", "1"]);
    small.diagnose("two", &["--jobs", "2"]);
    small.diagnose("seven", &["--seed", "7"]);
    let first = small.bench.files("diagnosis");
    for other in ["one", "two", "seven"] {
        let files = small.bench.files(other);
        assert_eq!(names(&small.bench, other), names(&small.bench, "diagnosis"));
        for (name, bytes) in &files {
            // The page tells the seed, and the list of files the digest of the page.
            let may_differ = other == "seven"
                && (name.ends_with("report.html") || name.ends_with(".simgap-files.json"));
            assert!(
                may_differ || first[name] == *bytes,
                "{} differs in {other}",
                name.display()
            );
        }
    }
}

#[test]
fn verify_a_second_run_replaces_the_first() {
    let bench = Bench::good();
    let args = ["diagnose", "model.toml", "--train", "A.csv", "--out", "out"];
    bench.done(&args);
    let first = bench.files("out");
    bench.write("out/diagnosis.json", "stale");
    bench.done(&args);
    assert_eq!(bench.files("out"), first);
}

#[test]
fn verify_a_withheld_kind_is_never_named() {
    let small = small();
    small.diagnose("withheld", &["--withhold", "coulomb_friction"]);
    let text = small.bench.read("withheld/diagnosis.json");
    assert!(!text.contains("coulomb_friction"), "{text}");
    check_schema(&diagnosis(&small.bench, "withheld"));
    assert!(
        !small
            .bench
            .read("withheld/corrected.toml")
            .contains("coulomb_friction")
    );
}

/// A reader that closes the pipe early is no fault of the program.
#[test]
fn verify_a_closed_pipe_is_no_fault() {
    use std::process::Stdio;
    let mut command = small().bench.simgap(&["effects"]);
    let mut child = command
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    assert_eq!(text(&output.stderr), "");
    assert!(output.status.success(), "{:?}", output.status);
}

/// A time stamp as the notes write it, read back.
fn seconds(note: &str) -> Vec<f64> {
    let words: Vec<&str> = note.split([' ', '(', ')']).collect();
    words
        .windows(2)
        .filter(|pair| pair[1] == "s")
        .filter_map(|pair| pair[0].parse().ok())
        .collect()
}

#[test]
fn verify_without_check_the_last_third_is_held_back() {
    let small = small();
    let args = [
        "diagnose",
        "model.toml",
        "--train",
        "train-1.csv",
        "--train",
        "train-2.csv",
    ];
    small.bench.done(&[&args[..], &["--out", "held"]].concat());
    let json = diagnosis(&small.bench, "held");
    check_schema(&json);
    let files = names(&small.bench, "held/predictions");
    assert_eq!(files, ["train-1.csv", "train-2.csv"]);
    let notes: Vec<&str> = list(&json["notes"]).iter().map(string).collect();
    for name in ["train-1.csv", "train-2.csv"] {
        let (_, record) = columns(&small.bench.read(name));
        let (_, cells) = columns(&small.bench.read(&format!("held/predictions/{name}")));
        let held = record[0].len() / 3;
        assert_eq!(cells[0], record[0][record[0].len() - held..], "{name}");
        let said = |note: &&&str| note.contains("held back") && note.contains(name);
        let note = notes
            .iter()
            .find(said)
            .expect("a note on what was held back");
        let ends = [cells[0][0], cells[0][held - 1]];
        assert_eq!(seconds(note), ends, "{note}");
    }
}

/// What was not learnt from has no say: with a hum on the held-back third, the corrected
/// model stays the same to the last digit.
#[test]
fn verify_nothing_is_fitted_to_what_is_held_back() {
    let small = small();
    let good = small.bench.read("train-1.csv");
    let kept = good.lines().count() - 1 - (good.lines().count() - 1) / 3;
    let mut spoilt = String::new();
    for (k, line) in good.lines().enumerate() {
        match line.rsplit_once(',') {
            Some((rest, y)) if k > kept => {
                let y: f64 = y.parse().unwrap();
                spoilt += &format!("{rest},{}\n", y + 1e-4 * (k as f64).cos());
            }
            _ => spoilt += &format!("{line}\n"),
        }
    }
    let bench = Bench::new();
    bench.write("model.toml", small.bench.read("model.toml"));
    bench.write("good/A.csv", good);
    bench.write("spoilt/A.csv", spoilt);
    for case in ["good", "spoilt"] {
        let (train, out) = (format!("{case}/A.csv"), format!("{case}/out"));
        bench.done(&["diagnose", "model.toml", "--train", &train, "--out", &out]);
    }
    let model = |case: &str| bench.read(&format!("{case}/out/corrected.toml"));
    assert!(model("good").contains("coulomb_friction"));
    assert_eq!(model("good"), model("spoilt"));
    let gap = |case: &str| number(&diagnosis(&bench, &format!("{case}/out"))["gap"]["corrected"]);
    assert!(
        gap("spoilt") > 2.0 * gap("good"),
        "the spoilt third was not looked at"
    );
}

/// A record with a column of words, in other units, with the columns in another order.
fn restated(text: &str, force: f64, motion: f64, header: &str, words: bool) -> String {
    let mut lines = text.lines();
    lines.next();
    let mut restated = format!("{header}\n");
    for line in lines {
        let cells: Vec<&str> = line.split(',').collect();
        let scaled = |cell: &str, by: f64| cell.parse::<f64>().unwrap() * by;
        let (u, y) = (scaled(cells[1], force), scaled(cells[2], motion));
        let row = if words {
            format!("{},good,{},\"n/a, or so\",{}\n", y, cells[0], u)
        } else {
            format!("{},{u},{y}\n", cells[0])
        };
        restated += &row;
    }
    restated
}

#[test]
fn verify_extra_columns_are_ignored_whatever_they_hold() {
    let small = small();
    let header = "y [m],state,t [s],remark [?],u [N]";
    for name in ["train-1.csv", "train-2.csv", "check.csv"] {
        let text = restated(&small.bench.read(name), 1.0, 1.0, header, true);
        small.bench.write(&format!("wordy/{name}"), text);
    }
    let args = [
        "diagnose",
        "model.toml",
        "--train",
        "wordy/train-1.csv",
        "--train",
    ];
    let more = [
        "wordy/train-2.csv",
        "--check",
        "wordy/check.csv",
        "--out",
        "wordy-out",
    ];
    small.bench.done(&[&args[..], &more].concat());
    let same = small.bench.read("wordy-out/diagnosis.json")
        == small.bench.read("diagnosis/diagnosis.json");
    assert!(same, "the extra columns made a difference");
}

#[test]
fn verify_units_are_converted_and_the_conversion_is_reported() {
    // Values in mm and kN differ from those in SI in the last bit; 25 steps of a fit that stops
    // when it gains less than 0.02 in log-likelihood leave less of it than this.
    const ROUNDING: f64 = 1e-6;
    let small = small();
    let header = "t [s],u [kN],y [mm]";
    for name in ["train-1.csv", "train-2.csv", "check.csv"] {
        let text = restated(&small.bench.read(name), 1e-3, 1e3, header, false);
        small.bench.write(&format!("mm/{name}"), text);
    }
    let args = [
        "diagnose",
        "model.toml",
        "--train",
        "mm/train-1.csv",
        "--train",
    ];
    let more = [
        "mm/train-2.csv",
        "--check",
        "mm/check.csv",
        "--out",
        "mm-out",
    ];
    small.bench.done(&[&args[..], &more].concat());
    let (si, mm) = (small.json(), diagnosis(&small.bench, "mm-out"));
    let notes = mm["notes"].to_string();
    for said in ["mm/", "mm", "kN", "0.001", "1000"] {
        assert!(
            said == "mm/" || notes.contains(said),
            "{said} is not in {notes}"
        );
    }
    for key in [
        "nominal",
        "recalibrated",
        "corrected",
        "noise_floor",
        "closed",
    ] {
        let (a, b) = (number(&si["gap"][key]), number(&mm["gap"][key]));
        assert!((a / b - 1.0).abs() < ROUNDING, "gap.{key}: {a} and {b}");
    }
    let effects = |json: &Value| list(&json["verdict"]["effects"]).clone();
    assert_eq!(effects(&si).len(), effects(&mm).len());
    for (a, b) in effects(&si).iter().zip(&effects(&mm)) {
        assert_eq!((&a["kind"], &a["at"]), (&b["kind"], &b["at"]));
        for (p, q) in list(&a["parameters"]).iter().zip(list(&b["parameters"])) {
            let (p, q) = (number(&p["value"]), number(&q["value"]));
            assert!((p / q - 1.0).abs() < ROUNDING, "{}: {p} and {q}", a["kind"]);
        }
    }
    // The corrected model keeps its promise on a record in these units as well.
    let args = [
        "simulate",
        "mm-out/corrected.toml",
        "--record",
        "mm/check.csv",
    ];
    small
        .bench
        .done(&[&args[..], &["--out", "mm-again.csv"]].concat());
    let (_, again) = columns(&small.bench.read("mm-again.csv"));
    let (_, cells) = columns(&small.bench.read("mm-out/predictions/check.csv"));
    let off = rms(again[1].iter().zip(&cells[3]).map(|(a, b)| a - b)) / std_dev(&cells[1]);
    assert!(off < 1e-4, "off by {off:e} of the motion");
}

/// Inputs alone drive a model: the outputs of a record are no need, only a help.
#[test]
fn verify_simulate_needs_no_outputs() {
    let bench = Bench::good();
    let inputs: String = bench
        .read("A.csv")
        .lines()
        .map(|line| format!("{}\n", line.rsplit_once(',').unwrap().0))
        .collect();
    bench.write("inputs.csv", inputs);
    bench.done(&[
        "simulate",
        "model.toml",
        "--record",
        "inputs.csv",
        "--out",
        "a.csv",
    ]);
    let rest = ["simulate", "model.toml", "--record", "A.csv", "--from-rest"];
    bench.done(&[&rest[..], &["--out", "b.csv"]].concat());
    assert_eq!(bench.read("a.csv"), bench.read("b.csv"));
    let (header, cells) = columns(&bench.read("a.csv"));
    assert_eq!(header, ["t [s]", "y [m]"]);
    assert_eq!(cells[1][0], 0.0, "at rest");
    assert!(cells[1].iter().any(|y| y.abs() > 1e-4), "and then driven");
}

/// A second case of its own: a damper driven by a displacement whose force is measured, no mass.
#[test]
fn verify_a_plant_without_mass() {
    let bench = Bench::new();
    bench.write(
        "model.toml",
        r#"schema = "simgap-model/1"
name = "damper rig"

[[damper]]
name = "piston"
between = ["rod", "ground"]
damping = 1500.0

[[input]]
channel = "x"
kind = "displacement"
at = "rod"

[[output]]
channel = "F"
kind = "force"
between = ["rod", "ground"]
"#,
    );
    let mut text = String::from("t [s],x [mm],F [kN]\n");
    for k in 0..900 {
        let t = f64::from(k) * 0.002;
        let (a, b) = (
            2.0 * std::f64::consts::PI * 1.5,
            2.0 * std::f64::consts::PI * 4.1,
        );
        let x = 0.020 * (a * t).sin() + 0.004 * (b * t).sin();
        let v = 0.020 * a * (a * t).cos() + 0.004 * b * (b * t).cos();
        // The rig's own friction, and a ripple that stands for noise.
        let ripple = 2.0 * (f64::from(k) * 12.9898).sin() * (f64::from(k * k % 7919)).cos();
        let force = 1500.0 * v + 60.0 * v.signum() + ripple;
        text += &format!("{t:.3},{:.6},{:.8}\n", 1e3 * x, 1e-3 * force);
    }
    bench.write("rig.csv", text);
    bench.done(&[
        "diagnose",
        "model.toml",
        "--train",
        "rig.csv",
        "--out",
        "out",
    ]);
    let json = diagnosis(&bench, "out");
    check_schema(&json);
    let effects = list(&json["verdict"]["effects"]);
    let friction = effects.iter().find(|e| e["kind"] == "coulomb_friction");
    let friction = friction.unwrap_or_else(|| panic!("{}", json["verdict"]));
    assert_eq!(
        friction["at"]["between"],
        serde_json::json!(["rod", "ground"])
    );
    let level = number(&friction["parameters"][0]["value"]);
    assert!((level / 60.0 - 1.0).abs() < 0.02, "{level} N");
    let (header, _) = columns(&bench.read("out/predictions/rig.csv"));
    assert_eq!(
        header,
        [
            "t [s]",
            "F measured [N]",
            "F nominal [N]",
            "F corrected [N]"
        ]
    );
}
