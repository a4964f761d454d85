//! Where hydraulic effects sit.

use simgap_model::{Cylinder, Location, Model, Valve, same_pair};

/// The cylinder whose two chambers a place names.
pub(super) fn cylinder_at<'a>(model: &'a mut Model, at: &Location) -> Option<&'a mut Cylinder> {
    let Location::Between(pair) = at else {
        return None;
    };
    let mut cylinders = model.elements.cylinders.iter_mut();
    cylinders.find(|cylinder| same_pair(&cylinder.chambers(), pair))
}

/// The valve whose spool a place names.
pub(super) fn valve_at<'a>(model: &'a mut Model, at: &Location) -> Option<&'a mut Valve> {
    let Location::Mass(name) = at else {
        return None;
    };
    model
        .elements
        .valves
        .iter_mut()
        .find(|valve| &valve.spool() == name)
}
