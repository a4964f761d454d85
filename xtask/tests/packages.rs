//! Library crates are ready to be packaged: what `cargo package` would take is there, and enough.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The library crates: every crate but the program and the Python module.
const LIBRARIES: [&str; 17] = [
    "tables",
    "signal",
    "record",
    "model",
    "integrate",
    "effects",
    "mold",
    "alpha",
    "simulate",
    "estimate",
    "inference",
    "diagnose",
    "blind",
    "rigs",
    "report",
    "app",
    "fleet",
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
fn verify_no_library_is_left_out() {
    let folders = fs::read_dir(root().join("crates")).unwrap();
    let mut found: Vec<String> = folders
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .filter(|name| !["cli", "python"].contains(&name.as_str()))
        .collect();
    found.sort();
    let mut known = LIBRARIES;
    known.sort_unstable();
    assert_eq!(found, known);
}

/// Packs every crate against the packages of the others, as a registry would hold them.
#[test]
fn verify_every_library_is_packaged() {
    let folder = tempfile::tempdir().unwrap();
    let target = folder.path().to_str().unwrap();
    let mut arguments = vec!["package", "--no-verify", "--allow-dirty", "--offline"];
    arguments.extend(["--target-dir", target, "--workspace"]);
    arguments.extend(["--exclude", "xtask", "--exclude", "simgap-python"]);
    cargo(&arguments);
    for name in LIBRARIES {
        let package = folder
            .path()
            .join(format!("package/simgap-{name}-0.1.0.crate"));
        assert!(package.is_file(), "{}", package.display());
    }
}

/// Runs the examples of every library. Ignored because it builds them; `.ci/run` has them built and runs it.
#[test]
#[ignore = "builds every crate"]
fn verify_examples_run() {
    cargo(&["build", "--workspace", "--examples", "--offline"]);
    // This test is in `target/<profile>/deps`.
    let own = std::env::current_exe().unwrap();
    let built = own.parent().unwrap().parent().unwrap().join("examples");
    for name in LIBRARIES {
        for entry in fs::read_dir(root().join(format!("crates/{name}/examples"))).unwrap() {
            let source = entry.unwrap().path();
            let example = built.join(source.file_stem().unwrap());
            let folder = tempfile::tempdir().unwrap();
            let output = Command::new(&example)
                .arg(folder.path())
                .output()
                .unwrap_or_else(|error| panic!("{}: {error}", example.display()));
            let told = String::from_utf8_lossy(&output.stderr).into_owned();
            assert!(
                output.status.success(),
                "{name}: {}: {told}",
                source.display()
            );
        }
    }
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
    // Nor do they ask for arrays of ndarray, which their callers may not want.
    assert!(!needed("simgap-alpha").iter().any(|name| name == "ndarray"));
    // The rule can fail: the program itself reads them.
    assert!(needed("simgap-cli").iter().any(|name| name == "parquet"));
}
