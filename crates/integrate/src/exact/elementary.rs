//! Elementary functions for force laws: without branches and tables, so that eight lanes of them
//! become vector instructions, and of the same bits on every machine.
//!
//! Polynomials and reductions are those of fdlibm, \[Fdlibm\], without its special cases.

use std::f64::consts::{FRAC_2_PI, LOG2_E};

/// 1.5 · 2⁵²: a number below 2⁵¹ added to it is rounded to the nearest integer, which stands in the
/// last bits of the sum.
const ROUND: f64 = 6_755_399_441_055_744.0;

/// π/2 in parts of 33 bits, the last of 53.
const HALF_PI: [f64; 3] = [
    1.570_796_326_734_125_6,
    6.077_100_506_303_966e-11,
    2.022_266_248_795_950_6e-21,
];

/// sin r = r + r³ (s₁ + s₂ r² + …) for |r| ≤ π/4, off by at most 2⁻⁵⁸.
const SIN: [f64; 6] = [
    -1.666_666_666_666_663_2e-1,
    8.333_333_333_322_49e-3,
    -1.984_126_982_985_795e-4,
    2.755_731_370_707_006_8e-6,
    -2.505_076_025_340_686_3e-8,
    1.589_690_995_211_55e-10,
];

/// cos r = 1 − r²/2 + r⁴ (c₁ + c₂ r² + …) for |r| ≤ π/4, off by at most 2⁻⁵⁸.
const COS: [f64; 6] = [
    4.166_666_666_666_66e-2,
    -1.388_888_888_887_411e-3,
    2.480_158_728_947_673e-5,
    -2.755_731_435_139_066_3e-7,
    2.087_572_321_298_175e-9,
    -1.135_964_755_778_819_5e-11,
];

#[inline(always)]
fn polynomial<const N: usize>(coefficients: &[f64; N], z: f64) -> f64 {
    let mut sum = 0.0;
    for k in 0..N {
        sum = sum * z + coefficients[N - 1 - k];
    }
    sum
}

/// Sine and cosine of an angle (rad).
///
/// ```text
/// x = k π/2 + r,  |r| ≤ π/4;   (sin x, cos x) from (sin r, cos r) by the quadrant k mod 4
/// ```
///
/// Off by at most 2⁻⁵² for |x| up to 10⁶; beyond, by what rounding x itself brings. Not a number for
/// an angle that is not finite.
#[must_use]
#[inline(always)]
pub fn sin_cos(angle: f64) -> (f64, f64) {
    let shifted = angle * FRAC_2_PI + ROUND;
    let k = shifted - ROUND;
    let quadrant = shifted.to_bits();
    let r = ((angle - k * HALF_PI[0]) - k * HALF_PI[1]) - k * HALF_PI[2];
    let z = r * r;
    let sin = r + r * z * polynomial(&SIN, z);
    let cos = 1.0 - (0.5 * z - z * z * polynomial(&COS, z));
    let (a, b) = if quadrant & 1 == 0 {
        (sin, cos)
    } else {
        (cos, sin)
    };
    let signed = |value: f64, turned: u64| f64::from_bits(value.to_bits() ^ ((turned & 2) << 62));
    (signed(a, quadrant), signed(b, quadrant.wrapping_add(1)))
}

/// Sine of an angle (rad); see [`sin_cos`].
#[must_use]
#[inline(always)]
pub fn sin(angle: f64) -> f64 {
    sin_cos(angle).0
}

/// ln 2 in two parts, the first of 33 bits.
const LN_2: [f64; 2] = [0.693_147_180_369_123_8, 1.908_214_929_270_587_7e-10];

/// r coth(r/2) = 2 + r² (p₁ + p₂ r² + …) for |r| ≤ ln 2 / 2, off by at most 2⁻⁵⁹.
const EXP: [f64; 5] = [
    1.666_666_666_666_660_2e-1,
    -2.777_777_777_701_559_3e-3,
    6.613_756_321_437_934e-5,
    -1.653_390_220_546_525_2e-6,
    4.138_136_797_057_238_5e-8,
];

/// eˣ.
///
/// ```text
/// x = k ln 2 + r,  |r| ≤ ln 2 / 2;   eˣ = 2ᵏ eʳ
/// c = r − r² (p₁ + p₂ r² + …),  eʳ = 1 + r + r c / (2 − c)
/// ```
///
/// Off by less than two units in the last place.
#[must_use]
#[inline(always)]
pub fn exp(x: f64) -> f64 {
    // Beyond these it is 0 or infinite.
    let bounded = x.clamp(-746.0, 710.0);
    let k = (bounded * LOG2_E + ROUND) - ROUND;
    let (high, low) = (bounded - k * LN_2[0], k * LN_2[1]);
    let r = high - low;
    let z = r * r;
    let c = r - z * polynomial(&EXP, z);
    let power = 1.0 - ((low - r * c / (2.0 - c)) - high);
    // In two halves: 2ᵏ itself may be out of range where the product is not.
    let half = (0.5 * k + ROUND) - ROUND;
    let two_to = |k: f64| f64::from_bits((k + 1023.0 + ROUND).to_bits() << 52);
    power * two_to(half) * two_to(k - half)
}

