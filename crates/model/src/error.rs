//! What can be wrong with a model, and where.

use thiserror::Error;

/// Why a model is refused. `place` names the table and the item, such as `[[spring]] "cylinder"`.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum ModelError {
    /// The text is not TOML, or a key is missing, unknown or of the wrong type.
    #[error("line {line}, column {column}: {found}")]
    Syntax {
        /// Line of the model file, from 1.
        line: usize,
        /// Character of the line, from 1.
        column: usize,
        /// What the parser found and what it needs.
        found: String,
    },
    /// The `schema` key names another format.
    #[error("schema is \"{found}\", needed is \"{needed}\"")]
    Schema {
        /// As written.
        found: String,
        /// The schema this version reads.
        needed: &'static str,
    },
    /// A name that must be unique is used twice.
    #[error("{place}: the name is used twice, needed is a different name for each")]
    DuplicateName {
        /// Table and item.
        place: String,
    },
    /// A name that cannot be used.
    #[error("{place}: \"{found}\" cannot be a name here, {needed}")]
    BadName {
        /// Table and item.
        place: String,
        /// As written.
        found: String,
        /// What is needed.
        needed: &'static str,
    },
    /// A node that no mass and no moving base defines.
    #[error("{place}: unknown node \"{found}\", needed is one of: {known}")]
    UnknownNode {
        /// Table and item.
        place: String,
        /// As written.
        found: String,
        /// Nodes of the model, separated by commas.
        known: String,
    },
    /// A channel that no input or output of the model names.
    #[error("{place}: unknown channel \"{found}\", needed is one of: {known}")]
    UnknownChannel {
        /// Table and item.
        place: String,
        /// As written.
        found: String,
        /// Channels of that kind, separated by commas.
        known: String,
    },
    /// A value outside its range.
    #[error("{place}: {quantity} is {found}, needed is {needed}")]
    Value {
        /// Table and item.
        place: String,
        /// The key.
        quantity: String,
        /// As written.
        found: f64,
        /// The valid range.
        needed: &'static str,
    },
    /// Keys that do not belong together, or one that is missing beside another.
    #[error("{place}: {found}, needed is {needed}")]
    Shape {
        /// Table and item.
        place: String,
        /// What was found.
        found: String,
        /// What is needed.
        needed: String,
    },
    /// A matrix that must be invertible is not.
    #[error("{matrix} is singular ({context}), needed is an invertible matrix")]
    Singular {
        /// Which matrix.
        matrix: &'static str,
        /// Where it was met.
        context: String,
    },
    /// The eigenvalue iteration failed.
    #[error("the eigenvalues of the {matrix} were not found: the iteration did not converge")]
    Eigen {
        /// Which matrix.
        matrix: &'static str,
    },
    /// The search for rest under the loads did not end.
    #[error(
        "no rest under the loads was found in {steps} steps, needed is a model that can carry its loads"
    )]
    Rest {
        /// Steps tried.
        steps: usize,
    },
}
