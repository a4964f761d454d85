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

/// A one degree of freedom structure of unit mass: ẍ + 2ζω ẋ + ω² x.
pub fn oscillator(natural_freq_rad: f64, damping_ratio: f64) -> simgap_model::StructuralMatrices {
    simgap_model::StructuralMatrices {
        mass_matrix: faer::mat![[1.0]],
        damping_matrix: faer::mat![[2.0 * damping_ratio * natural_freq_rad]],
        stiffness_matrix: faer::mat![[natural_freq_rad * natural_freq_rad]],
    }
}

/// Closed form of free decay: x and ẋ at t for any damping ratio, and any initial state.
pub fn free_decay(omega: f64, zeta: f64, x0: f64, v0: f64, t: f64) -> (f64, f64) {
    let decay = (-zeta * omega * t).exp();
    let slope = v0 + zeta * omega * x0;
    // x = e^(−ζωt) (x0 c + slope s), with c' = ± r² s and s' = c.
    let (c, s, square) = if zeta < 1.0 {
        let r = omega * (1.0 - zeta * zeta).sqrt();
        ((r * t).cos(), (r * t).sin() / r, -r * r)
    } else if zeta == 1.0 {
        (1.0, t, 0.0)
    } else {
        let r = omega * (zeta * zeta - 1.0).sqrt();
        ((r * t).cosh(), (r * t).sinh() / r, r * r)
    };
    let x = decay * (x0 * c + slope * s);
    let v = decay * (x0 * square * s + slope * c) - zeta * omega * x;
    (x, v)
}
