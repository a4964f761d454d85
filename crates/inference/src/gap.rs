//! The gap that is to be explained, and what is left of it.
//!
//! ```text
//! u² = Σ_c max(V_c − 1.1 N_c, 0) / s_c²  over  Σ_c max(G_c − 1.1 N_c, 0) / s_c²             (1)
//! ```
//!
//! V_c is the squared discrepancy of channel c, N_c noise, which is known to a tenth, G_c the gap (of the model as given at most the
//! variance s_c² of the channel). Where the model as given moves a channel by more than all that was measured there, and a
//! set explains nothing of it, what it leaves is no noise of a sensor that sees the machine: N_c = 0.

use crate::noise_model::NOISE_KNOWN;

/// The share of a gap, rms, below which what is left does not count.
pub const RELEVANT_SHARE: f64 = 0.05;

/// The gap that is to be explained, and its noise.
pub struct Gap {
    /// G_c of (1).
    pub square: Vec<f64>,
    /// N_c.
    pub noise: Vec<f64>,
    /// s_c.
    pub std: Vec<f64>,
}

impl Gap {
    /// The gap between the model as given, which leaves `given`, and a set that leaves `variance`, of which `noise` may be noise.
    #[must_use]
    pub fn of(given: &[f64], variance: &[f64], noise: &[f64], std: &[f64]) -> Gap {
        let channels = given.iter().zip(std);
        let square = channels.map(|(given, std)| given.min(std * std));
        let noise = noise.iter().enumerate().map(|(c, noise)| {
            let all = std[c] * std[c];
            // Noise and a motion that is not there add up.
            let is_moved = given[c] > 2.0 * all;
            let is_explained = NOISE_KNOWN * variance[c] < all;
            match is_moved && !is_explained {
                true => 0.0,
                false => *noise,
            }
        });
        Gap {
            square: square.collect(),
            noise: noise.collect(),
            std: std.to_vec(),
        }
    }

    /// u of (1) for what is left of each channel; zero where there is no gap.
    #[must_use]
    pub fn left(&self, variance: &[f64]) -> f64 {
        let left = (self.share(variance) / self.to_explain()).sqrt();
        if left.is_finite() { left } else { 0.0 }
    }

    /// The denominator of (1).
    #[must_use]
    pub fn to_explain(&self) -> f64 {
        self.share(&self.square)
    }

    fn share(&self, square: &[f64]) -> f64 {
        let channels = over_noise(square, &self.noise).zip(&self.std);
        channels.map(|(rms, std)| (rms / std).powi(2)).sum()
    }
}

/// What of the squared discrepancy of each channel is no noise, rms.
pub(crate) fn over_noise<'a>(
    square: &'a [f64],
    noise: &'a [f64],
) -> impl Iterator<Item = f64> + 'a {
    let channels = square.iter().zip(noise);
    channels.map(|(square, noise)| (square - NOISE_KNOWN * noise).max(0.0).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verify_shares_of_a_gap_are_over_noise() {
        let gap = Gap {
            square: vec![1.011, 0.01],
            noise: vec![0.01, 0.01],
            std: vec![2.0, 1.0],
        };
        assert!((gap.left(&[0.261, 0.01]) - 0.5).abs() < 1e-12);
        assert_eq!(gap.left(&[0.01, 0.005]), 0.0);
        let none = Gap {
            square: vec![0.01],
            noise: vec![0.01],
            std: vec![1.0],
        };
        assert_eq!(none.left(&[0.02]), 0.0);
    }

    #[test]
    fn verify_a_sensor_that_is_not_connected_leaves_all_of_the_gap() {
        let left = |given: f64| {
            let gap = Gap::of(&[given, 0.5], &[0.99, 0.01], &[0.99, 0.01], &[1.0, 1.0]);
            gap.left(&[0.99, 0.01])
        };
        // The model moves it by three times its noise, or by half of it.
        assert!((left(10.0) - (0.99_f64 / 1.489).sqrt()).abs() < 1e-12);
        assert_eq!(left(1.25), 0.0);
    }
}
