//! The linear part of one step, for a number of degrees of freedom known to the compiler and for
//! any number.

use super::propagator::ExactPropagator;

/// One step of `z₁ = Φ z₀ + Γ₀ f₀ + Γ₁ f₁`.
pub(super) trait Kernel {
    /// The step, from `state` to `next` (displacements, then velocities).
    fn step(&self, state: &[f64], before: &[f64], after: &[f64], next: &mut [f64]);

    /// Adds Γ₁ f₁ to `next`.
    fn push_end(&self, force: &[f64], next: &mut [f64]);

    /// Adds (Γ₀ + Γ₁) f to `next`: a force held over the step.
    fn push_held(&self, force: &[f64], next: &mut [f64]);
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
fn array<const N: usize>(slice: &[f64]) -> [f64; N] {
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

impl<const N: usize> Kernel for Fixed<N> {
    #[inline(always)]
    fn step(&self, state: &[f64], before: &[f64], after: &[f64], next: &mut [f64]) {
        let (x, v) = (array::<N>(&state[..N]), array::<N>(&state[N..2 * N]));
        let (f0, f1) = (array::<N>(&before[..N]), array::<N>(&after[..N]));
        for (half, out) in next[..2 * N].chunks_exact_mut(N).enumerate() {
            let mut sum = [0.0; N];
            add_product(&self.gamma0[half], &f0, &mut sum);
            add_product(&self.gamma1[half], &f1, &mut sum);
            add_product(&self.phi[half][0], &x, &mut sum);
            add_product(&self.phi[half][1], &v, &mut sum);
            out.copy_from_slice(&sum);
        }
    }

    #[inline(always)]
    fn push_end(&self, force: &[f64], next: &mut [f64]) {
        push(&self.gamma1, force, next);
    }

    #[inline(always)]
    fn push_held(&self, force: &[f64], next: &mut [f64]) {
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

/// Any number of degrees of freedom, none included.
pub(super) struct Dense<'a> {
    propagator: &'a ExactPropagator,
    held: Vec<f64>,
}

impl<'a> Dense<'a> {
    pub(super) fn new(propagator: &'a ExactPropagator) -> Dense<'a> {
        let ends = propagator.gamma0.iter().zip(&propagator.gamma1);
        Dense {
            propagator,
            held: ends.map(|(a, b)| a + b).collect(),
        }
    }
}

impl Kernel for Dense<'_> {
    fn step(&self, state: &[f64], before: &[f64], after: &[f64], next: &mut [f64]) {
        next.fill(0.0);
        add_rows(&self.propagator.gamma0, before, next);
        add_rows(&self.propagator.gamma1, after, next);
        add_rows(&self.propagator.phi, state, next);
    }

    fn push_end(&self, force: &[f64], next: &mut [f64]) {
        add_rows(&self.propagator.gamma1, force, next);
    }

    fn push_held(&self, force: &[f64], next: &mut [f64]) {
        add_rows(&self.held, force, next);
    }
}

fn add_rows(matrix: &[f64], vector: &[f64], sum: &mut [f64]) {
    if vector.is_empty() {
        return;
    }
    for (row, out) in matrix.chunks_exact(vector.len()).zip(sum) {
        for (a, b) in row.iter().zip(vector) {
            *out += a * b;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use faer::Mat;
    use simgap_model::StructuralMatrices;

    #[test]
    fn verify_fixed_and_dense_agree() {
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
        let (fixed, dense) = (Fixed::<3>::new(&propagator), Dense::new(&propagator));
        let state = [0.1, -0.2, 0.3, 1.0, -2.0, 0.5];
        let (f0, f1) = ([3.0, -1.0, 2.0], [0.5, 4.0, -2.0]);
        let (mut a, mut b) = ([0.0; 6], [0.0; 6]);
        fixed.step(&state, &f0, &f1, &mut a);
        dense.step(&state, &f0, &f1, &mut b);
        fixed.push_end(&f0, &mut a);
        dense.push_end(&f0, &mut b);
        fixed.push_held(&f1, &mut a);
        dense.push_held(&f1, &mut b);
        for (x, y) in a.iter().zip(&b) {
            assert!((x - y).abs() < 1e-13, "{x} {y}");
        }
    }
}
