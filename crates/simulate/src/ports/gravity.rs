//! Gravity on the arms of pendulums.

use simgap_integrate::exact::{Element, ForceLaw, MemberMotion, elementary};
use simgap_model::{Model, Node};

/// Gravity on an arm beyond its tangent at rest, F = value (sin(angle) − angle): the tangent is in the
/// matrices, which are propagated exactly.
struct Gravity {
    value: f64,
}

impl ForceLaw for Gravity {
    simgap_integrate::lanes!(value);

    fn force(&self, motion: MemberMotion) -> f64 {
        self.value * (elementary::sin(motion.displacement) - motion.displacement)
    }
}

/// One for each pendulum.
pub(super) fn of(model: &Model) -> Vec<Element> {
    let arms = model.pendulums.iter();
    let each = arms.filter_map(|pendulum| {
        let value = pendulum.value;
        let node = model.node(&pendulum.at)?;
        let law = Box::new(Gravity { value });
        Some(Element::between(node, Node::Ground, law))
    });
    each.collect()
}
