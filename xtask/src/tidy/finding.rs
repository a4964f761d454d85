//! What breaks a rule.

use std::fmt;

use super::Source;

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

impl Finding {
    /// A finding in a Rust file.
    pub(super) fn in_source(source: &Source, line: usize, message: String) -> Finding {
        Finding {
            file: source.path.clone(),
            line,
            message,
        }
    }
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}: {}", self.file, self.line, self.message)
    }
}
