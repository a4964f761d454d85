//! The commands that explain: the catalogue, records, completions and manual.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use std::collections::BTreeSet;
use std::fmt::Write as _;

use crate::common::{self, Bench, record};
use serde_json::Value;

/// Names of the commands, as the help lists them.
fn commands(bench: &Bench) -> Vec<String> {
    let help = bench.done(&["--help"]);
    let (_, list) = help.split_once("Commands:\n").unwrap();
    let lines = list.lines().take_while(|line| !line.is_empty());
    // A description that goes on is indented further.
    let named = lines.filter_map(|line| line.strip_prefix("  "));
    let named = named.filter(|line| !line.starts_with([' ', '-']));
    let words = named.map(|line| line.split(' ').next().unwrap().to_string());
    words.filter(|word| word != "help").collect()
}

#[test]
fn regress_help() {
    let bench = Bench::new();
    let mut text = bench.done(&["--help"]);
    for command in commands(&bench) {
        writeln!(text, "\n==== {command}").unwrap();
        text += &bench.done(&[&command, "--help"]);
    }
    insta::assert_snapshot!(text);
}

#[test]
fn regress_an_effect_explained() {
    let bench = Bench::new();
    let explained = ["presliding_friction", "clipping", "tone_pickup"];
    let text = explained.map(|kind| bench.done(&["effects", kind]));
    insta::assert_snapshot!(text.join("\n"));
}

#[test]
fn regress_an_effect_that_is_not_there() {
    let bench = Bench::new();
    let asked = ["coulomb", "Clippping", "sensor-lag", "friction", "zzz", ""];
    let lines = asked.map(|kind| bench.refused(&["effects", kind]));
    insta::assert_snapshot!(lines.join("\n"));
}

/// The list for people, the list for machines and each page speak of the same kinds.
#[test]
fn verify_the_catalogue_is_whole() {
    let bench = Bench::new();
    let all: Value = serde_json::from_str(&bench.done(&["effects", "--format", "json"])).unwrap();
    assert_eq!(all["schema"], "simgap-effects/1");
    let effects = all["effects"].as_array().unwrap();
    let kinds: BTreeSet<&str> = effects
        .iter()
        .map(|e| e["kind"].as_str().unwrap())
        .collect();
    assert_eq!(kinds.len(), effects.len());
    let list = bench.done(&["effects"]);
    let listed = list.lines().filter_map(|line| line.strip_prefix("  "));
    let listed: BTreeSet<&str> = listed.map(|l| l.split(' ').next().unwrap()).collect();
    assert_eq!(listed, kinds);
    for effect in effects {
        let kind = effect["kind"].as_str().unwrap();
        let one = bench.done(&["effects", kind, "--format", "json"]);
        let one: Value = serde_json::from_str(&one).unwrap();
        assert_eq!(
            one["effects"].as_array().unwrap(),
            std::slice::from_ref(effect)
        );
        let page = bench.done(&["effects", kind]);
        for parameter in effect["parameters"].as_array().unwrap() {
            let name = parameter["name"].as_str().unwrap();
            assert!(page.contains(name), "{kind}: {name} is not on the page");
        }
        for other in effect["confused_with"].as_array().unwrap() {
            let other = other["kind"].as_str().unwrap();
            assert!(kinds.contains(other), "{kind} is confused with {other}");
        }
    }
}

#[test]
fn regress_records_checked() {
    let bench = Bench::new();
    bench.write("A.csv", record(60));
    // Another rate, another unit, another column, a range that is too small, time in ms.
    let mut other = String::from("t [ms],u [kN],y [mm],T [degC]\n");
    for k in 0..100 {
        let angle = 0.1 * f64::from(k);
        let (u, y) = (angle.cos(), (1.3 * angle.sin()).clamp(-1.0, 1.0));
        writeln!(other, "{},{u:.6},{y:.6},21.5", 2 * k).unwrap();
    }
    bench.write("B.csv", &other);
    let text = bench.done(&["check", "A.csv", "B.csv"]);
    let json = bench.done(&["check", "B.csv", "--format", "json"]);
    insta::assert_snapshot!(format!("{text}\n{json}"));
}

#[test]
fn regress_records_that_cannot_be_checked() {
    let bench = Bench::new();
    bench.write("A.csv", record(60));
    bench.write("B.csv", "t [s],y\n0,1\n");
    let asked: [&[&str]; 3] = [
        &["check"],
        &["check", "A.csv", "B.csv"],
        &["check", "C.csv"],
    ];
    let lines = asked.map(|arguments| bench.refused(arguments));
    insta::assert_snapshot!(lines.join("\n"));
}

#[test]
fn verify_every_command_has_completions_and_a_manual_page() {
    let bench = Bench::new();
    let commands = commands(&bench);
    assert!(commands.len() > 5);
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let script = bench.done(&["completions", shell]);
        for command in &commands {
            assert!(script.contains(command.as_str()), "{shell}: {command}");
        }
    }
    bench.done(&["man", "--out", "man"]);
    let main = bench.read("man/simgap.1");
    assert_eq!(bench.done(&["man"]), main);
    for command in &commands {
        let page = bench.read(&format!("man/simgap-{command}.1"));
        assert!(page.contains(&format!(".TH simgap-{command} 1")), "{page}");
        assert!(
            main.contains(&format!("simgap\\-{command}(1)")),
            "{command}"
        );
    }
    bench.refused(&["completions", "tcsh"]);
}

