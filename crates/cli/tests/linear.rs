//! `simgap modes` and `simgap sensitivity`: what they print and write, and what they refuse.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use crate::common::{Bench, MODEL};
use serde_json::Value;

/// The oscillator of the bench: √(800/2) = 20 rad/s, ζ = 4/(2 √1600) = 0.05.
const OMEGA: f64 = 20.0;
const ZETA: f64 = 0.05;

/// Rounding of a 2 × 2 eigenvalue problem and of a few sums.
const ROUNDING: f64 = 1e-10;

/// A free table with a flexible arm under its weight, and an effect.
const TABLE: &str = r#"schema = "simgap-model/1"
name = "table"
[[mass]]
name = "table"
value = 30.0
[[mass]]
name = "arm"
value = 0.5
[[spring]]
name = "belt"
between = ["table", "arm"]
stiffness = 9000.0
[[damper]]
name = "guide"
between = ["table", "ground"]
damping = 60.0
[[input]]
channel = "u"
kind = "force"
at = "table"
[[output]]
channel = "y"
kind = "displacement"
at = "table"
[[load]]
at = "table"
value = -3.0
[[effect]]
kind = "coulomb_friction"
between = ["table", "ground"]
friction_force_n = 2.0
"#;

fn json(text: &str) -> Value {
    serde_json::from_str(text).unwrap()
}

fn near(value: &Value, wanted: f64) {
    let found = value.as_f64().unwrap();
    assert!(
        (found - wanted).abs() < ROUNDING * wanted.abs().max(1.0),
        "{found} instead of {wanted}"
    );
}

#[test]
fn verify_modes_of_an_oscillator() {
    let bench = Bench::good();
    let found = json(&bench.done(&["modes", "model.toml", "--format", "json"]));
    assert_eq!(found["schema"], "simgap-modes/1");
    let mode = &found["modes"][0];
    near(&mode["natural_freq_hz"], OMEGA / std::f64::consts::TAU);
    near(&mode["damping_ratio"], ZETA);
    near(&mode["pole"]["re"], -ZETA * OMEGA);
    near(&mode["pole"]["im"], OMEGA * (1.0 - ZETA * ZETA).sqrt());
    let response = &found["responses"][0];
    let list = |key: &str| -> Vec<f64> {
        response[key]
            .as_array()
            .unwrap()
            .iter()
            .map(|v| v.as_f64().unwrap())
            .collect()
    };
    for ((freq, gain), phase) in list("freq_hz")
        .iter()
        .zip(list("gain"))
        .zip(list("phase_deg"))
    {
        let omega = std::f64::consts::TAU * freq;
        let (re, im) = (800.0 - 2.0 * omega * omega, 4.0 * omega);
        assert!((gain * re.hypot(im) - 1.0).abs() < ROUNDING);
        assert!((phase + im.atan2(re).to_degrees()).abs() < 1e-6);
    }
}

#[test]
fn verify_sensitivities_of_an_oscillator() {
    let bench = Bench::good();
    let asked = [
        "sensitivity",
        "model.toml",
        "--tolerance",
        "3",
        "--format",
        "json",
    ];
    let found = json(&bench.done(&asked));
    assert_eq!(found["schema"], "simgap-sensitivity/1");
    let pole = &found["poles"][0];
    let rows = pole["parameters"].as_array().unwrap();
    assert_eq!(rows.len(), 3);
    let row = |name: &str| rows.iter().find(|row| row["parameter"] == name).unwrap();
    // f = √(k/m)/2π and ζ = c/(2 √(k m)).
    let wanted = [
        ("spring \"rod\"", 0.5, -0.5 * ZETA),
        ("mass \"block\"", -0.5, -0.5 * ZETA),
        ("damper \"rod\"", 0.0, ZETA),
    ];
    for (name, freq, ratio) in wanted {
        near(&row(name)["freq_percent_per_percent"], freq);
        near(&row(name)["damping_ratio_per_percent"], 0.01 * ratio);
    }
    let hz = OMEGA / std::f64::consts::TAU;
    near(&row("spring \"rod\"")["freq_change_hz"], 0.03 * 0.5 * hz);
    near(&pole["freq_spread_hz"], 0.03 * hz * 0.5_f64.sqrt());
    // Spring and mass move the pole alike and more than the damper.
    assert_eq!(rows[2]["parameter"], "damper \"rod\"");
}

#[test]
fn regress_tables() {
    let bench = Bench::good();
    bench.write("table.toml", TABLE);
    let mut text = String::new();
    for model in ["model.toml", "table.toml"] {
        for command in ["modes", "sensitivity"] {
            text += &format!("==== {command} {model}\n{}", bench.done(&[command, model]));
        }
    }
    insta::assert_snapshot!(text);
}

