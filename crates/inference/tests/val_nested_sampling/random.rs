//! Random numbers from a fixed seed, and the normal distribution.

use std::f64::consts::TAU;

/// Numbers from a seed (splitmix64).
pub(crate) struct Random(u64);

impl Random {
    pub(crate) fn new(seed: u64) -> Random {
        Random(seed)
    }

    /// Even over 0 to 1, neither end reached.
    pub(crate) fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64 + 0.5 / (1_u64 << 53) as f64
    }

    /// Normal, zero mean and unit variance (Box-Muller).
    pub(crate) fn normal(&mut self) -> f64 {
        let (a, b) = (self.uniform(), self.uniform());
        (-2.0 * a.ln()).sqrt() * (TAU * b).cos()
    }

    pub(crate) fn index(&mut self, len: usize) -> usize {
        ((self.uniform() * len as f64) as usize).min(len - 1)
    }

    /// A direction evenly drawn.
    pub(crate) fn direction(&mut self, dim: usize) -> Vec<f64> {
        let draw: Vec<f64> = (0..dim).map(|_| self.normal()).collect();
        let length = draw.iter().map(|x| x * x).sum::<f64>().sqrt();
        draw.iter().map(|x| x / length).collect()
    }
}

/// The value below which a normal variable of unit variance is with probability p.
///
/// Newton's method on the distribution function, from the logistic one of the same slope.
pub(crate) fn normal_quantile(p: f64) -> f64 {
    if p > 0.5 {
        return -normal_quantile(1.0 - p);
    }
    let mut z = (p / (1.0 - p)).ln() / 1.702;
    for _ in 0..60 {
        // In the logarithm of p, which is concave: no step from the left goes too far.
        let below = normal_cdf(z);
        let density = (-0.5 * z * z).exp() / TAU.sqrt();
        let step = (below / p).ln() * below / density;
        z -= step;
        if step.abs() < 1e-12 * z.abs().max(1.0) {
            break;
        }
    }
    z
}

/// Lower tail of the normal distribution at z ≤ 0: a series near zero, a continued fraction far out.
pub(crate) fn normal_cdf(z: f64) -> f64 {
    let density = (-0.5 * z * z).exp() / TAU.sqrt();
    if z > -3.0 {
        // Φ(z) = ½ + φ(z) (z + z³/3 + z⁵/15 + …)
        let (mut term, mut sum) = (z, z);
        for k in 1..80 {
            term *= z * z / f64::from(2 * k + 1);
            sum += term;
        }
        return 0.5 + density * sum;
    }
    // Φ(z) = φ(z) / (x + 1/(x + 2/(x + 3/(x + …)))), x = −z
    let x = -z;
    let tail = (1..60).rev().fold(x, |tail, k| x + f64::from(k) / tail);
    density / tail
}

#[test]
fn verify_the_normal_quantile_against_known_points() {
    let known = [
        (0.5, 0.0),
        (0.975, 1.959_963_984_540_054),
        (0.001, -3.090_232_306_167_813),
        (1e-9, -5.997_807_015_007_687),
    ];
    for (p, z) in known {
        assert!(
            (normal_quantile(p) - z).abs() < 1e-9,
            "{p}: {}",
            normal_quantile(p)
        );
    }
}
