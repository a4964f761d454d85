//! What the propagation needs to know of a nonlinear force.

/// Motion across a member, and when.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MemberMotion {
    /// d = x_a − x_b, m.
    pub displacement: f64,
    /// v = ẋ_a − ẋ_b, m/s.
    pub velocity: f64,
    /// t, s, on the clock of the record.
    pub time_s: f64,
}

/// A force carried between two nodes, positive when it resists a positive displacement of a from
/// b, as a spring's `k d` does: it pushes a with −F and b with +F.
///
/// A law has a single-valued part, and may have a dry part: a force of either sign up to a level,
/// which holds the member still if it can (a set-valued force at zero velocity).
pub trait ForceLaw: Send + Sync {
    /// The single-valued part, N.
    fn force(&self, motion: MemberMotion) -> f64;

    /// Largest dry force at the sliding speed |v| (m/s), N, not negative; `None` for a law
    /// without a dry part.
    fn dry_level(&self, speed: f64) -> Option<f64> {
        let _ = speed;
        None
    }
}

/// A law between two nodes of a model.
pub struct Element {
    /// Node a.
    pub a: simgap_model::Node,
    /// Node b.
    pub b: simgap_model::Node,
    /// The force it carries.
    pub law: Box<dyn ForceLaw>,
}