/// A terminal is asked for, so that colours are all that is missing off one.
#[test]
fn verify_colours_are_for_terminals() {
    let bench = Bench::new();
    let mut forced = bench.simgap(&["effects", "clipping"]);
    let forced = forced.env("CLICOLOR_FORCE", "1").output().unwrap();
    let forced = String::from_utf8(forced.stdout).unwrap();
    assert!(forced.contains('\u{1b}'), "{forced:?}");
    let plain = bench.done(&["effects", "clipping"]);
    assert!(!plain.contains('\u{1b}'), "{plain:?}");
    assert_eq!(anstream::adapter::strip_str(&forced).to_string(), plain);
    let mut refused = bench.simgap(&["effects", "clipping"]);
    let refused = refused.env("CLICOLOR_FORCE", "1").env("NO_COLOR", "1");
    let refused = String::from_utf8(refused.output().unwrap().stdout).unwrap();
    assert_eq!(refused, plain);
}

/// What a person at a terminal is shown below the one line.
#[test]
fn regress_the_place_is_pointed_at() {
    let bench = Bench::good();
    let good = record(60);
    let mut lines: Vec<&str> = good.lines().collect();
    lines[6] = "0.05,off,0.001";
    bench.write("A.csv", lines.join("\n"));
    let twice = common::MODEL.replace("value = 2.0", "value = = 2.0");
    let strangers = common::MODEL.replace("[\"block\", \"ground\"]", "[\"blok\", \"ground\"]");
    bench.write("broken.toml", twice);
    bench.write("strange.toml", strangers);
    bench.write(
        "light.toml",
        common::MODEL.replace("value = 2.0", "value = -2.0   # kg"),
    );
    bench.write("later.toml", common::MODEL.replace("model/1", "model/2"));
    let effect = "[[effect]]\nkind = \"coulomb_friction\"\nbetween = [\"block\", \"ground\"]\n";
    let parameter = "friction_n = 1.0\n";
    bench.write("effect.toml", [common::MODEL, effect, parameter].join("\n"));
    let velocity = common::MODEL.replace("\"displacement\"", "\"velocity\"");
    bench.write("velocity.toml", velocity);
    bench.write("good.csv", &good);
    let mut told = String::new();
    for (model, record) in [
        ("model.toml", "A.csv"),
        ("broken.toml", "A.csv"),
        ("strange.toml", "A.csv"),
        ("light.toml", "A.csv"),
        ("later.toml", "A.csv"),
        ("effect.toml", "A.csv"),
        ("velocity.toml", "good.csv"),
        ("none.toml", "A.csv"),
    ] {
        let arguments = ["simulate", model, "--record", record, "--out", "p.csv"];
        let mut command = bench.simgap(&arguments);
        let output = command.env("CLICOLOR_FORCE", "1").output().unwrap();
        let shown = String::from_utf8(output.stderr).unwrap();
        told += &anstream::adapter::strip_str(&shown).to_string();
        told += "\n";
        // Off a terminal it is one line, as everywhere.
        let line = bench.refused(&arguments);
        assert!(told.contains(&line), "{told}");
    }
    insta::assert_snapshot!(told);
}

/// Kinds are completed where a kind is asked for.
#[test]
fn verify_kinds_are_completed() {
    let bench = Bench::new();
    // That of fish completes options only.
    for (shell, places) in [("bash", 2), ("zsh", 2), ("fish", 1)] {
        let script = bench.done(&["completions", shell]);
        let uses = script.matches("time_varying_stiffness").count();
        assert!(uses >= places, "{shell}: {uses}");
    }
}

/// What is legal and yet hardly meant is said.
#[test]
fn verify_what_is_hardly_meant_is_said() {
    let bench = Bench::good();
    let idle = "\n[[mass]]\nname = \"loose\"\nvalue = 1.0\n";
    bench.write("idle.toml", [common::MODEL, idle].concat());
    let said = bench.done(&[
        "simulate",
        "idle.toml",
        "--record",
        "A.csv",
        "--out",
        "p.csv",
    ]);
    assert!(
        said.contains("nothing joins, drives or measures mass 'loose'"),
        "{said}"
    );
    let inputs: String = record(60)
        .lines()
        .map(|line| line.rsplit_once(',').unwrap().0.to_owned() + "\n")
        .collect();
    bench.write("U.csv", inputs);
    let plain = [
        "simulate",
        "model.toml",
        "--record",
        "U.csv",
        "--out",
        "p.csv",
    ];
    assert!(bench.done(&plain).contains("starts at rest"));
    let meant = [&plain[..], &["--from-rest"]].concat();
    assert!(!bench.done(&meant).contains("starts at rest"));
    let own = [
        "diagnose",
        "model.toml",
        "--train",
        "A.csv",
        "--check",
        "A.csv",
        "--out",
        "out",
    ];
    let line = bench.refused(&own);
    assert!(line.contains("repeats the training record"), "{line}");
}
