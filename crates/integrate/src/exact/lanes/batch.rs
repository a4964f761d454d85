//! Marching a batch of sets.

use pulp::{Arch, Simd, WithSimd};

use super::arithmetic;
use super::block::Block;
use super::{LANES, Pack};
use crate::exact::law::Element;
use crate::exact::march::Excitation;
use crate::exact::plant::Plant;
use crate::exact::propagator::ExactPropagator;

/// One parameter set: what [`ExactPropagator::march`] takes.
#[derive(Clone, Copy)]
pub struct LaneSet<'a> {
    /// The linear part.
    pub propagator: &'a ExactPropagator,
    /// The nonlinear forces.
    pub elements: &'a [Element],
    /// The excitation; sets of one batch may have different ones, of different lengths.
    pub excitation: Excitation<'a>,
    /// x at the first sample, m.
    pub displacement: &'a [f64],
    /// ẋ at the first sample, m/s.
    pub velocity: &'a [f64],
}

impl<'a> LaneSet<'a> {
    /// Whether two sets can be marched in one batch: the same masses, elements at the same places
    /// that rub and remember alike, the same bases and substeps.
    #[must_use]
    pub fn is_alike(&self, other: &LaneSet<'_>) -> bool {
        let alike = |a: &Element, b: &Element| {
            (a.a, a.b) == (b.a, b.b)
                && a.law.dry_level(0.0).is_some() == b.law.dry_level(0.0).is_some()
                && a.law.remembers() == b.law.remembers()
        };
        self.propagator.dof_count == other.propagator.dof_count
            && self.elements.len() == other.elements.len()
            && self
                .elements
                .iter()
                .zip(other.elements)
                .all(|(a, b)| alike(a, b))
            && self.excitation.base_count == other.excitation.base_count
            && self.excitation.substeps == other.excitation.substeps
    }

    /// Samples that the excitation holds in full.
    fn sample_count(&self) -> usize {
        let whole = |values: &[f64], width: usize| match width {
            0 => usize::MAX,
            width => values.len() / width,
        };
        let e = &self.excitation;
        e.sample_count
            .min(whole(e.dof_force, self.propagator.dof_count))
            .min(whole(e.base_displacement, e.base_count))
            .min(whole(e.base_velocity, e.base_count))
    }

    /// The elements at the first sample.
    pub(super) fn begin(&self) -> Plant<'a> {
        let n = self.propagator.dof_count;
        let e = &self.excitation;
        let mut plant = Plant::new(self.propagator, self.elements);
        if self.sample_count() > 0 && !self.elements.is_empty() {
            let mut state: Vec<f64> = self
                .displacement
                .iter()
                .chain(self.velocity)
                .copied()
                .collect();
            state.resize(2 * n, 0.0);
            let bases = e.base_displacement.iter().take(e.base_count);
            let base: Vec<f64> = bases
                .chain(e.base_velocity.iter().take(e.base_count))
                .copied()
                .collect();
            plant.begin(n, &state, &e.dof_force[..n], &base, e.start_s);
        }
        plant
    }
}

/// Eight sets at one sample; a value in a lane belongs to the set of that lane.
pub struct LaneSnapshot<'a> {
    /// Place of the set in the first lane among the sets of the batch; the others follow it.
    pub first_set: usize,
    /// Lanes that hold a set; the rest repeat one.
    pub set_count: usize,
    /// Index of the sample; a set whose excitation is over stays at its last.
    pub sample: usize,
    /// x, m; length n.
    pub displacement: &'a [Pack],
    /// ẋ, m/s; length n.
    pub velocity: &'a [Pack],
    /// Force on each degree of freedom, nonlinear forces included, N; length n.
    pub dof_force: &'a [Pack],
    /// ẍ, m/s²; length n where [`LaneObserver::needs_acceleration`], else empty.
    pub acceleration: &'a [Pack],
    /// Force each element carries, N.
    pub element_force: &'a [Pack],
    /// Displacement of each base node, m.
    pub base_displacement: &'a [Pack],
    /// Velocity of each base node, m/s.
    pub base_velocity: &'a [Pack],
}

/// Sees every sample of a batch.
pub trait LaneObserver {
    /// Whether it looks at accelerations.
    fn needs_acceleration(&self) -> bool;

    /// Eight sets at one sample. Mark it `#[inline(always)]` to have it in vector instructions.
    fn observe(&mut self, at: &LaneSnapshot<'_>);
}

/// Sets of one structure.
pub struct Batch<'a> {
    sets: Vec<LaneSet<'a>>,
    sample_count: usize,
}

