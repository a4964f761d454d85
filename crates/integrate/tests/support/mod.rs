//! Shared by the integration tests: observed order, seeded noise.
#![allow(dead_code, unreachable_pub)]

/// Observed order from the errors at a step and at half of it.
pub fn observed_order(coarse_error: f64, fine_error: f64) -> f64 {
    (coarse_error / fine_error).log2()
}

/// Largest modulus of the difference of two series.
pub fn largest_difference(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter()
        .zip(b)
        .fold(0.0, |top, (x, y)| f64::max(top, (x - y).abs()))
}

/// Normal deviates from a fixed seed: splitmix64 and Box-Muller.
pub struct Normal(pub u64);

impl Normal {
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    pub fn draw(&mut self) -> f64 {
        let radius = (-2.0 * (1.0 - self.uniform()).ln()).sqrt();
        radius * (std::f64::consts::TAU * self.uniform()).cos()
    }
}
