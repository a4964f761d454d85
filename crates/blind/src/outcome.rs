//! What became of each effect of the truth, from best to worst.

use simgap_model::Location;

/// What became of one effect of the truth; from best to worst.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Outcome {
    /// Right kind, right place.
    Right,
    /// An equivalent is named.
    Equivalent,
    /// Nothing was there and nothing is named.
    Quiet,
    /// Not in the catalogue, and said to be unknown.
    HonestUnknown,
    /// Not in the catalogue, and one of its family is named first in an answer that says that it is not complete.
    Nearest,
    /// Among what the answer says cannot be told from a named effect.
    AmongRivals,
    /// Right kind, wrong place.
    WrongPlace,
    /// In the catalogue, but said to be unknown.
    CalledUnknown,
    /// Something else is named.
    Wrong,
    /// The gap is said to be noise.
    Missed,
    /// Nothing was there, and something is named or said to be unknown.
    FalseAlarm,
}

impl Outcome {
    /// A word or two for tables.
    #[must_use]
    pub fn label(self) -> &'static str {
        match self {
            Outcome::Right => "right",
            Outcome::Equivalent => "equivalent",
            Outcome::Quiet => "quiet",
            Outcome::HonestUnknown => "honest unknown",
            Outcome::Nearest => "nearest name",
            Outcome::AmongRivals => "among rivals",
            Outcome::WrongPlace => "wrong place",
            Outcome::CalledUnknown => "called unknown",
            Outcome::Wrong => "wrong",
            Outcome::Missed => "missed",
            Outcome::FalseAlarm => "false alarm",
        }
    }

    /// Whether a reader of the answer would know the cause and its place.
    #[must_use]
    pub fn is_right(self) -> bool {
        matches!(
            self,
            Outcome::Right
                | Outcome::Equivalent
                | Outcome::Quiet
                | Outcome::HonestUnknown
                | Outcome::Nearest
        )
    }
}

/// One effect of the truth and what was said of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Verdict {
    /// Kind of the truth; `none, exact` or `none, small errors` for noise alone.
    pub kind: String,
    /// Its place, if it has one.
    pub at: Option<Location>,
    /// What became of it.
    pub outcome: Outcome,
    /// Probability stated for it (or its equivalent); 0 when it is not named.
    pub probability: f64,
    /// Kind that was said: of the effect that matches it, else of the most probable one that
    /// matches nothing, else the status.
    pub said: String,
}