impl<'a> Batch<'a> {
    /// Takes sets that are all alike ([`LaneSet::is_alike`]); `None` if they are not.
    #[must_use]
    pub fn new(sets: Vec<LaneSet<'a>>) -> Option<Batch<'a>> {
        let alike = sets.iter().all(|set| set.is_alike(&sets[0]));
        let sample_count = sets.iter().map(LaneSet::sample_count).max().unwrap_or(0);
        alike.then_some(Batch { sets, sample_count })
    }

    /// Marches every set from its initial state through its excitation.
    pub fn march(&self, observer: &mut impl LaneObserver) {
        let (arch, count) = (Arch::new(), self.sample_count);
        for (i, sets) in self.sets.chunks(LANES).enumerate() {
            let lanes = &mut Lanes::new(arch, sets, i * LANES);
            match sets[0].propagator.dof_count {
                1 => arch.dispatch(March::<1, _>(lanes, count, observer)),
                2 => arch.dispatch(March::<2, _>(lanes, count, observer)),
                3 => arch.dispatch(March::<3, _>(lanes, count, observer)),
                4 => arch.dispatch(March::<4, _>(lanes, count, observer)),
                _ => arch.dispatch(March::<0, _>(lanes, count, observer)),
            }
        }
    }
}

/// A sample of eight excitations.
struct At<'a> {
    sample: usize,
    counts: &'a [usize; LANES],
    shared: bool,
}

impl At<'_> {
    /// Takes a part of the excitations, `width` values a sample.
    #[inline(always)]
    fn fill<'e>(&self, width: usize, out: &mut [Pack], values: impl Fn(usize) -> &'e [f64]) {
        if self.shared {
            let row = row(values(0), self.sample, self.counts[0], width);
            for (out, value) in out.iter_mut().zip(row) {
                *out = Pack([*value; LANES]);
            }
            return;
        }
        for l in 0..LANES {
            let row = row(values(l), self.sample, self.counts[l], width);
            for (out, value) in out.iter_mut().zip(row) {
                out.0[l] = *value;
            }
        }
    }
}

/// The values at a sample, or at the last where that is over.
#[inline(always)]
fn row(values: &[f64], sample: usize, count: usize, width: usize) -> &[f64] {
    let at = sample.min(count.saturating_sub(1)) * width;
    values.get(at..at + width).unwrap_or(&[])
}

/// A block with its excitations.
struct Lanes<'a> {
    block: Block<'a>,
    first_set: usize,
    set_count: usize,
    excitations: [Excitation<'a>; LANES],
    counts: [usize; LANES],
    /// Whether all lanes have one excitation.
    shared: bool,
    /// Forces at the samples before and after a step.
    force: [Vec<Pack>; 2],
    /// Displacements, then velocities of the bases at these samples.
    base: [Vec<Pack>; 2],
    carried: Vec<Pack>,
    acceleration: Vec<Pack>,
}

