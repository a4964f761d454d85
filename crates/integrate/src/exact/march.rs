//! Marching through a sampled excitation: the linear part exactly, nonlinear forces on top.
//!
//! Over each step the single-valued nonlinear forces S vary linearly between their values at the
//! two ends, as the excitation does; dry forces D act by their mean over the step:
//!
//! ```text
//! z₁ = Φ z₀ + Γ₀ (f₀ − E S₀) + Γ₁ (f₁ − E S₁) − (Γ₀ + Γ₁) E D₁                 (1)
//! d = Eᵀ x,  v = Eᵀ ẋ                    motion across the elements             (2)
//! S₁ = φ(d₁, v₁, t₁)                                                            (3)
//! D₁ ∈ level(½ |v₀| + ½ |v₁|) Sgn(v₁)                                           (4)
//! ```
//!
//! (3) is second order in h. (4) is the non-smooth step of Moreau: sliding friction of constant
//! level is exact, one that depends on the speed of second order, sticking holds v₁ = 0 without a regularising slope, and D constant over the
//! step keeps the trapezoidal rule from ringing while it sticks. Through (1) each element sees
//! its own force: d₁ = d* − C S₁ − G D₁, so that (3) is a scalar equation solved by the secant
//! method and (4) a projection; several elements are swept until they agree.
//!
//! References: \[Moreau1988\]; \[Hochbruck2010\], section 2.

use super::columns::Columns;
use super::kernel::{Compact, Fixed, Kernel, array};
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

