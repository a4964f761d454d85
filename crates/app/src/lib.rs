//! What the `simgap` program and the Python module share: models and records are read, a question is
//! asked, and the result is put in place as files.
//!
//! Each question is a module: [`diagnosis`], [`simulation`], [`comparison`], [`modes`], [`effects`]. It
//! takes what was read ([`input`]), calls the crates below, and gives the text of every result file, so
//! that the same input gives the same bytes whoever asks. Only folders of results and files that
//! are read ([`folder`], [`input`], [`manifest`]) touch the disk; nothing prints and nothing reads a
//! clock.

pub mod comparison;
pub mod diagnosis;
pub mod effects;
mod error;
pub mod folder;
pub mod input;
pub mod manifest;
pub mod modes;
mod repeated;
pub mod simulation;
pub mod text;

pub use error::AppError;

/// The text of a JSON file or of `--format json`: indented, with a line break at the end.
///
/// # Errors
/// [`AppError::Json`] when the value cannot be written as JSON.
pub fn json(value: &impl serde::Serialize) -> Result<String, AppError> {
    let text = serde_json::to_string_pretty(value).map_err(|error| AppError::Json {
        found: error.to_string(),
    })?;
    Ok(text + "\n")
}
