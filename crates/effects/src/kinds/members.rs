//! What the members of a place sum up to.

use simgap_model::{Location, Model};

/// Stiffness, N/m, and damping, N s/m, of the members at a place; zero at one that no member joins.
pub(super) fn stiffness_and_damping(model: &Model, at: &Location) -> [f64; 2] {
    match at {
        Location::Between(pair) => model.stiffness_and_damping(pair),
        _ => [0.0; 2],
    }
}
