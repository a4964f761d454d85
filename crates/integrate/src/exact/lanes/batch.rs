//! Marching a batch of sets.

use pulp::{Arch, Simd, WithSimd};

use super::block::{Block, motion_across};
use super::row::{Row, State, copy};
use super::set::LaneSet;
use super::source::{Source, fill, sources};
use super::wide::Wide;
use super::{LANES, Pack};
use crate::exact::law::MemberMotion;

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
    /// ẍ, m/s²; length n where [`LaneObserver::needs_acceleration`], else empty.
    pub acceleration: &'a [Pack],
    /// Force each element carries, N, where [`LaneObserver::reads_forces`] or [`LaneObserver::needs_acceleration`].
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

    /// Whether it looks at the displacement of a coordinate. The integral of a pressure, which moves nothing, is not computed
    /// where nobody reads it and stays where it was.
    fn reads_displacement(&self, coordinate: usize) -> bool {
        let _ = coordinate;
        true
    }

    /// Whether it looks at what the elements carry. Where nobody does, it is not added up at every sample and stays at zero.
    fn reads_forces(&self) -> bool {
        true
    }

    /// Eight sets at one sample. Mark it `#[inline(always)]` to have it in vector instructions.
    fn observe(&mut self, at: &LaneSnapshot<'_>);
}

/// An observer of any type: the march is the longest code there is to compile, and is compiled once for all of them.
trait Watch: LaneObserver {
    fn watch(&mut self, arch: Arch, at: &LaneSnapshot<'_>);
}

impl<O: LaneObserver> Watch for O {
    fn watch(&mut self, arch: Arch, at: &LaneSnapshot<'_>) {
        arch.dispatch(Observe(self, at));
    }
}

/// [`LaneObserver::observe`] in the best instructions there are; a closure would not be inlined into them.
struct Observe<'a, 'b, O>(&'a mut O, &'a LaneSnapshot<'b>);

impl<O: LaneObserver> WithSimd for Observe<'_, '_, O> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        self.0.observe(self.1);
    }
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
        self.march_watched(observer);
    }

    fn march_watched(&self, observer: &mut dyn Watch) {
        let arch = Arch::new();
        for (i, sets) in self.sets.chunks(LANES).enumerate() {
            let is_read = |coordinate: usize| observer.reads_displacement(coordinate);
            let block = [i * LANES, self.sample_count];
            let lanes = Lanes::new(arch, sets, block, &is_read);
            // The unit tests of this crate march nothing: for them the march is compiled for one size only.
            match sets[0].propagator.dof_count {
                #[cfg(not(test))]
                1 => arch.dispatch(March(lanes, [Pack::ZERO; 1], observer)),
                #[cfg(not(test))]
                2 => arch.dispatch(March(lanes, [Pack::ZERO; 2], observer)),
                #[cfg(not(test))]
                3 => arch.dispatch(March(lanes, [Pack::ZERO; 3], observer)),
                #[cfg(not(test))]
                4 => arch.dispatch(March(lanes, [Pack::ZERO; 4], observer)),
                n => arch.dispatch(March(lanes, vec![Pack::ZERO; n], observer)),
            }
        }
    }
}

/// A block with its excitations.
struct Lanes<'a> {
    block: Block<'a>,
    first_set: usize,
    set_count: usize,
    sample_count: usize,
    sets: [LaneSet<'a>; LANES],
    sources: Vec<Source<'a>>,
}

impl<'a> Lanes<'a> {
    fn new(
        arch: Arch,
        sets: &[LaneSet<'a>],
        [first_set, sample_count]: [usize; 2],
        is_read: &dyn Fn(usize) -> bool,
    ) -> Lanes<'a> {
        let lanes: [&LaneSet<'a>; LANES] = std::array::from_fn(|l| sets.get(l).unwrap_or(&sets[0]));
        Lanes {
            block: Block::new(arch, &lanes, is_read),
            first_set,
            set_count: sets.len(),
            sample_count,
            sources: sources(&lanes),
            sets: lanes.map(|set| *set),
        }
    }

    /// The state at the first sample.
    fn start<R: Row>(&self, zero: &R) -> State<R> {
        let put = |row: &mut R, values: &dyn Fn(usize) -> &'a [f64]| {
            for (i, pack) in row.packs_mut().iter_mut().enumerate() {
                *pack = Pack::of(|l| values(l).get(i).copied().unwrap_or(0.0));
            }
        };
        let mut state = State {
            displacement: zero.clone(),
            velocity: zero.clone(),
        };
        put(&mut state.displacement, &|l| self.sets[l].displacement);
        put(&mut state.velocity, &|l| self.sets[l].velocity);
        state
    }

    /// Adds to what an element whose force is spread over steps carries what it is at a point beyond that.
    fn add_beyond_step<S: Simd, R: Row>(
        &self,
        simd: S,
        [i, sample]: [usize; 2],
        (state, base): (&State<R>, &[Pack]),
        carried: &mut Pack,
    ) {
        let [displacement, velocity] = motion_across(simd, self.block.ports[i], state, base);
        let spread = self.sets.iter().enumerate();
        for (l, set) in spread.filter(|(_, set)| set.elements[i].law.is_spread_over_steps()) {
            let step_s = set.propagator.time_step_s;
            let steps = sample * set.excitation.substeps.max(1);
            carried.0[l] += set.elements[i].law.beyond_step(MemberMotion {
                displacement: displacement.0[l],
                velocity: velocity.0[l],
                time_s: set.excitation.time_s(steps, step_s),
                step_s,
            });
        }
    }

