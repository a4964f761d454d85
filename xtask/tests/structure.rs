//! The shape of the workspace: invariants, most of them about what is absent. Each is a rule of
//! `xtask::tidy`, where a test of its own shows that it can fail.
#![allow(clippy::unwrap_used, clippy::panic)]

use std::path::Path;

use xtask::tidy::{self, Rule, Workspace};

fn workspace() -> Workspace {
    Workspace::load().unwrap_or_else(|error| panic!("{error}"))
}

fn assert_clean(rule: Rule) {
    let workspace = workspace();
    let findings: Vec<String> = rule(&workspace).iter().map(ToString::to_string).collect();
    assert!(findings.is_empty(), "\n{}", findings.join("\n"));
}

#[test]
fn verify_the_rules_see_the_workspace() {
    // Rules on nothing would pass.
    let workspace = workspace();
    assert!(workspace.packages.len() >= 15 && workspace.sources.len() >= 100);
    assert!(workspace.kinds.len() >= 16 && !workspace.references.is_empty());
    let has = |names: &[String], name: &str| names.iter().any(|found| found == name);
    let diagnose = workspace.package("simgap-diagnose").unwrap();
    assert!(has(&diagnose.normal, "simgap-estimate") && diagnose.floor.is_some());
    assert!(!has(&diagnose.normal, "rayon"));
    let estimate = workspace.package("simgap-estimate").unwrap();
    assert!(has(&estimate.other, "simgap-record"));
    for path in ["crates/model/src/lib.rs", "xtask/tests/structure.rs"] {
        assert!(workspace.sources.iter().any(|source| source.path == path));
    }
}

#[test]
fn verify_every_crate_declares_a_floor() {
    assert_clean(tidy::every_crate_declares_a_floor);
}

#[test]
fn verify_dependencies_point_down() {
    assert_clean(tidy::dependencies_point_down);
}

#[test]
fn verify_packages_are_named_after_their_folders() {
    assert_clean(tidy::packages_are_named_after_their_folders);
}

#[test]
fn verify_the_diagnosis_cannot_reach_the_cases() {
    assert_clean(tidy::diagnosis_cannot_reach_the_cases);
}

#[test]
fn verify_every_crate_takes_the_lints_of_the_workspace() {
    assert_clean(tidy::every_crate_takes_the_lints_of_the_workspace);
}

#[test]
fn verify_libraries_are_silent_and_still() {
    assert_clean(tidy::libraries_are_silent_and_still);
}

#[test]
fn verify_who_touches_files() {
    assert_clean(tidy::who_may_touch_files);
}

#[test]
fn verify_integrators_know_no_effect() {
    assert_clean(tidy::integrators_know_no_effect);
}

#[test]
fn verify_published_numbers_are_only_embedded() {
    assert_clean(tidy::published_numbers_are_only_embedded);
}

#[test]
fn verify_nothing_is_unsafe() {
    assert_clean(tidy::nothing_is_unsafe);
}

#[test]
fn verify_files_are_short() {
    assert_clean(tidy::files_are_short);
}

#[test]
fn verify_no_file_imports_itself_over_others() {
    assert_clean(tidy::no_file_imports_itself_over_others);
}

#[test]
fn verify_references_resolve() {
    assert_clean(tidy::every_reference_resolves);
    assert_clean(tidy::every_source_listed_is_cited);
}

#[test]
fn verify_every_test_file_is_run() {
    assert_clean(tidy::every_test_file_is_run);
}

#[test]
fn verify_the_commands_of_the_readme_are_run() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let read = |path: &str| std::fs::read_to_string(root.join(path)).unwrap();
    let (readme, run) = (read("README.md"), read(".ci/run"));
    for command in [
        "cargo run --bin simgap -- demo",
        "cargo test --workspace",
        "cargo xtask reproduce-paper --check",
    ] {
        assert!(
            readme.lines().any(|line| line == command),
            "README.md: {command}"
        );
        assert!(run.contains(command), ".ci/run: {command}");
    }
}

#[test]
fn verify_every_rule_is_run_by_the_command() {
    // `cargo xtask tidy` runs RULES; each line above is one of them.
    assert_eq!(tidy::RULES.len(), 15);
}

#[test]
fn verify_the_page_on_effects_is_current() {
    let differences = xtask::effects_docs::differences().unwrap();
    assert!(differences.is_empty(), "\n{}", differences.join("\n"));
}
