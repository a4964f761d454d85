//! How hard the cases of a campaign are.

use serde::{Deserialize, Serialize};

/// How much noise, how wrong the nominal parameters, how small the gap.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Level {
    /// Noise 34 to 46 dB below the signal, parameters off by up to 2 %, gaps of 10 to 50 %.
    Standard,
    /// Noise 26 to 34 dB below the signal, parameters off by up to 5 %, gaps of 6 to 20 %.
    Hard,
}

impl Level {
    /// Standard deviation of the noise over that of its channel, lowest and highest draw.
    ///
    /// ```
    /// let [low, high] = simgap_blind::Level::Standard.noise_share();
    /// assert!((20.0 * low.log10() + 46.0).abs() < 1e-9 && (20.0 * high.log10() + 34.0).abs() < 1e-9);
    /// ```
    #[must_use]
    pub fn noise_share(self) -> [f64; 2] {
        let below_db = match self {
            Level::Standard => [46.0, 34.0],
            Level::Hard => [34.0, 26.0],
        };
        below_db.map(|db: f64| 10_f64.powf(-db / 20.0))
    }

    /// Largest relative error of every nominal parameter.
    #[must_use]
    pub fn tolerance(self) -> f64 {
        match self {
            Level::Standard => 0.02,
            Level::Hard => 0.05,
        }
    }

    /// Gap of every hidden effect on the channel that shows it most, rms over the channel's standard
    /// deviation: smallest and largest.
    #[must_use]
    pub fn gap(self) -> [f64; 2] {
        match self {
            Level::Standard => [0.10, 0.50],
            Level::Hard => [0.06, 0.20],
        }
    }

    /// How far off a nominal parameter is that is the cause, either way: well beyond the tolerance.
    #[must_use]
    pub fn wrong(self) -> [f64; 2] {
        match self {
            Level::Standard => [0.08, 0.30],
            Level::Hard => [0.12, 0.30],
        }
    }
}
