//! The linear part of one step for eight sets.

use pulp::{Arch, Simd};

use super::compact::Compact;
use super::row::{COMPARED, Row, State};
use super::set::LaneSet;
use super::wide::Wide;
use super::{LANES, Pack};
use crate::exact::propagator::ExactPropagator;

/// The matrices of eight propagators, row-major.
pub(super) struct LaneKernel {
    /// Where rows are too long for registers.
    compact: Option<Compact>,
    phi: Vec<Pack>,
    gamma0: Vec<Pack>,
    gamma1: Vec<Pack>,
    held: Vec<Pack>,
}

/// `sum` and the product of a row of a matrix with a column.
#[inline(always)]
fn add_products<S: Simd>(simd: S, mut sum: Wide<S>, matrix: &[Pack], column: &[Pack]) -> Wide<S> {
    for (entry, value) in matrix.iter().zip(column) {
        sum += Wide::of(simd, entry) * Wide::of(simd, value);
    }
    sum
}

/// The product alone, of at least one entry.
#[inline(always)]
pub(super) fn products<S: Simd>(simd: S, matrix: &[Pack], column: &[Pack]) -> Wide<S> {
    let first = Wide::of(simd, &matrix[0]) * Wide::of(simd, &column[0]);
    add_products(simd, first, &matrix[1..], &column[1..])
}

impl LaneKernel {
    pub(super) fn new(
        arch: Arch,
        sets: &[&LaneSet<'_>; LANES],
        is_read: &dyn Fn(usize) -> bool,
    ) -> LaneKernel {
        let propagators = sets.map(|set| set.propagator);
        let is_long = propagators[0].dof_count > COMPARED;
        let pack = |matrix: &dyn Fn(&ExactPropagator) -> Vec<f64>| -> Vec<Pack> {
            let lanes = propagators.map(matrix);
            (0..lanes[0].len())
                .map(|k| Pack::of(|l| lanes[l].get(k).copied().unwrap_or(0.0)))
                .collect()
        };
        LaneKernel {
            compact: is_long.then(|| Compact::new(arch, sets, is_read)),
            phi: pack(&|p| p.phi.clone()),
            gamma0: pack(&|p| p.gamma0.clone()),
            gamma1: pack(&|p| p.gamma1.clone()),
            held: pack(&|p| p.gamma0.iter().zip(&p.gamma1).map(|(a, b)| a + b).collect()),
        }
    }

    /// The step `z₁ = Φ z₀ + Γ₀ f₀ + Γ₁ f₁`, in the order of the march of one set.
    #[inline(always)]
    pub(super) fn step<S: Simd, R: Row>(
        &mut self,
        simd: S,
        state: &State<R>,
        [before, after]: [&[Pack]; 2],
        next: &mut State<R>,
    ) {
        let (x, v) = (state.displacement.packs(), state.velocity.packs());
        let n = x.len();
        if n > COMPARED
            && let Some(compact) = &mut self.compact
        {
            compact.step(state, [before, after], next);
            return;
        }
        let (gamma0, gamma1) = (&self.gamma0[..2 * n * n], &self.gamma1[..2 * n * n]);
        let phi = &self.phi[..4 * n * n];
        let halves = [&mut next.displacement, &mut next.velocity];
        for (half, next) in halves.into_iter().enumerate() {
            for (k, next) in next.packs_mut().iter_mut().enumerate() {
                let i = half * n + k;
                let forced = products(simd, &gamma0[i * n..(i + 1) * n], before);
                let forced = add_products(simd, forced, &gamma1[i * n..(i + 1) * n], after);
                let row = &phi[2 * i * n..2 * (i + 1) * n];
                let of_x = products(simd, &row[..n], x);
                let of_v = products(simd, &row[n..], v);
                *next = (forced + (of_x + of_v)).pack();
            }
        }
    }

    /// Adds Γ₁ f to `next`.
    #[inline(always)]
    pub(super) fn push_end<S: Simd, R: Row>(&mut self, simd: S, force: &R, next: &mut State<R>) {
        let n = force.packs().len();
        if n > COMPARED
            && let Some(compact) = &mut self.compact
        {
            compact.push_end(force.packs(), next);
            return;
        }
        push(simd, &self.gamma1, force, next);
    }

    /// Adds (Γ₀ + Γ₁) f to `next`.
    #[inline(always)]
    pub(super) fn push_held<S: Simd, R: Row>(&self, simd: S, force: &R, next: &mut State<R>) {
        push(simd, &self.held, force, next);
    }
}

#[inline(always)]
fn push<S: Simd, R: Row>(simd: S, gamma: &[Pack], force: &R, next: &mut State<R>) {
    let n = force.packs().len();
    let gamma = &gamma[..2 * n * n];
    let halves = [&mut next.displacement, &mut next.velocity];
    for (half, next) in halves.into_iter().enumerate() {
        for (k, next) in next.packs_mut().iter_mut().enumerate() {
            let i = half * n + k;
            let row = &gamma[i * n..(i + 1) * n];
            *next = add_products(simd, Wide::of(simd, next), row, force.packs()).pack();
        }
    }
}
