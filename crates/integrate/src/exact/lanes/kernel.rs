//! The linear part of one step for eight sets.

use pulp::Simd;

use super::arithmetic::{add, add_product, mul, sub};
use super::{LANES, Pack};
use crate::exact::propagator::ExactPropagator;

/// The matrices of eight propagators, row-major.
pub(super) struct LaneKernel {
    phi: Vec<Pack>,
    gamma0: Vec<Pack>,
    gamma1: Vec<Pack>,
    held: Vec<Pack>,
    inverse_mass: Vec<Pack>,
    stiffness: Vec<Pack>,
    damping: Vec<Pack>,
}

impl LaneKernel {
    pub(super) fn new(propagators: &[&ExactPropagator; LANES]) -> LaneKernel {
        let pack = |matrix: &dyn Fn(&ExactPropagator) -> Vec<f64>| -> Vec<Pack> {
            let lanes = propagators.map(matrix);
            (0..lanes[0].len())
                .map(|k| Pack::of(|l| lanes[l].get(k).copied().unwrap_or(0.0)))
                .collect()
        };
        LaneKernel {
            phi: pack(&|p| p.phi.clone()),
            gamma0: pack(&|p| p.gamma0.clone()),
            gamma1: pack(&|p| p.gamma1.clone()),
            held: pack(&|p| p.gamma0.iter().zip(&p.gamma1).map(|(a, b)| a + b).collect()),
            inverse_mass: pack(&|p| p.inverse_mass.clone()),
            stiffness: pack(&|p| p.stiffness.clone()),
            damping: pack(&|p| p.damping.clone()),
        }
    }

    /// The step `z₁ = Φ z₀ + Γ₀ f₀ + Γ₁ f₁`, in the order of the march of one set. `n` is the
    /// number of degrees of freedom, where possible one that the compiler knows.
    #[inline(always)]
    pub(super) fn step<S: Simd>(
        &self,
        simd: S,
        n: usize,
        [state, before, after]: [&[Pack]; 3],
        next: &mut [Pack],
    ) {
        let (state, next) = (&state[..2 * n], &mut next[..2 * n]);
        let (before, after) = (&before[..n], &after[..n]);
        let (gamma0, gamma1) = (&self.gamma0[..2 * n * n], &self.gamma1[..2 * n * n]);
        let phi = &self.phi[..4 * n * n];
        for i in 0..2 * n {
            let mut sum = Pack::ZERO;
            for j in 0..n {
                sum = add_product(simd, &sum, &gamma0[i * n + j], &before[j]);
            }
            for j in 0..n {
                sum = add_product(simd, &sum, &gamma1[i * n + j], &after[j]);
            }
            for j in 0..2 * n {
                sum = add_product(simd, &sum, &phi[i * 2 * n + j], &state[j]);
            }
            next[i] = sum;
        }
    }

    /// Adds Γ₁ f to `next`.
    #[inline(always)]
    pub(super) fn push_end<S: Simd>(&self, simd: S, n: usize, force: &[Pack], next: &mut [Pack]) {
        push(simd, n, &self.gamma1, force, next);
    }

    /// Adds (Γ₀ + Γ₁) f to `next`.
    #[inline(always)]
    pub(super) fn push_held<S: Simd>(&self, simd: S, n: usize, force: &[Pack], next: &mut [Pack]) {
        push(simd, n, &self.held, force, next);
    }

    /// Acceleration `M⁻¹ (f − C ẋ − K x)`, m/s²; `n` as in [`LaneKernel::step`].
    #[inline(always)]
    pub(super) fn acceleration<S: Simd>(
        &self,
        simd: S,
        n: usize,
        [displacement, velocity, force]: [&[Pack]; 3],
        acceleration: &mut [Pack],
    ) {
        let (displacement, velocity) = (&displacement[..n], &velocity[..n]);
        let (force, acceleration) = (&force[..n], &mut acceleration[..n]);
        acceleration.fill(Pack::ZERO);
        for j in 0..n {
            let mut net = force[j];
            for k in 0..n {
                let spring = mul(simd, &self.stiffness[j * n + k], &displacement[k]);
                let damper = mul(simd, &self.damping[j * n + k], &velocity[k]);
                net = sub(simd, &net, &add(simd, &spring, &damper));
            }
            for i in 0..n {
                let mobility = &self.inverse_mass[i * n + j];
                acceleration[i] = add_product(simd, &acceleration[i], mobility, &net);
            }
        }
    }
}

#[inline(always)]
fn push<S: Simd>(simd: S, n: usize, gamma: &[Pack], force: &[Pack], next: &mut [Pack]) {
    let (gamma, force, next) = (&gamma[..2 * n * n], &force[..n], &mut next[..2 * n]);
    for i in 0..2 * n {
        let mut sum = next[i];
        for j in 0..n {
            sum = add_product(simd, &sum, &gamma[i * n + j], &force[j]);
        }
        next[i] = sum;
    }
}
