//! What a law is among those of its joint.

/// What a law is at its joint.
#[derive(Debug, Clone, Copy, Default)]
pub struct Role {
    /// The one that rubs.
    pub(super) dry: bool,
    /// The one that remembers.
    pub(super) remembering: bool,
}
