//! Arithmetic on packs in vector instructions.
//!
//! Products and sums stay apart, so that they round as those of the march of one set.

use pulp::Simd;

use super::{LANES, Mask, Pack};

/// `op` lane by lane.
#[inline(always)]
fn zip<S: Simd>(a: &Pack, b: &Pack, op: impl Fn(S::f64s, S::f64s) -> S::f64s) -> Pack {
    let mut out = Pack::ZERO;
    let (a, b) = (S::as_simd_f64s(&a.0).0, S::as_simd_f64s(&b.0).0);
    let lanes = S::as_mut_simd_f64s(&mut out.0).0;
    for k in 0..LANES / S::F64_LANES {
        lanes[k] = op(a[k], b[k]);
    }
    out
}

/// a + b.
#[inline(always)]
pub(super) fn add<S: Simd>(simd: S, a: &Pack, b: &Pack) -> Pack {
    zip::<S>(a, b, |a, b| simd.add_f64s(a, b))
}

/// a − b.
#[inline(always)]
pub(super) fn sub<S: Simd>(simd: S, a: &Pack, b: &Pack) -> Pack {
    zip::<S>(a, b, |a, b| simd.sub_f64s(a, b))
}

/// a b.
#[inline(always)]
pub(super) fn mul<S: Simd>(simd: S, a: &Pack, b: &Pack) -> Pack {
    zip::<S>(a, b, |a, b| simd.mul_f64s(a, b))
}

/// sum + a b.
#[inline(always)]
pub(super) fn add_product<S: Simd>(simd: S, sum: &Pack, a: &Pack, b: &Pack) -> Pack {
    add(simd, sum, &mul(simd, a, b))
}

/// a + share (b − a).
#[inline(always)]
pub(super) fn between<S: Simd>(simd: S, a: &Pack, b: &Pack, share: f64) -> Pack {
    add_product(simd, a, &Pack([share; LANES]), &sub(simd, b, a))
}

/// The lanes of either.
#[inline(always)]
pub(super) fn either<S: Simd>(simd: S, a: &Mask, b: &Mask) -> Mask {
    let mut out = Mask([0; LANES]);
    let (a, b) = (S::as_simd_u64s(&a.0).0, S::as_simd_u64s(&b.0).0);
    let lanes = S::as_mut_simd_u64s(&mut out.0).0;
    for k in 0..LANES / S::U64_LANES {
        lanes[k] = simd.or_u64s(a[k], b[k]);
    }
    out
}
