//! What an observer is shown.

use std::ops::Range;

use pulp::Simd;

use super::Pack;
use super::acceleration::Acceleration;
use super::block::Block;
use super::drive::Drive;
use super::eight::Eight;
use super::observer::{LaneSamples, Rows, SHOWN, Watch};
use super::row::{Row, State};

/// What an observer has not seen yet, sample by sample.
pub(super) struct Seen<R> {
    displacement: Vec<Pack>,
    velocity: Vec<Pack>,
    acceleration: Vec<Pack>,
    carried: Vec<Pack>,
    /// Those whose forces are asked for.
    elements: usize,
    needed: Acceleration,
    net: R,
}

impl<R: Row> Seen<R> {
    pub(super) fn new(lanes: &Eight<'_>, zero: &R, observer: &dyn Watch) -> Seen<R> {
        let n = zero.packs().len();
        let is_read = |i: usize| observer.reads_acceleration(i);
        let needed = Acceleration::new(&lanes.sets, n, &is_read);
        let needs_forces = needed.width > 0 || observer.reads_forces();
        let elements = if needs_forces {
            lanes.block.laws.len()
        } else {
            0
        };
        let room = |width: usize| vec![Pack::ZERO; SHOWN * width];
        Seen {
            displacement: room(n),
            velocity: room(n),
            acceleration: room(needed.width),
            carried: room(elements),
            elements,
            needed,
            net: zero.clone(),
        }
    }

    /// Takes down the state at the k-th sample.
    #[inline(always)]
    pub(super) fn take(&mut self, k: usize, state: &State<R>) {
        let n = self.net.packs().len();
        row(&mut self.displacement, n, k).copy_from_slice(state.displacement.packs());
        row(&mut self.velocity, n, k).copy_from_slice(state.velocity.packs());
    }

    /// Takes down what the elements carry at the k-th sample.
    #[inline(always)]
    pub(super) fn take_forces<S: Simd>(&mut self, simd: S, k: usize, block: &Block<'_>) {
        if self.elements > 0 {
            block.carried(simd, row(&mut self.carried, self.elements, k));
        }
    }

    /// What follows from the states and the forces of the elements.
    #[inline(always)]
    pub(super) fn complete<S: Simd>(
        &mut self,
        simd: S,
        lanes: &Eight<'_>,
        drive: &Drive<R>,
        samples: Range<usize>,
    ) {
        let n = self.net.packs().len();
        let is_needed = self.needed.width > 0;
        let is_spread = self.elements > 0 && lanes.block.spread.contains(&true);
        if !is_needed && !is_spread {
            return;
        }
        for (k, sample) in samples.enumerate() {
            let state = [
                Rows::new(&self.displacement, n).at(k),
                Rows::new(&self.velocity, n).at(k),
            ];
            let carried = row(&mut self.carried, self.elements, k);
            if is_spread {
                lanes.add_beyond_step(simd, sample, (state, drive.base(k + 1)), carried);
            }
            if is_needed {
                let [_, force] = drive.forces(k);
                self.net.packs_mut().copy_from_slice(force);
                lanes.block.add_to(simd, carried, &mut self.net);
                let out = row(&mut self.acceleration, n, k);
                self.needed.write(simd, state, self.net.packs(), out);
            }
        }
    }

    /// Shows the observer what was taken down.
    pub(super) fn show(
        &self,
        lanes: &Eight<'_>,
        drive: &Drive<R>,
        samples: Range<usize>,
        observer: &mut dyn Watch,
    ) {
        let n = self.net.packs().len();
        let samples = LaneSamples {
            first_set: lanes.first_set,
            set_count: lanes.set_count,
            first: samples.start,
            count: samples.len(),
            displacement: Rows::new(&self.displacement, n),
            velocity: Rows::new(&self.velocity, n),
            acceleration: Rows::new(&self.acceleration, self.needed.width),
            element_force: Rows::new(&self.carried, self.elements),
            base: drive.bases(),
        };
        observer.watch(lanes.block.arch, &samples);
    }
}

/// The row of a sample.
#[inline(always)]
fn row(values: &mut [Pack], width: usize, k: usize) -> &mut [Pack] {
    &mut values[k * width..(k + 1) * width]
}
