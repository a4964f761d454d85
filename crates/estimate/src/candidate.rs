//! What may be fitted.

use std::fmt;

use simgap_effects::Effect;
use simgap_model::Location;

/// A catalogue entry at a place, without values.
#[derive(Clone)]
pub struct Candidate {
    /// The entry.
    pub effect: &'static dyn Effect,
    /// The place.
    pub at: Location,
}

impl PartialEq for Candidate {
    fn eq(&self, other: &Candidate) -> bool {
        self.effect.kind() == other.effect.kind() && self.at == other.at
    }
}

impl fmt::Debug for Candidate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}", self.effect.kind(), self.at)
    }
}
