//! Writing the generated files, or comparing them with what is committed.

use std::collections::BTreeMap;
use std::fmt;
use std::path::Path;

use super::ReproduceError;
use crate::generated::{self, Change};

/// Directories that hold nothing but generated files.
const GENERATED: [&str; 2] = ["docs/reproduction", "fixtures/reproduction"];

/// What became of the generated files.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Outcome {
    /// So many were written.
    Written(usize),
    /// So many are committed as generated.
    Same(usize),
    /// These are not; each line names a file and what is wrong.
    Differs(Vec<String>),
}

impl Outcome {
    /// Whether the exit status is zero.
    #[must_use]
    pub fn is_clean(&self) -> bool {
        !matches!(self, Self::Differs(_))
    }
}

impl fmt::Display for Outcome {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Written(count) => write!(f, "reproduce-paper: {count} files written"),
            Self::Same(count) => write!(f, "reproduce-paper: {count} files are as generated"),
            Self::Differs(lines) => {
                write!(f, "reproduce-paper: {} files differ", lines.len())?;
                lines.iter().try_for_each(|line| write!(f, "\n  {line}"))
            }
        }
    }
}

/// Writes every file and removes generated files that are no longer generated.
pub(crate) fn write(
    root: &Path,
    files: &BTreeMap<String, String>,
) -> Result<Outcome, ReproduceError> {
    generated::write(root, &GENERATED, files)?;
    Ok(Outcome::Written(files.len()))
}

/// Compares byte for byte.
pub(crate) fn compare(
    root: &Path,
    files: &BTreeMap<String, String>,
) -> Result<Outcome, ReproduceError> {
    let changes = generated::compare(root, &GENERATED, files)?;
    if changes.is_empty() {
        return Ok(Outcome::Same(files.len()));
    }
    let line = |(name, change)| match change {
        Change::Missing => format!("{name}: missing"),
        Change::FromLine(line) => format!("{name}: differs from line {line} on"),
        Change::Strange => format!("{name}: not generated"),
    };
    Ok(Outcome::Differs(changes.into_iter().map(line).collect()))
}
