//! A claim with its verdict.

use super::super::Verdict;

/// A claim, judged by a computed condition.
pub(in super::super) struct Claim {
    pub(super) claim: String,
    pub(super) place: &'static str,
    pub(super) verdict: Verdict,
    pub(super) because: String,
}

impl Claim {
    /// The verdict is `then` if the condition holds, and not reproducible otherwise.
    pub(super) fn judged(
        claim: impl Into<String>,
        place: &'static str,
        (holds, then): (bool, Verdict),
        because: impl Into<String>,
    ) -> Self {
        let verdict = if holds {
            then
        } else {
            Verdict::NotReproducible
        };
        Self {
            claim: claim.into(),
            place,
            verdict,
            because: because.into(),
        }
    }
}
