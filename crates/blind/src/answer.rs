//! What is said of a case, in plain types.

use simgap_effects::same_place;
use simgap_model::Location;

use crate::closing::Signals;
use crate::{Hidden, Status};

/// What was answered, in plain types.
#[derive(Debug, Clone, PartialEq)]
pub struct Answer {
    /// Kind of answer.
    pub status: Status,
    /// What is named; counts for [`Status::Parameters`] and [`Status::Effect`] only.
    pub named: Vec<Named>,
    /// Share of the gap that is closed, 1 for all of it.
    pub closed: f64,
    /// Predictions of the nominal model.
    pub nominal: Signals,
    /// Predictions of the corrected model.
    pub corrected: Signals,
}

impl Answer {
    /// That of a diagnosis that gave none.
    #[must_use]
    pub fn nothing() -> Answer {
        Answer {
            status: Status::None,
            named: vec![],
            closed: 0.0,
            nominal: vec![],
            corrected: vec![],
        }
    }
}

/// A named effect.
#[derive(Debug, Clone, PartialEq)]
pub struct Named {
    /// Catalogue name.
    pub kind: String,
    /// Where it acts.
    pub at: Location,
    /// Stated probability that it, or one that cannot be told from it, is part of the cause.
    pub probability: f64,
    /// What the answer says cannot be told from it.
    pub indistinguishable: Vec<(String, Location)>,
    /// The answer says that it leaves more than noise of the check records.
    pub is_incomplete: bool,
}

impl Named {
    /// Its kind and those that are said to be indistinguishable from it, each once.
    pub(crate) fn kinds(&self) -> Vec<&str> {
        let others = self.indistinguishable.iter().map(|(kind, _)| kind.as_str());
        let mut kinds: Vec<&str> = others.chain([self.kind.as_str()]).collect();
        kinds.sort_unstable();
        kinds.dedup();
        kinds
    }

    /// Whether this effect is said to be indistinguishable from it.
    pub(crate) fn declares(&self, effect: &Hidden) -> bool {
        let mut others = self.indistinguishable.iter();
        others.any(|(kind, at)| *kind == effect.kind && same_place(at, &effect.at))
    }
}
