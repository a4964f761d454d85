//! The linear part of one step for eight sets of many degrees of freedom.
//!
//! Columns of zeros are left out (the integral of a pressure moves nothing; most coordinates are never pushed), four rows are
//! summed side by side, since additions wait for each other within a row, and what all sets share is stored once. What is
//! added to a row, and in which order, is as without.

use pulp::{Arch, Simd, WithSimd};

use super::row::{Row, State};
use super::set::LaneSet;
use super::wide::Wide;
use super::{LANES, Pack};
use crate::exact::columns::Columns;
use crate::exact::propagator::ExactPropagator;

/// Rows that are summed side by side.
const ROWS: usize = 4;

/// Entries of a matrix, those of four rows in a column beside each other.
enum Rows {
    /// The same in all sets.
    Shared(Vec<[f64; ROWS]>),
    Own(Vec<[Pack; ROWS]>),
}

trait Entry {
    fn wide<S: Simd>(&self, simd: S) -> Wide<S>;
}

impl Entry for f64 {
    #[inline(always)]
    fn wide<S: Simd>(&self, simd: S) -> Wide<S> {
        Wide::splat(simd, *self)
    }
}

impl Entry for Pack {
    #[inline(always)]
    fn wide<S: Simd>(&self, simd: S) -> Wide<S> {
        Wide::of(simd, self)
    }
}

impl Rows {
    /// A matrix of so many rows and columns from its entries in a set.
    fn new(
        propagators: &[&ExactPropagator; LANES],
        [rows, columns]: [usize; 2],
        entry: impl Fn(&ExactPropagator, usize, usize) -> f64,
    ) -> Rows {
        let places = (0..rows.div_ceil(ROWS)).flat_map(|block| {
            let at = move |column| (block * ROWS, column);
            (0..columns).map(at)
        });
        let value = |p: &ExactPropagator, row: usize, column: usize| {
            if row < rows {
                entry(p, row, column)
            } else {
                0.0
            }
        };
        let first = propagators[0];
        if propagators.iter().all(|p| std::ptr::eq(*p, first)) {
            let four = |(row, column)| std::array::from_fn(|r| value(first, row + r, column));
            return Rows::Shared(places.map(four).collect());
        }
        let four = |(row, column)| {
            std::array::from_fn(|r| Pack::of(|l| value(propagators[l], row + r, column)))
        };
        Rows::Own(places.map(four).collect())
    }

    /// Adds the product with a column to `sums`, which has room for whole blocks of rows.
    fn add_product(&self, arch: Arch, column: &[Pack], sums: &mut [Pack]) {
        if !column.is_empty() {
            arch.dispatch(Product(self, column, sums));
        }
    }
}

/// A whole product at a time: not to be compiled again with every march and every observer.
struct Product<'a>(&'a Rows, &'a [Pack], &'a mut [Pack]);

impl WithSimd for Product<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Product(rows, column, sums) = self;
        match rows {
            Rows::Shared(entries) => add_product(simd, entries, column, sums),
            Rows::Own(entries) => add_product(simd, entries, column, sums),
        }
    }
}

#[inline(always)]
fn add_product<S: Simd, E: Entry>(
    simd: S,
    entries: &[[E; ROWS]],
    column: &[Pack],
    sums: &mut [Pack],
) {
    let blocks = entries.chunks_exact(column.len());
    for (block, sums) in blocks.zip(sums.chunks_exact_mut(ROWS)) {
        // Closures would not be inlined into vector instructions.
        let mut of_rows = [Wide::zero(simd); ROWS];
        for r in 0..ROWS {
            of_rows[r] = Wide::of(simd, &sums[r]);
        }
        for (entries, value) in block.iter().zip(column) {
            let value = Wide::of(simd, value);
            for r in 0..ROWS {
                of_rows[r] += entries[r].wide(simd) * value;
            }
        }
        for r in 0..ROWS {
            sums[r] = of_rows[r].pack();
        }
    }
}

/// Takes the entries of a row at these coordinates.
#[inline(always)]
fn collect(row: &[Pack], coordinates: &[usize], out: &mut [Pack]) {
    for (out, i) in out.iter_mut().zip(coordinates) {
        *out = row[*i];
    }
}

/// Φ, Γ₀ and Γ₁ without their columns of zeros, and room for their products.
pub(super) struct Compact {
    arch: Arch,
    /// [Γ₀ Γ₁ Φ] over the coordinates that are pushed and the parts of the state that move something.
    step: Rows,
    /// Γ₁ over the coordinates that elements push.
    end: Rows,
    columns: Columns,
    column: Vec<Pack>,
    sums: Vec<Pack>,
}

impl Compact {
    pub(super) fn new(
        arch: Arch,
        sets: &[&LaneSet<'_>; LANES],
        is_read: &dyn Fn(usize) -> bool,
    ) -> Compact {
        let propagators = sets.map(|set| set.propagator);
        let forces = sets.map(|set| set.excitation.dof_force);
        let columns = Columns::new(&propagators, sets[0].elements, &forces, is_read);
        let rows = columns.rows.len();
        let wide = 2 * columns.pushed.len() + columns.moving.len();
        let step = Rows::new(&propagators, [rows, wide], |p, i, j| {
            columns.step_entry(p, i, j)
        });
        let end = Rows::new(&propagators, [rows, columns.joined.len()], |p, i, j| {
            columns.end_entry(p, i, j)
        });
        Compact {
            arch,
            step,
            end,
            column: vec![Pack::ZERO; wide],
            columns,
            sums: vec![Pack::ZERO; rows.next_multiple_of(ROWS)],
        }
    }

    /// The step `z₁ = Φ z₀ + Γ₀ f₀ + Γ₁ f₁`.
    pub(super) fn step<R: Row>(
        &mut self,
        state: &State<R>,
        forces: [&[Pack]; 2],
        next: &mut State<R>,
    ) {
        let (x, v) = (state.displacement.packs(), state.velocity.packs());
        let n = x.len();
        let Columns { pushed, moving, .. } = &self.columns;
        let (before, rest) = self.column.split_at_mut(pushed.len());
        let (after, of_state) = rest.split_at_mut(pushed.len());
        collect(forces[0], pushed, before);
        collect(forces[1], pushed, after);
        for (value, &i) in of_state.iter_mut().zip(moving) {
            *value = if i < n { x[i] } else { v[i - n] };
        }
        self.sums.fill(Pack::ZERO);
        self.step
            .add_product(self.arch, &self.column, &mut self.sums);
        self.deliver(next);
    }

    /// Adds Γ₁ f to `next`, the result of the last step, f being zero where no element pushes.
    pub(super) fn push_end<R: Row>(&mut self, force: &[Pack], next: &mut State<R>) {
        let joined = &self.columns.joined;
        let column = &mut self.column[..joined.len()];
        collect(force, joined, column);
        self.end.add_product(self.arch, column, &mut self.sums);
        self.deliver(next);
    }

    fn deliver<R: Row>(&self, next: &mut State<R>) {
        let (x, v) = (next.displacement.packs_mut(), next.velocity.packs_mut());
        let n = x.len();
        for (&row, sum) in self.columns.rows.iter().zip(&self.sums) {
            if row < n {
                x[row] = *sum;
            } else {
                v[row - n] = *sum;
            }
        }
    }
}
