//! What is said of a case, in plain types.

use simgap_model::Location;

use crate::Status;
use crate::closing::Signals;

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
    /// Stated probability that it is the cause.
    pub probability: f64,
    /// What the answer says cannot be told from it.
    pub indistinguishable: Vec<(String, Location)>,
    /// The answer says that it leaves more than noise of the check records.
    pub is_incomplete: bool,
}
