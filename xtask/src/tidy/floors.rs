//! Rules on the crates: where they stand and what they reach.

use std::collections::BTreeSet;

use super::{Finding, Package, Workspace};

/// A finding in a manifest, at the first line that names `about`.
fn in_manifest(package: &Package, about: &str, message: String) -> Finding {
    let line = package.manifest_text.lines().position(|line| {
        let rest = line.trim_start().strip_prefix(about);
        rest.is_some_and(|rest| !rest.starts_with(|c: char| c.is_alphanumeric() || c == '-'))
    });
    Finding {
        file: package.manifest.clone(),
        line: line.map_or(1, |line| line + 1),
        message,
    }
}

/// Every crate says on which floor it stands.
#[must_use]
pub fn every_crate_declares_a_floor(workspace: &Workspace) -> Vec<Finding> {
    let without = |package: &&Package| package.floor.is_none();
    workspace
        .packages
        .iter()
        .filter(without)
        .map(|package| {
            let needed = "needed is floor = N in [package.metadata.simgap]";
            in_manifest(package, "[package", format!("no floor, {needed}"))
        })
        .collect()
}

/// A crate needs only crates on lower floors to be built. Tests, benches and examples may reach
/// sideways: they ship with nothing, and a cycle through them is none for whoever uses the crate.
#[must_use]
pub fn dependencies_point_down(workspace: &Workspace) -> Vec<Finding> {
    let mut findings = Vec::new();
    for package in &workspace.packages {
        for name in &package.normal {
            let below = workspace.package(name).and_then(|below| below.floor);
            let (Some(own), Some(below)) = (package.floor, below) else {
                continue;
            };
            if below >= own {
                let message = format!(
                    "{} on floor {own} depends on {name} on floor {below}, needed is a lower floor",
                    package.name
                );
                findings.push(in_manifest(package, name, message));
            }
        }
    }
    findings
}

/// Folder `crates/model` holds `simgap-model`.
#[must_use]
pub fn packages_are_named_after_their_folders(workspace: &Workspace) -> Vec<Finding> {
    let mut findings = Vec::new();
    for package in &workspace.packages {
        let needed = match package.manifest.starts_with("crates/") {
            true => format!("simgap-{}", package.folder),
            false => package.folder.clone(),
        };
        if package.name != needed {
            let message = format!("package {}, needed is {needed}", package.name);
            findings.push(in_manifest(package, "name", message));
        }
    }
    findings
}

/// The diagnosis cannot reach the cases it is scored on, over no path, not even in its tests.
#[must_use]
pub fn diagnosis_cannot_reach_the_cases(workspace: &Workspace) -> Vec<Finding> {
    const FROM: &str = "simgap-diagnose";
    const TO: &str = "simgap-blind";
    let mut findings = Vec::new();
    let mut seen = BTreeSet::new();
    let mut open = vec![FROM.to_owned()];
    while let Some(name) = open.pop() {
        let Some(package) = workspace.package(&name) else {
            continue;
        };
        if !seen.insert(name) {
            continue;
        }
        for next in package.normal.iter().chain(&package.other) {
            if next == TO {
                let message = format!("{FROM} reaches {TO} through {}", package.name);
                findings.push(in_manifest(package, TO, message));
            }
            open.push(next.clone());
        }
    }
    findings
}

/// Every crate takes the lints of the workspace, which forbid unsafe code and printing.
#[must_use]
pub fn every_crate_takes_the_lints_of_the_workspace(workspace: &Workspace) -> Vec<Finding> {
    let takes = |package: &&Package| {
        let mut lines = package.manifest_text.lines();
        lines.any(|line| line.trim() == "[lints]")
            && lines.next().map(str::trim) == Some("workspace = true")
    };
    let all = workspace.packages.iter();
    all.filter(|package| !takes(package))
        .map(|package| {
            let message = "needed is [lints] with workspace = true".to_owned();
            in_manifest(package, "[lints]", message)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn package(folder: &str, floor: u64, normal: &[&str], other: &[&str]) -> Package {
        let owned = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect();
        Package {
            name: format!("simgap-{folder}"),
            folder: folder.to_owned(),
            manifest: format!("crates/{folder}/Cargo.toml"),
            manifest_text: format!(
                "[package]\n[lints]\nworkspace = true\n{}\n",
                normal.join("\n")
            ),
            floor: Some(floor),
            normal: owned(normal),
            other: owned(other),
        }
    }

    fn sound() -> Workspace {
        Workspace {
            packages: vec![
                package("model", 1, &[], &[]),
                package("diagnose", 6, &["simgap-model"], &[]),
                package("blind", 6, &["simgap-model"], &["simgap-diagnose"]),
            ],
            ..Workspace::default()
        }
    }

    fn messages(rule: super::super::Rule, workspace: &Workspace) -> Vec<String> {
        rule(workspace).iter().map(Finding::to_string).collect()
    }

    #[test]
    fn verify_a_sound_workspace_passes() {
        let workspace = sound();
        for rule in super::super::RULES {
            assert_eq!(messages(*rule, &workspace), [""; 0]);
        }
    }

    #[test]
    fn verify_each_rule_on_crates_can_fail() {
        let mut workspace = sound();
        workspace.packages[0].floor = None;
        assert_eq!(
            messages(every_crate_declares_a_floor, &workspace),
            [
                "crates/model/Cargo.toml:1: no floor, needed is floor = N in [package.metadata.simgap]"
            ]
        );

        let mut workspace = sound();
        workspace.packages[0].floor = Some(6);
        assert_eq!(
            messages(dependencies_point_down, &workspace)[0],
            "crates/diagnose/Cargo.toml:4: simgap-diagnose on floor 6 depends on simgap-model on \
             floor 6, needed is a lower floor"
        );

        let mut workspace = sound();
        workspace.packages[0].name = "model".into();
        assert_eq!(
            messages(packages_are_named_after_their_folders, &workspace).len(),
            1
        );

        let mut workspace = sound();
        workspace.packages[0].manifest_text = "[package]\n[lints.rust]\n".into();
        assert_eq!(
            messages(every_crate_takes_the_lints_of_the_workspace, &workspace).len(),
            1
        );
    }

    #[test]
    fn verify_a_detour_to_the_cases_is_found() {
        let mut workspace = sound();
        workspace.packages[0].other = vec!["simgap-blind".into()];
        assert_eq!(
            messages(diagnosis_cannot_reach_the_cases, &workspace),
            [
                "crates/model/Cargo.toml:1: simgap-diagnose reaches simgap-blind through simgap-model"
            ]
        );
    }
}
