//! Whose a finding is.

use serde::Serialize;

/// Whose a finding is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Scope {
    /// All machines: the model lacks it.
    Common,
    /// Machines of their own.
    Machine,
    /// Days, rigs, loads: no machine is to blame.
    Condition,
    /// What differs between machines differs in something else as well: nobody is to blame.
    Undecided,
}
