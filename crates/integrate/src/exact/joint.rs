//! Elements at one port, which move alike and are solved as one.

use super::law::Element;
use super::role::Role;

/// Elements at one port: they see the same motion, and what moves the plant is the sum of their forces. One of them at most
/// rubs, and one at most remembers: what does so beside another of its kind has a joint of its own, as has what is solved
/// by its tangent.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Joint {
    /// Places among all elements; the one that rubs comes first.
    pub(super) elements: Vec<usize>,
    /// Whether the first rubs.
    pub(super) dry: bool,
    /// The one that remembers.
    pub(super) remembers: Option<usize>,
    /// Whether it is solved together with the other joints of this kind, by Newton's method.
    pub(super) has_tangent: bool,
}

impl Joint {
    fn of(place: usize, element: &Element) -> Joint {
        let law = &element.law;
        Joint {
            elements: vec![place],
            dry: law.dry_level(0.0).is_some(),
            remembers: law.remembers().then_some(place),
            has_tangent: law.has_tangent(),
        }
    }

    /// What one of its elements is there.
    #[inline(always)]
    pub(super) fn role(&self, element: usize) -> Role {
        Role {
            dry: self.dry && element == self.elements[0],
            remembering: self.remembers == Some(element),
        }
    }

    fn takes(&self, other: &Joint) -> bool {
        let both_rub = self.dry && other.dry;
        let both_remember = self.remembers.is_some() && other.remembers.is_some();
        !(self.has_tangent || other.has_tangent || both_rub || both_remember)
    }
}

/// The joints of a plant, in the order of their first elements.
pub(super) fn joints(elements: &[Element]) -> Vec<Joint> {
    let mut joints: Vec<Joint> = vec![];
    for (place, element) in elements.iter().enumerate() {
        let own = Joint::of(place, element);
        let found = joints
            .iter_mut()
            .find(|joint| elements[joint.elements[0]].port == element.port && joint.takes(&own));
        let Some(joint) = found else {
            joints.push(own);
            continue;
        };
        let at = if own.dry { 0 } else { joint.elements.len() };
        joint.elements.insert(at, place);
        joint.dry |= own.dry;
        joint.remembers = joint.remembers.or(own.remembers);
    }
    joints
}

#[cfg(test)]
mod tests {
    use simgap_model::Node;

    use super::super::law::{ForceLaw, MemberMotion};
    use super::*;

    /// A law that rubs, remembers or has a tangent.
    struct Law([bool; 3]);

    impl ForceLaw for Law {
        fn force(&self, _: MemberMotion) -> f64 {
            0.0
        }

        fn dry_level(&self, _: f64) -> Option<f64> {
            self.0[0].then_some(1.0)
        }

        fn remembers(&self) -> bool {
            self.0[1]
        }

        fn has_tangent(&self) -> bool {
            self.0[2]
        }
    }

    #[test]
    fn verify_what_moves_alike_is_one_joint() {
        let at = |node, law| Element::between(Node::Dof(node), Node::Ground, Box::new(Law(law)));
        let elements = [
            at(0, [false; 3]),
            at(1, [false; 3]),
            at(0, [true, false, false]),
            at(0, [true, false, false]),
            at(0, [false, true, false]),
            at(0, [false, true, false]),
            at(1, [false, false, true]),
        ];
        let found: Vec<_> = joints(&elements).into_iter().map(|j| j.elements).collect();
        assert_eq!(found, [vec![2, 0, 4], vec![1], vec![3, 5], vec![6]]);
    }
}
