//! Public benchmark data. They are not part of the project: `SIMGAP_DATA` names their folder, else
//! `../shared/data` beside the workspace is looked at. Where they are absent the tests say so and
//! pass.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stderr
)]

use std::path::PathBuf;

use serde_json::Value;

use crate::common::Bench;

/// A file of the data, or a loud word that it is not there.
fn data(name: &str) -> Option<PathBuf> {
    let folder = std::env::var_os("SIMGAP_DATA").map_or_else(
        || PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data"),
        PathBuf::from,
    );
    let path = folder.join(name);
    if path.is_file() {
        return Some(path);
    }
    eprintln!(
        "SKIPPED: no {}, so nothing was checked here",
        path.display()
    );
    None
}

fn diagnosis(bench: &Bench) -> Value {
    serde_json::from_str(&bench.read("out/diagnosis.json")).unwrap()
}

/// The value of the first parameter of a named effect.
fn value(json: &Value, kind: &str, at: &Value) -> f64 {
    let effects = json["verdict"]["effects"].as_array().unwrap();
    let named = effects.iter().find(|e| e["kind"] == kind && &e["at"] == at);
    let named = named.unwrap_or_else(|| panic!("{kind} is not named: {}", json["verdict"]));
    named["parameters"][0]["value"].as_f64().unwrap()
}

/// EMPS: Coulomb friction of about 20.4 N and viscous friction of 166.7 and 240.4 N s/m by direction
/// are published, on a model that has 203.5 N s/m.
#[test]
fn val_emps_friction_and_damping_by_direction() {
    let (Some(model), Some(record)) = (data("emps/model.toml"), data("emps/emps.csv")) else {
        return;
    };
    let bench = Bench::new();
    let (model, record) = (model.to_str().unwrap(), record.to_str().unwrap());
    bench.done(&["diagnose", model, "--train", record, "--out", "out"]);
    let json = diagnosis(&bench);
    let carriage = serde_json::json!({"between": ["carriage", "ground"]});
    let friction = value(&json, "coulomb_friction", &carriage);
    assert!((18.0..=23.0).contains(&friction), "friction {friction} N");
    // The first parameter is what is added forward.
    let forward = 203.5 + value(&json, "asymmetric_damping", &carriage);
    assert!(
        (150.0..=185.0).contains(&forward),
        "damping forward {forward} N s/m"
    );
    let corrected = json["gap"]["corrected"].as_f64().unwrap();
    assert!(corrected <= 0.025, "{corrected} corrected");
}

/// Lines `from..to` of the data rows of a record, under its header.
fn rows(text: &str, range: std::ops::Range<usize>) -> String {
    let mut lines = text.lines();
    let header = lines.next().unwrap();
    let kept: Vec<&str> = lines.skip(range.start).take(range.len()).collect();
    assert_eq!(kept.len(), range.len());
    format!("{header}\n{}\n", kept.join("\n"))
}

/// Silverbox: learnt from multisines, judged by the noise of growing amplitude. The literature has a hardening
/// spring, a bias of 5.4 mV on the input, and an rms error of 1.03 mV with the cubic term.
#[test]
fn val_silverbox_hardening_spring_and_the_bias_of_its_input() {
    let (Some(model), Some(record)) =
        (data("silverbox/model.toml"), data("silverbox/snls80mv.csv"))
    else {
        return;
    };
    let text = std::fs::read_to_string(record).unwrap();
    let bench = Bench::new();
    bench.write("multisine.csv", rows(&text, 40_650..46_650));
    bench.write("another.csv", rows(&text, 60_000..66_000));
    bench.write("growing.csv", rows(&text, 100..40_575));
    let model = model.to_str().unwrap();
    let args = [
        "diagnose",
        model,
        "--train",
        "multisine.csv",
        "--train",
        "another.csv",
        "--check",
        "growing.csv",
    ];
    bench.done(&[&args[..], &["--out", "out"]].concat());
    let json = diagnosis(&bench);
    let spring = serde_json::json!({"between": ["resonator", "ground"]});
    let cubic = value(&json, "cubic_stiffness", &spring);
    assert!(cubic > 0.0, "it hardens: {cubic}");
    let mass = serde_json::json!({"mass": "resonator"});
    let bias_v = value(&json, "constant_force", &mass) / 192_866.94;
    assert!((-5.8e-3..=-4.8e-3).contains(&bias_v), "bias {bias_v} V");
    let measured = json["gap"]["corrected"].as_f64().unwrap();
    // The growing noise has a standard deviation of 53.4 mV.
    assert!(measured * 53.4 <= 0.6, "{} mV left", measured * 53.4);
}