impl<'a> Lanes<'a> {
    fn new(arch: Arch, sets: &[LaneSet<'a>], first_set: usize) -> Lanes<'a> {
        let lanes: [&LaneSet<'a>; LANES] = std::array::from_fn(|l| sets.get(l).unwrap_or(&sets[0]));
        let one = &lanes[0].excitation;
        let same = |a: &[f64], b: &[f64]| std::ptr::eq(a, b);
        let n = lanes[0].propagator.dof_count;
        Lanes {
            block: Block::new(arch, &lanes),
            first_set,
            set_count: sets.len(),
            excitations: lanes.map(|set| set.excitation),
            counts: lanes.map(LaneSet::sample_count),
            shared: lanes.iter().all(|set| {
                let e = &set.excitation;
                same(e.dof_force, one.dof_force)
                    && same(e.base_displacement, one.base_displacement)
                    && same(e.base_velocity, one.base_velocity)
            }),
            force: [vec![Pack::ZERO; n], vec![Pack::ZERO; n]],
            base: [(); 2].map(|()| vec![Pack::ZERO; 2 * one.base_count]),
            carried: vec![Pack::ZERO; lanes[0].elements.len()],
            acceleration: vec![Pack::ZERO; n],
        }
    }

    /// Takes the excitation at a sample; a set that is over stays at its last.
    #[inline(always)]
    fn load(&mut self, n: usize, sample: usize) {
        let bases = self.base[0].len() / 2;
        // Copied, not swapped: the next loads would wait for the pointers.
        let [before, after] = &mut self.force;
        before[..n].copy_from_slice(&after[..n]);
        if bases > 0 {
            let [before, after] = &mut self.base;
            before.copy_from_slice(after);
        }
        let at = At {
            sample,
            counts: &self.counts,
            shared: self.shared,
        };
        at.fill(n, &mut self.force[1][..n], |l| {
            self.excitations[l].dof_force
        });
        if bases > 0 {
            let (x, v) = self.base[1].split_at_mut(bases);
            at.fill(bases, x, |l| self.excitations[l].base_displacement);
            at.fill(bases, v, |l| self.excitations[l].base_velocity);
        }
    }

    /// Puts the excitation at two shares of the sample interval in place.
    #[inline(always)]
    fn interpolate<S: Simd>(&mut self, simd: S, n: usize, start: f64, end: f64) {
        let [from, to] = [&self.force[0][..n], &self.force[1][..n]];
        between(simd, from, to, start, &mut self.block.before[..n]);
        between(simd, from, to, end, &mut self.block.after[..n]);
        let [from, to] = &self.base;
        between(simd, from, to, end, &mut self.block.base);
    }

    /// Puts the excitation at both ends of the sample interval in place.
    #[inline(always)]
    fn take_whole(&mut self, n: usize) {
        self.block.before[..n].copy_from_slice(&self.force[0][..n]);
        self.block.after[..n].copy_from_slice(&self.force[1][..n]);
        if !self.base[1].is_empty() {
            self.block.base.copy_from_slice(&self.base[1]);
        }
    }
}

#[inline(always)]
fn between<S: Simd>(simd: S, from: &[Pack], to: &[Pack], share: f64, out: &mut [Pack]) {
    for ((out, a), b) in out.iter_mut().zip(from).zip(to) {
        *out = if share == 1.0 {
            *b
        } else {
            arithmetic::between(simd, a, b, share)
        };
    }
}

/// [`march`] in the best instructions there are; a closure would not be inlined into them.
struct March<'a, 'b, const N: usize, O>(&'a mut Lanes<'b>, usize, &'a mut O);

impl<const N: usize, O: LaneObserver> WithSimd for March<'_, '_, N, O> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        march::<N, S>(simd, self.0, self.1, self.2);
    }
}

/// `N` is the number of degrees of freedom, zero where the compiler does not know it.
#[inline(always)]
fn march<const N: usize, S: Simd>(
    simd: S,
    lanes: &mut Lanes<'_>,
    sample_count: usize,
    observer: &mut impl LaneObserver,
) {
    let substeps = lanes.excitations[0].substeps.max(1);
    let share = 1.0 / substeps as f64;
    let n = if N == 0 { lanes.force[0].len() } else { N };
    for sample in 0..sample_count {
        lanes.load(n, sample);
        for sub in 0..if sample == 0 { 0 } else { substeps } {
            if substeps == 1 {
                lanes.take_whole(n);
            } else {
                let (start, end) = (sub as f64 * share, (sub + 1) as f64 * share);
                lanes.interpolate(simd, n, start, end);
            }
            let steps = (sample - 1) * substeps + sub + 1;
            lanes.block.step(simd, n, steps);
        }
        observe(simd, n, lanes, sample, observer);
    }
}

#[inline(always)]
fn observe<S: Simd>(
    simd: S,
    n: usize,
    lanes: &mut Lanes<'_>,
    sample: usize,
    observer: &mut impl LaneObserver,
) {
    let block = &mut lanes.block;
    block.after[..n].copy_from_slice(&lanes.force[1][..n]);
    block.load(simd, n, &mut lanes.carried);
    let (displacement, velocity) = block.state[..2 * n].split_at(n);
    let (base_displacement, base_velocity) = lanes.base[1].split_at(lanes.base[1].len() / 2);
    let acceleration = if observer.needs_acceleration() {
        let at = [displacement, velocity, &block.net];
        block
            .kernel
            .acceleration(simd, n, at, &mut lanes.acceleration);
        &lanes.acceleration[..]
    } else {
        &[]
    };
    observer.observe(&LaneSnapshot {
        first_set: lanes.first_set,
        set_count: lanes.set_count,
        sample,
        displacement,
        velocity,
        dof_force: &block.net,
        acceleration,
        element_force: &lanes.carried,
        base_displacement,
        base_velocity,
    });
}