/// eˣ − 1 for x up to 709, close to zero as well.
///
/// ```text
/// x = k ln 2 + r,  |r| ≤ ln 2 / 2;   eˣ − 1 = 2ᵏ (eʳ − 1) + (2ᵏ − 1)
/// ```
///
/// Off by less than three units in the last place.
#[inline(always)]
fn exp_m1(x: f64) -> f64 {
    // Below −40 it is −1.
    let bounded = x.clamp(-40.0, 709.0);
    let k = (bounded * LOG2_E + ROUND) - ROUND;
    let (high, low) = (bounded - k * LN_2[0], k * LN_2[1]);
    let r = high - low;
    let z = r * r;
    let c = r - z * polynomial(&EXP, z);
    let less_one = high - (low - r * c / (2.0 - c));
    let two_to = |k: f64| f64::from_bits((k + 1023.0 + ROUND).to_bits() << 52);
    two_to(k) * less_one + (two_to(k) - 1.0)
}

/// Hyperbolic tangent.
///
/// ```text
/// tanh x = (e^2x − 1) / (e^2x + 1)
/// ```
///
/// Off by less than five units in the last place.
#[must_use]
#[inline(always)]
pub fn tanh(x: f64) -> f64 {
    // Beyond these it is −1 or 1.
    let less_one = exp_m1(2.0 * x.clamp(-20.0, 20.0));
    less_one / (less_one + 2.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rounding of the reduced angle and of the result.
    const ROUNDING: f64 = f64::EPSILON;

    #[test]
    fn verify_sine_and_cosine_against_the_standard_library() {
        for k in -200_000..200_000 {
            for x in [
                f64::from(k) * 1.7e-4,
                f64::from(k) * 4.9,
                f64::from(k) * 1e-9,
            ] {
                let (sin, cos) = sin_cos(x);
                assert!((sin - x.sin()).abs() <= ROUNDING, "sin {x}");
                assert!((cos - x.cos()).abs() <= ROUNDING, "cos {x}");
            }
        }
        assert_eq!(sin_cos(0.0), (0.0, 1.0));
        assert!(sin(f64::INFINITY).is_nan() && sin(f64::NAN).is_nan());
        // Where an angle itself is only known to 1e-4 rad.
        let far: f64 = 1e12;
        assert!((sin(far) - far.sin()).abs() < 1e-4);
    }

    #[test]
    fn verify_what_is_made_of_the_exponential_against_the_standard_library() {
        for k in -200_000..=200_000 {
            for x in [
                f64::from(k) * 1.1e-4,
                f64::from(k) * 3.5e-3,
                f64::from(k) * 1e-12,
            ] {
                let close = |ours: f64, theirs: f64, ulps: f64| {
                    ours == theirs || (ours - theirs).abs() <= ulps * f64::EPSILON * theirs.abs()
                };
                assert!(close(exp_m1(x), x.exp_m1(), 3.0), "exp_m1 {x}");
                assert!(close(tanh(x), x.tanh(), 5.0), "tanh {x}");
            }
        }
        assert_eq!((exp_m1(0.0), tanh(0.0)), (0.0, 0.0));
        assert_eq!((tanh(1e9), tanh(f64::NEG_INFINITY)), (1.0, -1.0));
        assert!(tanh(f64::NAN).is_nan() && exp_m1(f64::NAN).is_nan());
    }

    #[test]
    fn verify_the_exponential_against_the_standard_library() {
        for k in -74_000..=70_900 {
            let x = f64::from(k) * 0.01;
            let (ours, theirs) = (exp(x), x.exp());
            let off = (ours - theirs).abs();
            // Two units in the last place, or of the smallest number.
            assert!(
                off <= theirs * 2.0 * f64::EPSILON + 1e-323,
                "exp {x}: {ours:e} {theirs:e}"
            );
        }
        assert_eq!(exp(0.0), 1.0);
        assert_eq!((exp(-1e9), exp(1e9)), (0.0, f64::INFINITY));
        assert_eq!(
            (exp(f64::NEG_INFINITY), exp(f64::INFINITY)),
            (0.0, f64::INFINITY)
        );
        assert!(exp(f64::NAN).is_nan());
    }
}
