//! Marching through a sampled excitation: the linear part exactly, nonlinear forces on top.
//!
//! Over each step the single-valued nonlinear forces S vary linearly between their values at the
//! two ends, as the excitation does; dry forces D keep their end value:
//!
//! ```text
//! z₁ = Φ z₀ + Γ₀ (f₀ − E S₀) + Γ₁ (f₁ − E S₁) − (Γ₀ + Γ₁) E D₁                 (1)
//! d = Eᵀ x,  v = Eᵀ ẋ                    motion across the elements             (2)
//! S₁ = φ(d₁, v₁, t₁)                                                            (3)
//! D₁ ∈ level(|v₁|) Sgn(v₁)                                                      (4)
//! ```
//!
//! (3) is second order in h. (4) is the non-smooth step of Moreau: sliding friction of constant
//! level is exact, sticking holds v₁ = 0 without a regularising slope, and D constant over the
//! step keeps the trapezoidal rule from ringing while it sticks. Through (1) each element sees
//! its own force: d₁ = d* − C S₁ − G D₁, so that (3) is a scalar equation solved by the secant
//! method and (4) a projection; several elements are swept until they agree.
//!
//! References: \[Moreau1988\]; \[Hochbruck2010\], section 2.

use super::law::Element;
use super::plant::{Plant, spread};
use super::propagator::ExactPropagator;

/// A sampled excitation; values between samples are interpolated linearly.
#[derive(Debug, Clone, Copy)]
pub struct Excitation<'a> {
    /// Force on each degree of freedom, N; samples × n, row-major.
    pub dof_force: &'a [f64],
    /// Displacement of each base node, m; samples × bases, row-major.
    pub base_displacement: &'a [f64],
    /// Velocity of each base node, m/s; samples × bases, row-major.
    pub base_velocity: &'a [f64],
    /// Number of base nodes.
    pub base_count: usize,
    /// Number of samples.
    pub sample_count: usize,
    /// Time of the first sample on the clock of the record, s.
    pub start_s: f64,
    /// Steps of the propagator between two samples, at least 1.
    pub substeps: usize,
}

/// The plant at one sample.
#[derive(Debug, Clone, Copy)]
pub struct Snapshot<'a> {
    /// Index of the sample.
    pub sample: usize,
    /// x, m; length n.
    pub displacement: &'a [f64],
    /// ẋ, m/s; length n.
    pub velocity: &'a [f64],
    /// Force on each degree of freedom, nonlinear forces included, N; length n.
    pub dof_force: &'a [f64],
    /// Force each element carries, N.
    pub element_force: &'a [f64],
}

impl ExactPropagator {
    /// Acceleration at a sample, `M⁻¹ (f − C ẋ − K x)`, m/s², written to `acceleration`.
    pub fn acceleration(&self, at: &Snapshot<'_>, acceleration: &mut [f64]) {
        let n = self.dof_count;
        for (i, out) in acceleration.iter_mut().enumerate().take(n) {
            *out = 0.0;
            for j in 0..n {
                let mut net = at.dof_force[j];
                for k in 0..n {
                    net -= self.stiffness[j * n + k] * at.displacement[k]
                        + self.damping[j * n + k] * at.velocity[k];
                }
                *out += self.inverse_mass[i * n + j] * net;
            }
        }
    }

