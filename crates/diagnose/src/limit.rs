//! What ends a search before it is done.

use simgap_estimate::Effort;

/// Work after which a search ends of itself: about a minute of one core.
const MOST_EFFORT: u64 = 60_000_000_000;

/// What ends the search with the best answer so far; asked between its stages.
#[derive(Clone, Copy)]
pub enum Limit<'a> {
    /// So much work ([`Effort`]), which is the same on every machine.
    Effort(u64),
    /// The caller, after some seconds for instance.
    Asked(&'a (dyn Fn() -> bool + Sync)),
}

impl Default for Limit<'_> {
    fn default() -> Self {
        Limit::Effort(MOST_EFFORT)
    }
}

impl Limit<'_> {
    /// Whether the search is to end.
    pub(crate) fn is_reached(self, effort: &Effort) -> bool {
        match self {
            Limit::Effort(most) => effort.spent() > most,
            Limit::Asked(ends) => ends(),
        }
    }
}
