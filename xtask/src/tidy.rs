//! `cargo xtask tidy`: the rules that keep the workspace in shape, each a function from what the
//! workspace holds to what breaks the rule. `tests/structure.rs` runs the same rules.
//!
//! Rules on sources read library code only: comments and `#[cfg(test)]` modules are set aside,
//! unless a rule says otherwise. They work on the text of lines, so that they need no compiler;
//! what a macro assembles is not seen.

mod floors;
mod references;
mod sources;
mod text;
mod workspace;

use std::fmt;
use std::path::PathBuf;

use thiserror::Error;

pub use floors::{
    dependencies_point_down, diagnosis_cannot_reach_the_cases, every_crate_declares_a_floor,
    every_crate_takes_the_lints_of_the_workspace, packages_are_named_after_their_folders,
};
pub use references::{every_reference_resolves, every_source_listed_is_cited};
pub use sources::{
    files_are_short, integrators_know_no_effect, libraries_are_silent_and_still, nothing_is_unsafe,
    published_numbers_are_only_embedded, who_may_touch_files,
};
pub use workspace::{Package, Source, Workspace};

/// Something that breaks a rule, and where.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Finding {
    /// Path from the root of the workspace.
    pub file: String,
    /// Line, from 1.
    pub line: usize,
    /// What was found and what is needed.
    pub message: String,
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}: {}", self.file, self.line, self.message)
    }
}

/// Why the rules could not be checked.
#[derive(Debug, Error)]
pub enum TidyError {
    /// Cargo could not be started.
    #[error("cargo metadata could not be started ({source})")]
    Start {
        /// What the system says.
        source: std::io::Error,
    },
    /// Cargo refused.
    #[error("cargo metadata failed: {found}")]
    Cargo {
        /// What it wrote.
        found: String,
    },
    /// Cargo wrote something else than expected.
    #[error("cargo metadata wrote what cannot be read ({source})")]
    Metadata {
        /// What the reader says.
        source: serde_json::Error,
    },
    /// A file.
    #[error("{path}: cannot be read ({source})", path = .path.display())]
    File {
        /// Which file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
}

/// A rule: from the workspace to what breaks it.
pub type Rule = fn(&Workspace) -> Vec<Finding>;

/// Every rule.
pub const RULES: &[Rule] = &[
    every_crate_declares_a_floor,
    dependencies_point_down,
    packages_are_named_after_their_folders,
    diagnosis_cannot_reach_the_cases,
    every_crate_takes_the_lints_of_the_workspace,
    libraries_are_silent_and_still,
    who_may_touch_files,
    integrators_know_no_effect,
    published_numbers_are_only_embedded,
    nothing_is_unsafe,
    files_are_short,
    every_reference_resolves,
    every_source_listed_is_cited,
];

/// Checks every rule on the workspace this program was built in; one line for each finding.
///
/// # Errors
/// [`TidyError`] when the workspace cannot be read.
pub fn run() -> Result<Vec<String>, TidyError> {
    let workspace = Workspace::load()?;
    Ok(RULES
        .iter()
        .flat_map(|rule| rule(&workspace))
        .map(|finding| finding.to_string())
        .collect())
}

/// The README's example is compiled and run.
#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
struct Readme;
