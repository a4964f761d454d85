//! What an input does between its samples.

use serde::{Deserialize, Serialize};

/// What an input does between its samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum BetweenSamples {
    /// It follows a smooth curve through the samples, as what was measured does.
    Smooth,
    /// It goes in straight lines from sample to sample (first-order hold).
    Linear,
    /// It keeps the value of a sample until the next one, as what a converter puts out does (zero-order hold).
    Held,
    /// It follows a smooth curve, but where a value stands and changes at once: there it is kept until the next sample.
    Stepped,
}

impl BetweenSamples {
    /// As the model file calls it.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            BetweenSamples::Smooth => "smooth",
            BetweenSamples::Linear => "linear",
            BetweenSamples::Held => "held",
            BetweenSamples::Stepped => "stepped",
        }
    }
}
