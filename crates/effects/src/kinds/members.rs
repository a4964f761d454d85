//! What the members of a place sum up to.

use simgap_model::{Location, Model, same_pair};

/// Sum over what joins the two nodes of a place.
fn sum<'a>(members: impl Iterator<Item = (&'a [String; 2], f64)>, at: &Location) -> f64 {
    let Location::Between(pair) = at else {
        return 0.0;
    };
    let here = members.filter(|(between, _)| same_pair(between, pair));
    here.map(|(_, value)| value).sum()
}

/// Stiffness of the springs at a place, N/m.
pub(super) fn stiffness(model: &Model, at: &Location) -> f64 {
    sum(model.springs.iter().map(|s| (&s.between, s.stiffness)), at)
}

/// Damping of the dampers at a place, N s/m.
pub(super) fn damping(model: &Model, at: &Location) -> f64 {
    sum(model.dampers.iter().map(|d| (&d.between, d.damping)), at)
}