#[test]
fn verify_what_is_written() {
    let bench = Bench::good();
    for command in ["modes", "sensitivity"] {
        let printed = bench.done(&[command, "model.toml", "--out", command]);
        assert!(
            printed.ends_with(&format!("picture: {command}/{command}.svg\n")),
            "{printed}"
        );
        let told = bench.done(&[command, "model.toml", "--format", "json"]);
        assert_eq!(bench.read(&format!("{command}/{command}.json")), told);
        assert!(
            bench
                .read(&format!("{command}/{command}.svg"))
                .starts_with("<svg")
        );
        assert_eq!(bench.files(command).len(), 2);
    }
}

/// A model without masses, and one whose poles repeat, are answered and not refused.
#[test]
fn verify_models_without_slopes() {
    let bench = Bench::new();
    let free = MODEL
        .replace("stiffness = 800.0", "stiffness = 0.0")
        .replace("damping = 4.0", "damping = 0.0");
    bench.write("free.toml", free);
    let found = json(&bench.done(&["sensitivity", "free.toml", "--format", "json"]));
    assert!(
        found["poles"]
            .as_array()
            .unwrap()
            .iter()
            .all(|pole| pole["parameters"].is_null())
    );
    // Twice at zero: a derivative is missing, and nothing fixes the level.
    assert_eq!(found["notes"].as_array().unwrap().len(), 2);
    bench.done(&["modes", "free.toml", "--out", "out"]);
}

#[test]
fn regress_what_is_refused() {
    let bench = Bench::good();
    let cases: [&[&str]; 5] = [
        &["modes", "nothing.toml"],
        &["modes", "A.csv"],
        &["sensitivity", "model.toml", "--tolerance", "0"],
        &["sensitivity", "model.toml", "--tolerance", "few"],
        &["modes", "model.toml", "--out", "A.csv"],
    ];
    let lines = cases.map(|case| bench.refused(case));
    insta::assert_snapshot!(lines.join("\n"));
}

/// The model file of the mold on two servo cylinders: heave on the oil, the leaf springs where the paper has many modes.
#[test]
fn verify_modes_of_the_mold_on_two_cylinders() {
    let fixture = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../fixtures/mold-on-cylinders/model.toml"
    );
    let modes = json(&Bench::new().done(&["modes", fixture, "--format", "json"]));
    // The levels of the pressures are told apart from what vibrates, and come last where poles are ranked.
    let kinds = |found: &Value| -> Vec<String> {
        let poles = found.as_array().unwrap().iter();
        poles
            .map(|pole| pole["kind"].as_str().unwrap().to_owned())
            .collect()
    };
    let kinds_of_modes = kinds(&modes["modes"]);
    assert_eq!(kinds_of_modes[..2], ["neutral", "neutral"]);
    assert_eq!(kinds_of_modes[2..4], ["real", "real"]);
    assert!(kinds_of_modes[4..].iter().all(|kind| kind == "oscillatory"));
    let ranked = json(&Bench::new().done(&["sensitivity", fixture, "--format", "json"]));
    let kinds_of_poles = kinds(&ranked["poles"]);
    assert_eq!(
        kinds_of_poles[kinds_of_poles.len() - 2..],
        ["neutral", "neutral"]
    );
    let first = &ranked["poles"][0];
    assert!((first["natural_freq_hz"].as_f64().unwrap() - 3.9).abs() < 0.1);
    let freqs: Vec<f64> = modes["modes"]
        .as_array()
        .unwrap()
        .iter()
        .filter_map(|mode| mode["natural_freq_hz"].as_f64())
        .collect();
    let near = |wanted: f64, within: f64| freqs.iter().any(|f| (f - wanted).abs() < within);
    // k = Σ β A²/V of all chambers at mid-stroke; leakage and the valves give way a little.
    let of_chamber = |area: f64| area * area / (5e-4 + 0.04 * area);
    let oil = 2.0 * 1.4e9 * (of_chamber(0.02) + of_chamber(0.012));
    let heave = (oil / 33_000.0).sqrt() / std::f64::consts::TAU;
    assert!(near(heave, 0.05 * heave), "{freqs:?} {heave}");
    // 1.028 h/L² √(E/ρ) of a clamped leaf spring, as the paper's cluster.
    let leaf = 1.028 * 0.01 / 1.06_f64.powi(2) * (2.1e11_f64 / 7850.0).sqrt();
    assert!(near(leaf, 0.01 * leaf), "{freqs:?}");
}
