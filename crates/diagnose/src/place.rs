//! Where a channel of the model is.

use simgap_model::{Location, Output};

/// The place of an output: its mass, or the pair of nodes its force is between.
pub(crate) fn place_of(output: &Output) -> Option<Location> {
    match (&output.at, &output.between) {
        (Some(at), _) => Some(Location::Mass(at.clone())),
        (None, Some(pair)) => Some(Location::Between(pair.clone())),
        (None, None) => None,
    }
}
