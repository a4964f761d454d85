//! The gap that is to be explained, and what is left of it.
//!
//! ```text
//! u² = Σ_c max(V_c − 1.1 N_c, 0) / s_c²  over  Σ_c max(G_c − 1.1 N_c, 0) / s_c²             (1)
//! ```
//!
//! V_c is the squared discrepancy of channel c, N_c noise, which is known to a tenth, G_c the gap (of the model as given at most the
//! variance s_c² of the channel).

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
    /// u of (1) for what is left of each channel; zero where there is no gap.
    #[must_use]
    pub fn left(&self, variance: &[f64]) -> f64 {
        let over_noise = |square: &[f64]| -> f64 {
            let channels = square.iter().zip(&self.noise).zip(&self.std);
            channels
                .map(|((square, noise), std)| (square - NOISE_KNOWN * noise).max(0.0) / (std * std))
                .sum()
        };
        let all = over_noise(&self.square);
        let left = (over_noise(variance) / all).sqrt();
        if left.is_finite() { left } else { 0.0 }
    }
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
}
