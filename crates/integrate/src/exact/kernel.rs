//! The linear part of one step, for a number of degrees of freedom known to the compiler and for
//! any number.

use super::columns::Columns;
use super::propagator::ExactPropagator;

/// One step of `z₁ = Φ z₀ + Γ₀ f₀ + Γ₁ f₁`.
pub(super) trait Kernel {
    /// The step, from `state` to `next` (displacements, then velocities).
    fn step(&mut self, state: &[f64], before: &[f64], after: &[f64], next: &mut [f64]);

    /// Adds Γ₁ f₁ to `next`, the result of the last step.
    fn push_end(&mut self, force: &[f64], next: &mut [f64]);

    /// Adds (Γ₀ + Γ₁) f to `next`, the result of the last step: a force held over the step.
    fn push_held(&mut self, force: &[f64], next: &mut [f64]);
}

/// A square block.
type Block<const N: usize> = [[f64; N]; N];

/// N degrees of freedom, all loops unrolled. Blocks are indexed by the half of the state (0:
/// displacement, 1: velocity) they lead to and come from.
pub(super) struct Fixed<const N: usize> {
    phi: [[Block<N>; 2]; 2],
    gamma0: [Block<N>; 2],
    gamma1: [Block<N>; 2],
    held: [Block<N>; 2],
}

impl<const N: usize> Fixed<N> {
    pub(super) fn new(propagator: &ExactPropagator) -> Fixed<N> {
        let block = |matrix: &[f64], width: usize, row: usize, column: usize| -> Block<N> {
            std::array::from_fn(|i| {
                std::array::from_fn(|j| matrix[(row * N + i) * width + column * N + j])
            })
        };
        let forced = |matrix: &[f64]| [0, 1].map(|half| block(matrix, N, half, 0));
        let held: Vec<f64> = propagator
            .gamma0
            .iter()
            .zip(&propagator.gamma1)
            .map(|(a, b)| a + b)
            .collect();
        Fixed {
            phi: [0, 1].map(|to| [0, 1].map(|from| block(&propagator.phi, 2 * N, to, from))),
            gamma0: forced(&propagator.gamma0),
            gamma1: forced(&propagator.gamma1),
            held: forced(&held),
        }
    }
}

#[inline(always)]
pub(super) fn array<const N: usize>(slice: &[f64]) -> [f64; N] {
    std::array::from_fn(|i| slice[i])
}

#[inline(always)]
fn add_product<const N: usize>(block: &Block<N>, vector: &[f64; N], sum: &mut [f64; N]) {
    for i in 0..N {
        for j in 0..N {
            sum[i] += block[i][j] * vector[j];
        }
    }
}

/// The product alone. A sum from zero would be one more addition to wait for.
#[inline(always)]
fn product<const N: usize>(block: &Block<N>, vector: &[f64; N]) -> [f64; N] {
    let mut sum = [0.0; N];
    for i in 0..N {
        sum[i] = block[i][0] * vector[0];
        for j in 1..N {
            sum[i] += block[i][j] * vector[j];
        }
    }
    sum
}

impl<const N: usize> Fixed<N> {
    /// The step from a displacement and a velocity. What the forces, the displacements and the velocities bring is summed apart: a
    /// step waits for the one before it, by as few additions as there can be.
    #[inline(always)]
    pub(super) fn next(
        &self,
        [x, v]: &[[f64; N]; 2],
        before: &[f64; N],
        after: &[f64; N],
    ) -> [[f64; N]; 2] {
        // A closure would not be inlined.
        let mut next = [[0.0; N]; 2];
        for half in 0..2 {
            let mut forced = product(&self.gamma0[half], before);
            add_product(&self.gamma1[half], after, &mut forced);
            let of_x = product(&self.phi[half][0], x);
            let of_v = product(&self.phi[half][1], v);
            for i in 0..N {
                next[half][i] = forced[i] + (of_x[i] + of_v[i]);
            }
        }
        next
    }
}

impl<const N: usize> Kernel for Fixed<N> {
    #[inline(always)]
    fn step(&mut self, state: &[f64], before: &[f64], after: &[f64], next: &mut [f64]) {
        let state = [array::<N>(&state[..N]), array::<N>(&state[N..])];
        let ends = [before, after].map(array::<N>);
        for (half, out) in self.next(&state, &ends[0], &ends[1]).iter().enumerate() {
            next[half * N..(half + 1) * N].copy_from_slice(out);
        }
    }

    #[inline(always)]
    fn push_end(&mut self, force: &[f64], next: &mut [f64]) {
        push(&self.gamma1, force, next);
    }

    #[inline(always)]
    fn push_held(&mut self, force: &[f64], next: &mut [f64]) {
        push(&self.held, force, next);
    }
}

#[inline(always)]
fn push<const N: usize>(blocks: &[Block<N>; 2], force: &[f64], next: &mut [f64]) {
    let f = array::<N>(&force[..N]);
    for (block, out) in blocks.iter().zip(next[..2 * N].chunks_exact_mut(N)) {
        let mut sum = array::<N>(out);
        add_product(block, &f, &mut sum);
        out.copy_from_slice(&sum);
    }
}

/// Rows that are summed side by side: additions wait for each other within a row.
const ROWS: usize = 4;

/// Entries of a matrix, those of four rows in a column beside each other.
struct Rows {
    columns: usize,
    entries: Vec<[f64; ROWS]>,
}

