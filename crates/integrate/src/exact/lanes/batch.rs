//! Any number of sets of one structure.

use pulp::Arch;

use super::eight::Eight;
use super::march::March;
use super::observer::{LaneObserver, Watch};
use super::set::LaneSet;
use super::{LANES, Pack};

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
            let lanes = Eight::new(arch, sets, block, &is_read);
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