    /// Marches from `displacement` and `velocity` at the first sample through the excitation and
    /// hands every sample to `observe`.
    ///
    /// The propagator's step must be the sample interval divided by `substeps`; slices shorter
    /// than the counts say end the march at the last whole sample.
    pub fn march(
        &self,
        elements: &[Element],
        excitation: &Excitation<'_>,
        displacement: &[f64],
        velocity: &[f64],
        observe: &mut dyn FnMut(&Snapshot<'_>),
    ) {
        let mut state: Vec<f64> = displacement.iter().chain(velocity).copied().collect();
        state.resize(2 * self.dof_count, 0.0);
        let mut plant = Plant::new(self, elements);
        // A count known to the compiler unrolls the small matrix products.
        match self.dof_count {
            0 => plant.run(0, excitation, &mut state, observe),
            1 => plant.run(1, excitation, &mut state, observe),
            2 => plant.run(2, excitation, &mut state, observe),
            3 => plant.run(3, excitation, &mut state, observe),
            4 => plant.run(4, excitation, &mut state, observe),
            n => plant.run(n, excitation, &mut state, observe),
        }
    }
}

impl Plant<'_> {
    #[inline(always)]
    fn run(
        &mut self,
        n: usize,
        excitation: &Excitation<'_>,
        state: &mut [f64],
        observe: &mut dyn FnMut(&Snapshot<'_>),
    ) {
        let m = self.elements.len();
        let bases = excitation.base_count;
        let substeps = excitation.substeps.max(1);
        let h = self.propagator.time_step_s;
        // Slices of a length the compiler knows leave no bounds to check in the products.
        let propagator = self.propagator;
        let phi = &propagator.phi[..4 * n * n];
        let gamma0 = &propagator.gamma0[..2 * n * n];
        let gamma1 = &propagator.gamma1[..2 * n * n];
        let state = &mut state[..2 * n];
        let (mut before, mut after, mut net) = (vec![0.0; n], vec![0.0; n], vec![0.0; n]);
        let (before, after, net) = (&mut before[..n], &mut after[..n], &mut net[..n]);
        let mut next = vec![0.0; 2 * n];
        let next = &mut next[..2 * n];
        let mut base = vec![0.0; 2 * bases];
        let mut carried = vec![0.0; m];

        for sample in 0..excitation.sample_count {
            let (Some(force), Some(base_x), Some(base_v)) = (
                excitation.dof_force.get(sample * n..(sample + 1) * n),
                excitation
                    .base_displacement
                    .get(sample * bases..(sample + 1) * bases),
                excitation
                    .base_velocity
                    .get(sample * bases..(sample + 1) * bases),
            ) else {
                return;
            };
            if sample > 0 {
                let from = (sample - 1) * n;
                let base_from = (sample - 1) * bases;
                for sub in 1..=substeps {
                    // Fractions of the sample interval at the two ends of this step.
                    let start = (sub - 1) as f64 / substeps as f64;
                    let end = sub as f64 / substeps as f64;
                    for i in 0..n {
                        let (f0, f1) = (excitation.dof_force[from + i], force[i]);
                        before[i] = f0 + start * (f1 - f0);
                        after[i] = f0 + end * (f1 - f0);
                    }
                    for (element, &s) in self.elements.iter().zip(&self.smooth) {
                        spread(element, s, before);
                    }
                    // (1) without S₁ and D₁
                    for i in 0..2 * n {
                        let mut sum = 0.0;
                        for j in 0..2 * n {
                            sum += phi[i * 2 * n + j] * state[j];
                        }
                        for j in 0..n {
                            sum += gamma0[i * n + j] * before[j] + gamma1[i * n + j] * after[j];
                        }
                        next[i] = sum;
                    }
                    if m > 0 {
                        for i in 0..bases {
                            let x0 = excitation.base_displacement[base_from + i];
                            let v0 = excitation.base_velocity[base_from + i];
                            base[i] = x0 + end * (base_x[i] - x0);
                            base[bases + i] = v0 + end * (base_v[i] - v0);
                        }
                        let steps = ((sample - 1) * substeps + sub) as f64;
                        self.solve(next, &base, excitation.start_s + steps * h);
                        self.push(n, next, net);
                    }
                    state.copy_from_slice(next);
                }
            } else if m > 0 {
                base[..bases].copy_from_slice(base_x);
                base[bases..].copy_from_slice(base_v);
                self.begin(n, state, force, &base, excitation.start_s);
            }
            net.copy_from_slice(force);
            for i in 0..m {
                carried[i] = self.smooth[i] + self.dry_force[i];
                spread(&self.elements[i], carried[i], net);
            }
            observe(&Snapshot {
                sample,
                displacement: &state[..n],
                velocity: &state[n..],
                dof_force: net,
                element_force: &carried,
            });
        }
    }
}
