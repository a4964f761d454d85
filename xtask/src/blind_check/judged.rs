//! A case, its answer and its score.

use simgap_blind::Score;

/// One case with its score and, for a reader, what was there and what was said.
pub(super) struct Judged {
    pub(super) score: Score,
    /// Truth and answer in words.
    pub(super) detail: String,
    /// The diagnosis gave no answer.
    pub(super) is_failed: bool,
    /// Time of the diagnosis on one thread; NaN where it failed.
    pub(super) seconds: f64,
}

impl Judged {
    pub(super) fn is_right(&self) -> bool {
        self.score.is_right() && !self.is_failed
    }
}
