//! Steps of eight sets with a single joint between coordinates, bases and the ground: rows that the compiler unrolls in the place of
//! nodes that are looked at in every step. A number is what it is in any other march.

use pulp::Simd;
use simgap_model::Node;

use super::block::{Block, less_products};
use super::kernel::{add_products, products};
use super::row::{COMPARED, Row, State};
use super::wide::Wide;
use super::{Mask, Pack};

/// The rows of a port over the coordinates, and what it has of a base.
pub(super) struct PortRows<R> {
    displacement: (R, Option<(usize, f64)>),
    velocity: (R, Option<(usize, f64)>),
    /// What a force that it carries does to the coordinates.
    push: R,
}

/// +1 and −1 at coordinates, and the base, of a difference of two nodes that are no points of a body.
fn difference<R: Row>([a, b]: [Node; 2], zero: &R) -> Option<(R, Option<(usize, f64)>)> {
    let (mut row, mut base) = (zero.clone(), None);
    for (node, sign) in [(a, 1.0), (b, -1.0)] {
        match node {
            Node::Ground => {}
            Node::Dof(i) => row.packs_mut()[i] = Pack::of(|_| sign),
            Node::Base(i) if base.is_none() => base = Some((i, sign)),
            Node::Base(_) | Node::Point(_) | Node::Port(_) => return None,
        }
    }
    Some((row, base))
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
            displacement: difference(port.displacement, zero)?,
            velocity: difference(port.velocity, zero)?,
            push: difference([b, a], zero)?.0,
        })
    }
}

/// What a row reads off the coordinates and the bases.
#[inline(always)]
fn read<S: Simd, R: Row>(
    simd: S,
    (row, base): &(R, Option<(usize, f64)>),
    values: &R,
    bases: &[Pack],
) -> Pack {
    let mut sum = products(simd, row.packs(), values.packs());
    if let Some((i, sign)) = base {
        sum += Wide::splat(simd, *sign) * Wide::of(simd, &bases[*i]);
    }
    sum.pack()
}

/// Adds what a force does to the coordinates.
#[inline(always)]
fn push<S: Simd, R: Row>(simd: S, row: &R, force: &Pack, on: &mut R) {
    let force = [*force];
    for (on, weight) in on.packs_mut().iter_mut().zip(row.packs()) {
        *on = add_products(simd, Wide::of(simd, on), &[*weight], &force).pack();
    }
}

impl Block<'_> {
    /// As [`Block::step`], for a block with these rows.
    #[inline(always)]
    pub(super) fn step_of_one<S: Simd, R: Row>(
        &mut self,
        simd: S,
        rows: &PortRows<R>,
        [state, next]: [&mut State<R>; 2],
        (before, after): (&mut R, &[Pack]),
        ([base_x, base_v], steps): ([&[Pack]; 2], usize),
    ) {
        push(simd, &rows.push, &self.joints[0].smooth, before);
        let forces = [before.packs(), after];
        self.kernel.step(simd, state, forces, next);
        let free = [
            read(simd, &rows.displacement, &next.displacement, base_x),
            read(simd, &rows.velocity, &next.velocity, base_v),
        ];
        let time_s = self.time_s(simd, steps);
        let joint = &mut self.joints[0];
        joint.without = free;
        joint.begin(simd, free[1], time_s);
        self.settle_joint(simd, 0, &Mask::ALL);
        let joint = &mut self.joints[0];
        if let Some(element) = self.places[0].remembers {
            let (smooth, dry) = (&joint.smooth, &joint.dry_force);
            let [give, dry_give] = [&joint.compliance[0], &joint.dry_compliance[0]];
            joint.displacement = less_products(simd, &free[0], [give, smooth], [dry_give, dry]);
            self.laws[element].remember(self.arch, joint);
        }
        let mut net = before.clone();
        net.packs_mut().fill(Pack::ZERO);
        push(simd, &rows.push, &joint.smooth, &mut net);
        self.kernel.push_end(simd, &net, next);
        if self.any_dry {
            net.packs_mut().fill(Pack::ZERO);
            push(simd, &rows.push, &self.joints[0].dry_force, &mut net);
            self.kernel.push_held(simd, &net, next);
        }
        state.take_over(next);
    }
}
