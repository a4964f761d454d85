//! What drives eight sets.

use std::ops::Range;

use pulp::Simd;

use super::set::LaneSet;
use super::wide::{Which, Wide};
use super::{LANES, Mask, Pack};
use crate::exact::march::Excitation;

/// An excitation and the lanes it drives.
pub(super) struct Source<'a> {
    excitation: Excitation<'a>,
    /// Samples it holds in full.
    count: usize,
    lanes: Mask,
}

/// The different excitations of eight sets.
pub(super) fn sources<'a>(sets: &[&LaneSet<'a>; LANES]) -> Vec<Source<'a>> {
    let same = |a: &[f64], b: &[f64]| std::ptr::eq(a, b);
    let mut sources: Vec<Source<'a>> = Vec::new();
    for (lane, set) in sets.iter().enumerate() {
        let (e, count) = (&set.excitation, set.sample_count());
        let known = sources.iter().position(|source| {
            source.count == count
                && same(source.excitation.dof_force, e.dof_force)
                && same(source.excitation.base_displacement, e.base_displacement)
                && same(source.excitation.base_velocity, e.base_velocity)
        });
        let index = known.unwrap_or_else(|| {
            sources.push(Source {
                excitation: *e,
                count,
                lanes: Mask::NONE,
            });
            sources.len() - 1
        });
        sources[index].lanes.0[lane] = u64::MAX;
    }
    sources
}

/// Takes a part of the excitations at samples in a row, a row of packs for each; where one is over, it stays at its last.
#[inline(always)]
pub(super) fn fill<'a, S: Simd>(
    simd: S,
    sources: &[Source<'a>],
    samples: Range<usize>,
    (out, width): (&mut [Pack], usize),
    values: impl Fn(&Excitation<'a>) -> &'a [f64],
) {
    if width == 0 {
        return;
    }
    for (k, source) in sources.iter().enumerate() {
        let values = values(&source.excitation);
        let lanes = Which::of(simd, &source.lanes);
        let last = source.count.saturating_sub(1);
        for (sample, out) in samples.clone().zip(out.chunks_exact_mut(width)) {
            let at = sample.min(last) * width;
            let row = values.get(at..at + width).unwrap_or(&[]);
            for (out, value) in out.iter_mut().zip(row) {
                let value = Wide::splat(simd, *value);
                *out = if k == 0 {
                    value.pack()
                } else {
                    lanes.choose(value, Wide::of(simd, out)).pack()
                };
            }
        }
    }
}
