//! Library crates are ready to be packaged: what `cargo package` would take is there, and enough.
#![allow(clippy::unwrap_used, clippy::expect_used)]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The library crates that are packaged so far.
const LIBRARIES: [&str; 8] = [
    "tables",
    "signal",
    "record",
    "model",
    "integrate",
    "mold",
    "alpha",
    "report",
];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn cargo(arguments: &[&str]) -> String {
    let output = Command::new(env!("CARGO"))
        .args(arguments)
        .current_dir(root())
        .output()
        .unwrap();
    let told = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{arguments:?}: {told}");
    String::from_utf8(output.stdout).unwrap()
}

fn manifest(name: &str) -> String {
    fs::read_to_string(root().join(format!("crates/{name}/Cargo.toml"))).unwrap()
}

#[test]
fn verify_packages_hold_what_they_need() {
    for name in LIBRARIES {
        let package = format!("simgap-{name}");
        let listed = cargo(&[
            "package",
            "--list",
            "--allow-dirty",
            "--offline",
            "-p",
            &package,
        ]);
        let files: Vec<&str> = listed.lines().collect();
        assert!(files.contains(&"README.md"), "{name}: no README.md");
        assert!(files.contains(&"src/lib.rs"), "{name}");
        let example = |file: &str| file.starts_with("examples/") && file.ends_with(".rs");
        assert!(files.iter().any(|file| example(file)), "{name}: no example");
        if name == "tables" {
            let fixtures = files
                .iter()
                .filter(|file| file.ends_with(".toml") && file.starts_with("fixtures/"));
            assert_eq!(
                fixtures.count(),
                6,
                "the printed numbers are in the package"
            );
        }
    }
}

/// No source of a packaged library takes a file from outside its crate.
#[test]
fn verify_packages_take_nothing_from_outside() {
    for name in LIBRARIES {
        let folder = root().join(format!("crates/{name}/src"));
        let mut waiting = vec![folder];
        while let Some(at) = waiting.pop() {
            for entry in fs::read_dir(at).unwrap() {
                let path = entry.unwrap().path();
                if path.is_dir() {
                    waiting.push(path);
                    continue;
                }
                let text = fs::read_to_string(&path).unwrap();
                for taken in text.lines().filter(|line| line.contains("include_")) {
                    let inside = path
                        .strip_prefix(root().join(format!("crates/{name}")))
                        .unwrap();
                    let deep = inside.components().count() - 1;
                    let up = taken.matches("../").count();
                    assert!(up <= deep, "{}: {taken}", path.display());
                }
            }
        }
    }
}

#[test]
fn verify_manifests_are_complete() {
    for name in LIBRARIES {
        let manifest = manifest(name);
        for key in [
            "description",
            "license",
            "readme",
            "keywords",
            "categories",
            "version",
        ] {
            assert!(
                manifest.lines().any(|line| line.starts_with(key)),
                "{name}: no {key}"
            );
        }
    }
    let workspace = fs::read_to_string(root().join("Cargo.toml")).unwrap();
    let paths = workspace
        .lines()
        .filter(|line| line.contains("path = \"crates/"));
    let mut count = 0;
    for line in paths {
        assert!(line.contains("version = \""), "no version: {line}");
        count += 1;
    }
    assert!(count >= LIBRARIES.len());
}

/// What one crate needs, itself left out.
fn needed(package: &str) -> Vec<String> {
    let tree = cargo(&[
        "tree",
        "--offline",
        "-e",
        "normal",
        "--prefix",
        "none",
        "--format",
        "{p}",
        "-p",
        package,
    ]);
    let mut names: Vec<String> = tree
        .lines()
        .filter_map(|line| line.split(' ').next())
        .filter(|name| !name.is_empty() && *name != package)
        .map(str::to_owned)
        .collect();
    names.sort();
    names.dedup();
    names
}

/// The paper's own crates read no Parquet and no HDF5.
#[test]
fn verify_the_mold_drags_no_file_formats() {
    for package in ["simgap-mold", "simgap-alpha"] {
        let names = needed(package);
        for heavy in ["parquet", "hdf5-pure", "ruzstd", "snap"] {
            assert!(
                !names.iter().any(|name| name == heavy),
                "{package} needs {heavy}"
            );
        }
    }
    // The rule can fail: the program itself reads them.
    assert!(needed("simgap-cli").iter().any(|name| name == "parquet"));
}
