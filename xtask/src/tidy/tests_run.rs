//! No test is left out: where the tests of a package are one program, a file that it does not name would never be run.

use super::{Finding, Source, Workspace};

/// Files directly in `tests` are programs of tests, or modules of the one that holds them all.
#[must_use]
pub fn every_test_file_is_run(workspace: &Workspace) -> Vec<Finding> {
    let mut findings = Vec::new();
    for package in &workspace.packages {
        let own = package.manifest.trim_end_matches("Cargo.toml");
        let folder = format!("{own}tests/");
        let is_declared = |key: &str| package.manifest_text.lines().any(|line| line == key);
        if !is_declared("autotests = false") {
            continue;
        }
        let all = workspace
            .sources
            .iter()
            .find(|s| s.path == format!("{folder}all.rs"));
        for source in &workspace.sources {
            let Some(name) = test_file(source, &folder) else {
                continue;
            };
            let is_module =
                all.is_some_and(|all| all.text.lines().any(|line| line == format!("mod {name};")));
            if !is_module && !is_declared(&format!("name = \"{name}\"")) {
                let message = format!(
                    "no program of tests of {} holds it, needed is `mod {name};` in tests/all.rs",
                    package.name
                );
                findings.push(Finding::in_source(source, 1, message));
            }
        }
    }
    findings
}

/// Name of a file directly in the folder.
fn test_file<'a>(source: &'a Source, folder: &str) -> Option<&'a str> {
    let name = source.path.strip_prefix(folder)?.strip_suffix(".rs")?;
    (!name.contains('/')).then_some(name)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tidy::Package;

    #[test]
    fn verify_a_test_file_that_nothing_runs_is_found() {
        let source = |path: &str, text: &str| Source {
            path: path.to_owned(),
            text: text.to_owned(),
        };
        let mut workspace = Workspace {
            packages: vec![Package {
                name: "simgap-model".to_owned(),
                folder: "model".to_owned(),
                manifest: "crates/model/Cargo.toml".to_owned(),
                manifest_text:
                    "autotests = false\n[[test]]\nname = \"all\"\n[[test]]\nname = \"apart\"\n"
                        .to_owned(),
                floor: None,
                normal: vec![],
                other: vec![],
            }],
            sources: vec![
                source("crates/model/tests/all.rs", "mod known;\n"),
                source("crates/model/tests/apart.rs", ""),
                source("crates/model/tests/common/part.rs", ""),
                source("crates/model/tests/known.rs", ""),
                source("crates/model/tests/lost.rs", ""),
            ],
            ..Workspace::default()
        };
        let found = every_test_file_is_run(&workspace);
        let files: Vec<&str> = found.iter().map(|finding| finding.file.as_str()).collect();
        assert_eq!(files, ["crates/model/tests/lost.rs"]);
        // Cargo runs every file then.
        workspace.packages[0].manifest_text.clear();
        assert!(every_test_file_is_run(&workspace).is_empty());
    }
}
