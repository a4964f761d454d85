//! `cargo xtask tidy`: the rules that keep the workspace in shape, each a function from what the
//! workspace holds to what breaks the rule. `tests/structure.rs` runs the same rules.
//!
//! Rules on sources read library code only: comments and `#[cfg(test)]` modules are set aside,
//! unless a rule says otherwise. They work on the text of lines, so that they need no compiler;
//! what a macro assembles is not seen.

mod circles;
mod error;
mod finding;
mod floors;
mod modules;
mod references;
mod sources;
mod tests_run;
mod text;
mod tokens;
mod workspace;

pub use circles::no_file_imports_itself_over_others;
pub use error::TidyError;
pub use finding::Finding;
pub use floors::{
    dependencies_point_down, diagnosis_cannot_reach_the_cases, every_crate_declares_a_floor,
    every_crate_takes_the_lints_of_the_workspace, packages_are_named_after_their_folders,
};
pub use references::{every_reference_resolves, every_source_listed_is_cited};
pub use sources::{
    files_are_short, integrators_know_no_effect, libraries_are_silent_and_still, nothing_is_unsafe,
    published_numbers_are_only_embedded, who_may_touch_files,
};
pub use tests_run::every_test_file_is_run;
pub use workspace::{Package, Source, Workspace};

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
    no_file_imports_itself_over_others,
    every_reference_resolves,
    every_source_listed_is_cited,
    every_test_file_is_run,
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
