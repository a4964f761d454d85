//! What drives eight sets.

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

/// Takes a part of the excitations at a sample, one value for each pack.
#[inline(always)]
pub(super) fn fill<'a, S: Simd>(
    simd: S,
    sources: &[Source<'a>],
    sample: usize,
    out: &mut [Pack],
    values: impl Fn(&Excitation<'a>) -> &'a [f64],
) {
    for (k, source) in sources.iter().enumerate() {
        let row = values_at(values(&source.excitation), sample, source.count, out.len());
        let lanes = Which::of(simd, &source.lanes);
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

/// The values at a sample, or at the last where that is over.
#[inline(always)]
fn values_at(values: &[f64], sample: usize, count: usize, width: usize) -> &[f64] {
    let at = sample.min(count.saturating_sub(1)) * width;
    values.get(at..at + width).unwrap_or(&[])
}
