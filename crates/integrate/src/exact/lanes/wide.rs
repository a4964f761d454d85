//! Arithmetic on packs in vector instructions, written with the usual signs.
//!
//! [`Pack`] and [`Mask`] are how numbers and lanes are stored, [`Wide`] and [`Which`] how they are
//! computed with: they carry the token of the instructions. Products and sums stay apart, so that they round as those of the march of one set.

use std::ops::{Add, AddAssign, BitAnd, BitOr, Div, Mul, Not, Sub, SubAssign};

use pulp::Simd;

use super::{LANES, Mask, Pack};

/// A pack in vector registers.
#[derive(Clone, Copy)]
pub(super) struct Wide<S: Simd> {
    simd: S,
    pack: Pack,
}

impl<S: Simd> Wide<S> {
    #[inline(always)]
    pub(super) fn of(simd: S, pack: &Pack) -> Self {
        Wide { simd, pack: *pack }
    }

    #[inline(always)]
    pub(super) fn splat(simd: S, value: f64) -> Self {
        let mut out = Pack::ZERO;
        S::as_mut_simd_f64s(&mut out.0)
            .0
            .fill(simd.splat_f64s(value));
        Wide::of(simd, &out)
    }

    #[inline(always)]
    pub(super) fn zero(simd: S) -> Self {
        Wide::of(simd, &Pack::ZERO)
    }

    #[inline(always)]
    pub(super) fn pack(self) -> Pack {
        self.pack
    }

    #[inline(always)]
    pub(super) fn abs(self) -> Self {
        Wide::of(self.simd, &Pack(self.pack.0.map(f64::abs)))
    }

    /// `op` register by register.
    #[inline(always)]
    fn zip(self, other: Self, op: impl Fn(S::f64s, S::f64s) -> S::f64s) -> Self {
        let mut out = Pack::ZERO;
        let a = S::as_simd_f64s(&self.pack.0).0;
        let b = S::as_simd_f64s(&other.pack.0).0;
        let lanes = S::as_mut_simd_f64s(&mut out.0).0;
        for k in 0..LANES / S::F64_LANES {
            lanes[k] = op(a[k], b[k]);
        }
        Wide::of(self.simd, &out)
    }

    /// The lanes where `op` holds.
    #[inline(always)]
    fn compare(self, other: Self, op: impl Fn(S::f64s, S::f64s) -> S::m64s) -> Which<S> {
        let mut mask = Mask([0; LANES]);
        let a = S::as_simd_f64s(&self.pack.0).0;
        let b = S::as_simd_f64s(&other.pack.0).0;
        let lanes = S::as_mut_simd_u64s(&mut mask.0).0;
        let (yes, no) = (self.simd.splat_u64s(u64::MAX), self.simd.splat_u64s(0));
        for k in 0..LANES / S::F64_LANES {
            lanes[k] = self.simd.select_u64s(op(a[k], b[k]), yes, no);
        }
        Which::of(self.simd, &mask)
    }

    /// Where it is at most `other`; nowhere where one is not a number.
    #[inline(always)]
    pub(super) fn is_at_most(self, other: Self) -> Which<S> {
        self.compare(other, |a, b| self.simd.less_than_or_equal_f64s(a, b))
    }

    #[inline(always)]
    pub(super) fn equals(self, other: Self) -> Which<S> {
        self.compare(other, |a, b| self.simd.equal_f64s(a, b))
    }
}

macro_rules! operator {
    ($trait:ident, $method:ident, $op:ident $(, $assign:ident, $assign_method:ident)?) => {
        impl<S: Simd> $trait for Wide<S> {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                self.zip(other, |a, b| self.simd.$op(a, b))
            }
        }

        $(impl<S: Simd> $assign for Wide<S> {
            #[inline(always)]
            fn $assign_method(&mut self, other: Self) {
                *self = $trait::$method(*self, other);
            }
        })?
    };
}

operator!(Add, add, add_f64s, AddAssign, add_assign);
operator!(Sub, sub, sub_f64s, SubAssign, sub_assign);
operator!(Mul, mul, mul_f64s);
operator!(Div, div, div_f64s);

/// Lanes of a pack.
#[derive(Clone, Copy)]
pub(super) struct Which<S: Simd> {
    simd: S,
    mask: Mask,
}

impl<S: Simd> Which<S> {
    #[inline(always)]
    pub(super) fn of(simd: S, mask: &Mask) -> Self {
        Which { simd, mask: *mask }
    }

    #[inline(always)]
    pub(super) fn simd(&self) -> S {
        self.simd
    }

    #[inline(always)]
    pub(super) fn mask(self) -> Mask {
        self.mask
    }

    #[inline(always)]
    pub(super) fn any(&self) -> bool {
        self.mask.any()
    }

    /// `yes` in these lanes, `no` in the others.
    #[inline(always)]
    pub(super) fn choose(self, yes: Wide<S>, no: Wide<S>) -> Wide<S> {
        let simd = self.simd;
        let mut out = Pack::ZERO;
        let masks = S::as_simd_u64s(&self.mask.0).0;
        let a = S::as_simd_f64s(&yes.pack.0).0;
        let b = S::as_simd_f64s(&no.pack.0).0;
        let lanes = S::as_mut_simd_f64s(&mut out.0).0;
        let never = simd.splat_u64s(0);
        for k in 0..LANES / S::F64_LANES {
            let is_no = simd.equal_u64s(masks[k], never);
            lanes[k] = simd.select_f64s(is_no, b[k], a[k]);
        }
        Wide::of(simd, &out)
    }

    /// Puts the value in place in these lanes.
    #[inline(always)]
    pub(super) fn put(self, value: Wide<S>, place: &mut Pack) {
        // What is stored under a mask cannot be loaded before it has reached the cache.
        *place = if self.mask.all() {
            value.pack()
        } else {
            self.choose(value, Wide::of(self.simd, place)).pack()
        };
    }

    #[inline(always)]
    fn zip(self, other: Self, op: impl Fn(S::u64s, S::u64s) -> S::u64s) -> Self {
        let mut out = Mask([0; LANES]);
        let a = S::as_simd_u64s(&self.mask.0).0;
        let b = S::as_simd_u64s(&other.mask.0).0;
        let lanes = S::as_mut_simd_u64s(&mut out.0).0;
        for k in 0..LANES / S::F64_LANES {
            lanes[k] = op(a[k], b[k]);
        }
        Which::of(self.simd, &out)
    }
}

impl<S: Simd> BitAnd for Which<S> {
    type Output = Self;

    #[inline(always)]
    fn bitand(self, other: Self) -> Self {
        self.zip(other, |a, b| self.simd.and_u64s(a, b))
    }
}

impl<S: Simd> BitOr for Which<S> {
    type Output = Self;

    #[inline(always)]
    fn bitor(self, other: Self) -> Self {
        self.zip(other, |a, b| self.simd.or_u64s(a, b))
    }
}

impl<S: Simd> Not for Which<S> {
    type Output = Self;

    #[inline(always)]
    fn not(self) -> Self {
        Which::of(self.simd, &Mask(self.mask.0.map(u64::not)))
    }
}
