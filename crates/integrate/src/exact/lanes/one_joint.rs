//! Steps of eight sets with a single joint between coordinates, bases and the ground: rows that the compiler unrolls in the place of
//! nodes that are looked at in every step. A number is what it is in any other march.

use pulp::Simd;
use simgap_model::Node;

use super::block::{Block, less_products};
use super::kernel::products;
use super::row::{COMPARED, Row};
use super::step::{Joints, Step};
use super::wide::Wide;
use super::{Mask, Pack};

/// The rows of a port over the coordinates.
pub(super) struct PortRows<R> {
    displacement: Reading<R>,
    velocity: Reading<R>,
    /// What a force that it carries does to the coordinates.
    push: R,
}

/// +1 and −1 at coordinates, and the base, of a difference of two nodes.
struct Reading<R> {
    row: R,
    base: Option<(usize, f64)>,
}

impl<R: Row> Reading<R> {
    /// `None` for points of a body.
    fn new([a, b]: [Node; 2], zero: &R) -> Option<Reading<R>> {
        let (mut row, mut base) = (zero.clone(), None);
        for (node, sign) in [(a, 1.0), (b, -1.0)] {
            match node {
                Node::Ground => {}
                Node::Dof(i) => row.packs_mut()[i] = Pack::of(|_| sign),
                Node::Base(i) if base.is_none() => base = Some((i, sign)),
                Node::Base(_) | Node::Point(_) | Node::Port(_) => return None,
            }
        }
        Some(Reading { row, base })
    }

    #[inline(always)]
    fn of<S: Simd>(&self, simd: S, values: &R, bases: &[Pack]) -> Pack {
        let mut sum = products(simd, self.row.packs(), values.packs());
        if let Some((i, sign)) = self.base {
            sum += Wide::splat(simd, sign) * Wide::of(simd, &bases[i]);
        }
        sum.pack()
    }
}

impl<R: Row> PortRows<R> {
    /// Those of the one joint of a block; `None` where it has others, and where the compiler does not know how long rows are.
    pub(super) fn new(block: &Block<'_>, zero: &R) -> Option<PortRows<R>> {
        let [place] = &block.places[..] else {
            return None;
        };
        if place.has_tangent || !(1..=COMPARED).contains(&zero.packs().len()) {
            return None;
        }
        let port = block.ports[place.elements[0]];
        let [a, b] = port.force;
        Some(PortRows {
            displacement: Reading::new(port.displacement, zero)?,
            velocity: Reading::new(port.velocity, zero)?,
            push: Reading::new([b, a], zero)?.row,
        })
    }

    /// Adds what a force does to the coordinates.
    #[inline(always)]
    fn push<S: Simd>(&self, simd: S, force: &Pack, on: &mut R) {
        let force = Wide::of(simd, force);
        for (on, weight) in on.packs_mut().iter_mut().zip(self.push.packs()) {
            *on = (Wide::of(simd, on) + Wide::of(simd, weight) * force).pack();
        }
    }
}

impl<R: Row> Joints<R> for PortRows<R> {
    #[inline(always)]
    fn step<S: Simd>(&self, simd: S, block: &mut Block<'_>, step: Step<'_, R>) {
        let ([state, next], [base_x, base_v]) = (step.states, step.base);
        self.push(simd, &block.joints[0].smooth, step.before);
        let forces = [step.before.packs(), step.after];
        block.kernel.step(simd, state, forces, next);
        let free = [
            self.displacement.of(simd, &next.displacement, base_x),
            self.velocity.of(simd, &next.velocity, base_v),
        ];
        let time_s = block.time_s(simd, step.steps);
        let joint = &mut block.joints[0];
        joint.without = free;
        joint.begin(simd, free[1], time_s);
        block.settle_joint(simd, 0, &Mask::ALL);
        let joint = &mut block.joints[0];
        if let Some(element) = block.places[0].remembers {
            let (smooth, dry) = (&joint.smooth, &joint.dry_force);
            let [give, dry_give] = [&joint.compliance[0], &joint.dry_compliance[0]];
            joint.displacement = less_products(simd, &free[0], [give, smooth], [dry_give, dry]);
            block.laws[element].remember(block.arch, joint);
        }
        let mut net = step.before.clone();
        net.packs_mut().fill(Pack::ZERO);
        self.push(simd, &joint.smooth, &mut net);
        block.kernel.push_end(simd, &net, next);
        if block.any_dry {
            net.packs_mut().fill(Pack::ZERO);
            self.push(simd, &block.joints[0].dry_force, &mut net);
            block.kernel.push_held(simd, &net, next);
        }
        state.take_over(next);
    }
}