impl Excitation<'_> {
    /// When so many steps of a length have passed, s.
    pub(super) fn time_s(&self, steps: usize, step_s: f64) -> f64 {
        self.start_s + steps as f64 * step_s
    }
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
        acceleration.fill(0.0);
        for j in 0..n {
            let mut net = at.dof_force[j];
            for k in 0..n {
                net -= self.stiffness[j * n + k] * at.displacement[k]
                    + self.damping[j * n + k] * at.velocity[k];
            }
            for (i, out) in acceleration.iter_mut().enumerate().take(n) {
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
        observe: &mut (impl FnMut(&Snapshot<'_>) + ?Sized),
    ) {
        self.march_reading(
            elements,
            excitation,
            [displacement, velocity],
            &|_| true,
            observe,
        );
    }

    /// As [`ExactPropagator::march`] for an observer that looks at the displacements of these coordinates alone: the integral of
    /// a pressure, which moves nothing, is not computed where nobody reads it and stays where it was.
    pub fn march_reading(
        &self,
        elements: &[Element],
        excitation: &Excitation<'_>,
        [displacement, velocity]: [&[f64]; 2],
        is_read: &dyn Fn(usize) -> bool,
        observe: &mut (impl FnMut(&Snapshot<'_>) + ?Sized),
    ) {
        let mut state: Vec<f64> = displacement.iter().chain(velocity).copied().collect();
        state.resize(2 * self.dof_count, 0.0);
        if elements.is_empty() && excitation.substeps <= 1 {
            match self.dof_count {
                1 => return linear(&Fixed::<1>::new(self), excitation, &state, observe),
                2 => return linear(&Fixed::<2>::new(self), excitation, &state, observe),
                3 => return linear(&Fixed::<3>::new(self), excitation, &state, observe),
                4 => return linear(&Fixed::<4>::new(self), excitation, &state, observe),
                _ => (),
            }
        }
        let observe: &mut dyn FnMut(&Snapshot<'_>) = &mut |at| observe(at);
        let mut plant = Plant::new(self, elements);
        match self.dof_count {
            1 => plant.run(&mut Fixed::<1>::new(self), excitation, &mut state, observe),
            2 => plant.run(&mut Fixed::<2>::new(self), excitation, &mut state, observe),
            3 => plant.run(&mut Fixed::<3>::new(self), excitation, &mut state, observe),
            4 => plant.run(&mut Fixed::<4>::new(self), excitation, &mut state, observe),
            _ => {
                let columns = Columns::new(&[self], elements, &[excitation.dof_force], is_read);
                let mut kernel = Compact::new(self, columns);
                plant.run(&mut kernel, excitation, &mut state, observe);
            }
        }
    }
}

/// The march of a plant without elements, whose state stays in registers: each step waits for the one before.
fn linear<const N: usize>(
    kernel: &Fixed<N>,
    excitation: &Excitation<'_>,
    state: &[f64],
    observe: &mut (impl FnMut(&Snapshot<'_>) + ?Sized),
) {
    let mut state = [array::<N>(&state[..N]), array::<N>(&state[N..])];
    let mut before = [0.0; N];
    for index in 0..excitation.sample_count {
        let Some(sample) = excitation.sample(index, N) else {
            return;
        };
        let after = array::<N>(sample.force);
        if index > 0 {
            state = kernel.next(&state, &before, &after);
        }
        before = after;
        // A copy: what an observer may look at is in memory.
        let [displacement, velocity] = state;
        observe(&Snapshot {
            sample: index,
            displacement: &displacement,
            velocity: &velocity,
            dof_force: sample.force,
            element_force: &[],
        });
    }
}

impl Plant<'_> {
    fn run(
        &mut self,
        kernel: &mut impl Kernel,
        excitation: &Excitation<'_>,
        state: &mut [f64],
        observe: &mut dyn FnMut(&Snapshot<'_>),
    ) {
        let (n, m) = (self.propagator.dof_count, self.elements.len());
        let bases = excitation.base_count;
        let mut scratch = Scratch::new(n, bases);
        scratch.next.copy_from_slice(state);
        let mut carried = vec![0.0; m];
        let mut last: Option<Sample<'_>> = None;
        for index in 0..excitation.sample_count {
            let Some(sample) = excitation.sample(index, n) else {
                return;
            };
            if let Some(last) = last {
                self.advance(
                    kernel,
                    excitation,
                    index,
                    [&last, &sample],
                    state,
                    &mut scratch,
                );
            } else if m > 0 {
                scratch.base[..bases].copy_from_slice(sample.base_displacement);
                scratch.base[bases..].copy_from_slice(sample.base_velocity);
                self.begin(state, sample.force, &scratch.base, excitation.start_s);
            }
            let force = if m > 0 {
                scratch.net.copy_from_slice(sample.force);
                let steps = index * excitation.substeps.max(1);
                let time_s = excitation.time_s(steps, self.propagator.time_step_s);
                self.carry(state, &scratch.base, time_s, &mut carried);
                for (element, carried) in self.elements.iter().zip(&carried) {
                    spread(element, *carried, &mut scratch.net);
                }
                scratch.net.as_slice()
            } else {
                sample.force
            };
            let (displacement, velocity) = state.split_at(n);
            observe(&Snapshot {
                sample: index,
                displacement,
                velocity,
                dof_force: force,
                element_force: &carried,
            });
            last = Some(sample);
        }
    }

    /// From one sample to the next, in the steps of the excitation.
    #[inline(always)]
    fn advance(
        &mut self,
        kernel: &mut impl Kernel,
        excitation: &Excitation<'_>,
        index: usize,
        [from, to]: [&Sample<'_>; 2],
        state: &mut [f64],
        scratch: &mut Scratch,
    ) {
        if self.elements.is_empty() && excitation.substeps <= 1 {
            kernel.step(state, from.force, to.force, &mut scratch.next);
            state.copy_from_slice(&scratch.next);
            return;
        }
        let substeps = excitation.substeps.max(1);
        let share = 1.0 / substeps as f64;
        for sub in 0..substeps {
            // Fractions of the sample interval at the two ends of this step.
            let (start, end) = (sub as f64 * share, (sub + 1) as f64 * share);
            interpolate(from.force, to.force, start, &mut scratch.before);
            interpolate(from.force, to.force, end, &mut scratch.after);
            self.spread_smooth(&mut scratch.before);
            // (1) without S₁ and D₁
            kernel.step(state, &scratch.before, &scratch.after, &mut scratch.next);
            if !self.elements.is_empty() {
                let (x, v) = scratch.base.split_at_mut(excitation.base_count);
                interpolate(from.base_displacement, to.base_displacement, end, x);
                interpolate(from.base_velocity, to.base_velocity, end, v);
                let steps = (index - 1) * substeps + sub + 1;
                let time_s = excitation.time_s(steps, self.propagator.time_step_s);
                self.solve(&scratch.next, &scratch.base, time_s);
                self.push(kernel, &mut scratch.next, &mut scratch.net);
            }
            state.copy_from_slice(&scratch.next);
        }
    }
}

#[inline(always)]
fn interpolate(from: &[f64], to: &[f64], share: f64, out: &mut [f64]) {
    if share == 1.0 {
        out.copy_from_slice(to);
        return;
    }
    for ((out, a), b) in out.iter_mut().zip(from).zip(to) {
        *out = a + share * (b - a);
    }
}

/// The excitation at one sample.
struct Sample<'a> {
    force: &'a [f64],
    base_displacement: &'a [f64],
    base_velocity: &'a [f64],
}

impl<'a> Excitation<'a> {
    fn sample(&self, index: usize, dof_count: usize) -> Option<Sample<'a>> {
        let bases = index * self.base_count..(index + 1) * self.base_count;
        Some(Sample {
            force: self
                .dof_force
                .get(index * dof_count..(index + 1) * dof_count)?,
            base_displacement: self.base_displacement.get(bases.clone())?,
            base_velocity: self.base_velocity.get(bases)?,
        })
    }
}

/// Room for one step.
struct Scratch {
    before: Vec<f64>,
    after: Vec<f64>,
    next: Vec<f64>,
    net: Vec<f64>,
    /// Displacements, then velocities of the bases.
    base: Vec<f64>,
}

impl Scratch {
    fn new(n: usize, bases: usize) -> Scratch {
        Scratch {
            before: vec![0.0; n],
            after: vec![0.0; n],
            next: vec![0.0; 2 * n],
            net: vec![0.0; n],
            base: vec![0.0; 2 * bases],
        }
    }
}