    /// Takes the excitation at a sample; a set that is over stays at its last.
    #[inline(always)]
    fn load<S: Simd, R: Row>(&self, simd: S, sample: usize, force: &mut R, base: &mut [Pack]) {
        let sources = &self.sources;
        fill(simd, sources, sample, force.packs_mut(), |e| e.dof_force);
        if !base.is_empty() {
            let (x, v) = base.split_at_mut(base.len() / 2);
            fill(simd, sources, sample, x, |e| e.base_displacement);
            fill(simd, sources, sample, v, |e| e.base_velocity);
        }
    }
}

/// `from + share (to − from)`, to the last bit `to` at its end.
#[inline(always)]
fn between<S: Simd>(simd: S, from: &[Pack], to: &[Pack], share: f64, out: &mut [Pack]) {
    for ((out, a), b) in out.iter_mut().zip(from).zip(to) {
        *out = if share == 1.0 {
            *b
        } else {
            let (a, b) = (Wide::of(simd, a), Wide::of(simd, b));
            (a + Wide::splat(simd, share) * (b - a)).pack()
        };
    }
}

/// The march of a block in the best instructions there are; a closure would not be inlined into
/// them. The row is one of zeros.
struct March<'a, 'b, R>(Lanes<'b>, R, &'a mut dyn Watch);

impl<R: Row> WithSimd for March<'_, '_, R> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        march(simd, self.0, self.1, self.2);
    }
}

#[inline(always)]
fn march<S: Simd, R: Row>(simd: S, mut lanes: Lanes<'_>, zero: R, observer: &mut dyn Watch) {
    let excitation = &lanes.sets[0].excitation;
    let (substeps, bases) = (excitation.substeps.max(1), excitation.base_count);
    let share = 1.0 / substeps as f64;
    let mut state = lanes.start(&zero);
    let mut next = state.clone();
    let (mut from, mut to) = (zero.clone(), zero.clone());
    let (mut before, mut after) = (zero.clone(), zero.clone());
    let [mut base_from, mut base_to, mut base] = [(); 3].map(|()| vec![Pack::ZERO; 2 * bases]);
    let mut seen = Seen::new(&lanes, &zero, observer);
    for sample in 0..lanes.sample_count {
        copy(&mut from, &to);
        if bases > 0 {
            base_from.copy_from_slice(&base_to);
        }
        lanes.load(simd, sample, &mut to, &mut base_to);
        for sub in 0..if sample == 0 { 0 } else { substeps } {
            let (start, end) = (sub as f64 * share, (sub + 1) as f64 * share);
            let steps = (sample - 1) * substeps + sub + 1;
            let states = [&mut state, &mut next];
            // Two calls: a choice between references would keep the rows in memory.
            if substeps == 1 {
                let forces = [&mut from, &mut to];
                lanes.block.step(simd, states, forces, &base_to, steps);
            } else {
                between(simd, from.packs(), to.packs(), start, before.packs_mut());
                between(simd, from.packs(), to.packs(), end, after.packs_mut());
                between(simd, &base_from, &base_to, end, &mut base);
                let forces = [&mut before, &mut after];
                lanes.block.step(simd, states, forces, &base, steps);
            }
        }
        seen.show(simd, &lanes, sample, &state, (&to, &base_to), observer);
    }
}

/// What an observer sees of a sample.
struct Seen<R> {
    state: State<R>,
    net: R,
    acceleration: R,
    carried: Vec<Pack>,
    needs_acceleration: bool,
    needs_forces: bool,
}

impl<R: Row> Seen<R> {
    fn new(lanes: &Lanes<'_>, zero: &R, observer: &dyn Watch) -> Seen<R> {
        let needs_acceleration = observer.needs_acceleration();
        Seen {
            needs_acceleration,
            needs_forces: needs_acceleration || observer.reads_forces(),
            state: State {
                displacement: zero.clone(),
                velocity: zero.clone(),
            },
            net: zero.clone(),
            acceleration: zero.clone(),
            carried: vec![Pack::ZERO; lanes.block.laws.len()],
        }
    }

    /// Hands a sample with the forces and bases of its excitation to the observer.
    #[inline(always)]
    fn show<S: Simd>(
        &mut self,
        simd: S,
        lanes: &Lanes<'_>,
        sample: usize,
        state: &State<R>,
        (force, base): (&R, &[Pack]),
        observer: &mut dyn Watch,
    ) {
        if self.needs_forces {
            lanes.block.carried(simd, &mut self.carried);
            for (i, carried) in self.carried.iter_mut().enumerate() {
                if lanes.block.spread[i] {
                    lanes.add_beyond_step(simd, [i, sample], (state, base), carried);
                }
            }
        }
        if self.needs_acceleration {
            copy(&mut self.net, force);
            lanes.block.add_to(simd, &self.carried, &mut self.net);
            let kernel = &lanes.block.kernel;
            kernel.acceleration(simd, state, &self.net, &mut self.acceleration);
        }
        let (base_displacement, base_velocity) = base.split_at(base.len() / 2);
        let acceleration = self.acceleration.packs();
        let at = LaneSnapshot {
            first_set: lanes.first_set,
            set_count: lanes.set_count,
            sample,
            displacement: state.displacement.shown(&mut self.state.displacement),
            velocity: state.velocity.shown(&mut self.state.velocity),
            acceleration: if self.needs_acceleration {
                acceleration
            } else {
                &[]
            },
            element_force: &self.carried,
            base_displacement,
            base_velocity,
        };
        observer.watch(lanes.block.arch, &at);
    }
}
