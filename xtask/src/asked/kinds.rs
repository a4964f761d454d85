//! What is said, without numbers.

use std::fmt;

use serde::{Deserialize, Serialize};
use simgap_rigs::Diagnosis;

/// What is said, without numbers: status and kinds, in their order.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Kinds {
    pub(crate) status: String,
    pub(crate) kinds: Vec<String>,
}

impl Kinds {
    pub(crate) fn of(diagnosis: Option<&Diagnosis>) -> Kinds {
        let Some(diagnosis) = diagnosis else {
            return Kinds {
                status: "no answer".into(),
                kinds: vec![],
            };
        };
        let effects = diagnosis.verdict.effects.iter();
        Kinds {
            status: diagnosis.verdict.status.clone(),
            kinds: effects.map(|effect| effect.kind.clone()).collect(),
        }
    }
}

impl fmt::Display for Kinds {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} ({})", self.status, self.kinds.join(", "))
    }
}