impl Rows {
    /// A matrix of so many rows and columns.
    fn new([rows, columns]: [usize; 2], entry: impl Fn(usize, usize) -> f64) -> Rows {
        let blocks = (0..rows).step_by(ROWS);
        let places = blocks.flat_map(|first| (0..columns).map(move |column| (first, column)));
        let four = |(first, column): (usize, usize)| {
            std::array::from_fn(|r| match first + r {
                row if row < rows => entry(row, column),
                _ => 0.0,
            })
        };
        Rows {
            columns,
            entries: places.map(four).collect(),
        }
    }

    /// Adds the product with a column to `sums`, which has room for whole blocks of rows.
    #[inline(always)]
    fn add_product(&self, column: &[f64], sums: &mut [f64]) {
        if self.columns == 0 {
            return;
        }
        let blocks = self.entries.chunks_exact(self.columns);
        for (block, sums) in blocks.zip(sums.chunks_exact_mut(ROWS)) {
            let mut of_rows = array::<ROWS>(sums);
            for (entries, value) in block.iter().zip(column) {
                for r in 0..ROWS {
                    of_rows[r] += entries[r] * value;
                }
            }
            sums.copy_from_slice(&of_rows);
        }
    }
}

/// Any number of degrees of freedom, none included, without the columns that do nothing.
pub(super) struct Compact {
    columns: Columns,
    /// [Γ₀ Γ₁ Φ] over the coordinates that are pushed and the parts of the state that move something.
    step: Rows,
    /// Γ₁, and Γ₀ + Γ₁, over the coordinates that elements push.
    end: Rows,
    held: Rows,
    column: Vec<f64>,
    sums: Vec<f64>,
}

impl Compact {
    pub(super) fn new(propagator: &ExactPropagator, columns: Columns) -> Compact {
        let rows = columns.rows.len();
        let wide = 2 * columns.pushed.len() + columns.moving.len();
        let forced = [rows, columns.joined.len()];
        Compact {
            step: Rows::new([rows, wide], |i, j| columns.step_entry(propagator, i, j)),
            end: Rows::new(forced, |i, j| columns.end_entry(propagator, i, j)),
            held: Rows::new(forced, |i, j| columns.held_entry(propagator, i, j)),
            column: Vec::with_capacity(wide),
            sums: vec![0.0; rows.next_multiple_of(ROWS)],
            columns,
        }
    }

    /// Adds what elements do to the sums of the step that has just been taken.
    #[inline(always)]
    fn push(&mut self, is_end: bool, force: &[f64], next: &mut [f64]) {
        self.column.clear();
        let joined = self.columns.joined.iter();
        self.column.extend(joined.map(|i| force[*i]));
        let matrix = if is_end { &self.end } else { &self.held };
        matrix.add_product(&self.column, &mut self.sums);
        self.deliver(next);
    }

    #[inline(always)]
    fn deliver(&self, next: &mut [f64]) {
        for (row, sum) in self.columns.rows.iter().zip(&self.sums) {
            next[*row] = *sum;
        }
    }
}

impl Kernel for Compact {
    #[inline(always)]
    fn step(&mut self, state: &[f64], before: &[f64], after: &[f64], next: &mut [f64]) {
        self.column.clear();
        for force in [before, after] {
            let pushed = self.columns.pushed.iter();
            self.column.extend(pushed.map(|i| force[*i]));
        }
        let moving = self.columns.moving.iter();
        self.column.extend(moving.map(|i| state[*i]));
        self.sums.fill(0.0);
        self.step.add_product(&self.column, &mut self.sums);
        self.deliver(next);
    }

    #[inline(always)]
    fn push_end(&mut self, force: &[f64], next: &mut [f64]) {
        self.push(true, force, next);
    }

    #[inline(always)]
    fn push_held(&mut self, force: &[f64], next: &mut [f64]) {
        self.push(false, force, next);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use faer::Mat;
    use simgap_model::StructuralMatrices;

    #[test]
    fn verify_fixed_and_compact_agree() {
        let band = |v: f64| {
            Mat::from_fn(3, 3, |i, j| match i.abs_diff(j) {
                0 => 2.0 * v + i as f64,
                1 => -v,
                _ => 0.0,
            })
        };
        let structure = StructuralMatrices {
            mass_matrix: Mat::from_fn(3, 3, |i, j| if i == j { 1.0 + i as f64 } else { 0.0 }),
            damping_matrix: band(0.7),
            stiffness_matrix: band(300.0),
        };
        let propagator = ExactPropagator::new(&structure, 0.02);
        let propagator = propagator.expect("a regular structure");
        let all = Columns {
            rows: (0..6).collect(),
            moving: (0..6).collect(),
            pushed: (0..3).collect(),
            joined: (0..3).collect(),
        };
        let (mut fixed, mut compact) =
            (Fixed::<3>::new(&propagator), Compact::new(&propagator, all));
        let state = [0.1, -0.2, 0.3, 1.0, -2.0, 0.5];
        let (f0, f1) = ([3.0, -1.0, 2.0], [0.5, 4.0, -2.0]);
        let (mut a, mut b) = ([0.0; 6], [0.0; 6]);
        fixed.step(&state, &f0, &f1, &mut a);
        compact.step(&state, &f0, &f1, &mut b);
        fixed.push_end(&f0, &mut a);
        compact.push_end(&f0, &mut b);
        fixed.push_held(&f1, &mut a);
        compact.push_held(&f1, &mut b);
        for (a, b) in a.iter().zip(b) {
            assert!((a - b).abs() <= 1e-15 * a.abs(), "{a} {b}");
        }
    }
}
