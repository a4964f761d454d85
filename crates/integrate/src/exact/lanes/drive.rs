//! What drives eight sets, some samples at a time.

use std::ops::Range;

use pulp::Simd;

use super::Pack;
use super::eight::Eight;
use super::observer::{Rows, SHOWN};
use super::row::Row;
use super::source::fill;

/// What drives eight sets at some samples in a row, with the sample before them.
pub(super) struct Drive<R> {
    force: Vec<Pack>,
    /// Displacements and velocities of the bases.
    base: [Vec<Pack>; 2],
    bases: usize,
    zero: R,
}

impl<R: Row> Drive<R> {
    pub(super) fn new(lanes: &Eight<'_>, zero: &R) -> Drive<R> {
        let bases = lanes.sets[0].excitation.base_count;
        let room = |width: usize| vec![Pack::ZERO; (SHOWN + 1) * width];
        Drive {
            force: room(zero.packs().len()),
            base: [room(bases), room(bases)],
            bases,
            zero: zero.clone(),
        }
    }

    /// Takes the excitation at samples that follow those it has; a set that is over stays at its last.
    #[inline(always)]
    pub(super) fn load<S: Simd>(&mut self, simd: S, lanes: &Eight<'_>, samples: Range<usize>) {
        let (n, bases) = (self.zero.packs().len(), self.bases);
        let sources = &lanes.sources;
        // The last row is the sample before.
        let next = |values: &'_ mut Vec<Pack>, width: usize| {
            let last = values.len() - width;
            values.copy_within(last.., 0);
        };
        next(&mut self.force, n);
        let force = (&mut self.force[n..], n);
        fill(simd, sources, samples.clone(), force, |e| e.dof_force);
        let [x, v] = &mut self.base;
        next(x, bases);
        next(v, bases);
        let (x, v) = ((&mut x[bases..], bases), (&mut v[bases..], bases));
        fill(simd, sources, samples.clone(), x, |e| e.base_displacement);
        fill(simd, sources, samples, v, |e| e.base_velocity);
    }

    /// Forces at the two ends of the interval before the k-th sample.
    #[inline(always)]
    pub(super) fn forces(&self, k: usize) -> [&[Pack]; 2] {
        let n = self.zero.packs().len();
        let (before, after) = self.force[k * n..(k + 2) * n].split_at(n);
        [before, after]
    }

    /// The bases at the sample before the k-th.
    #[inline(always)]
    pub(super) fn base(&self, k: usize) -> [&[Pack]; 2] {
        let [x, v] = &self.base;
        [
            Rows::new(x, self.bases).at(k),
            Rows::new(v, self.bases).at(k),
        ]
    }

    /// Those at the samples, from the first on, row by row.
    pub(super) fn bases(&self) -> [Rows<'_>; 2] {
        let [x, v] = &self.base;
        let width = self.bases;
        [Rows::new(&x[width..], width), Rows::new(&v[width..], width)]
    }
}
