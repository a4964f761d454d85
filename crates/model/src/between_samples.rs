//! What an input does between its samples.

use serde::{Deserialize, Serialize};

use crate::refuse::item;
use crate::{Input, InputKind, ModelError};

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
}

impl BetweenSamples {
    /// As the model file calls it.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            BetweenSamples::Smooth => "smooth",
            BetweenSamples::Linear => "linear",
            BetweenSamples::Held => "held",
        }
    }
}

impl Input {
    /// Whether it may jump, or bend: what moves a node may not.
    #[must_use]
    pub fn may_jump(&self) -> bool {
        self.kind != InputKind::Displacement
    }

    /// What it does between the samples, as stated or smooth.
    #[must_use]
    pub fn between_samples(&self) -> BetweenSamples {
        self.between_samples.unwrap_or(BetweenSamples::Smooth)
    }

    /// Refuses jumps of what may not jump.
    pub(crate) fn check_between_samples(&self) -> Result<(), ModelError> {
        let stated = self.between_samples();
        if self.may_jump() || stated == BetweenSamples::Smooth {
            return Ok(());
        }
        Err(ModelError::Shape {
            place: item("input", &self.channel),
            found: format!("between_samples = \"{}\"", stated.name()),
            needed: "\"smooth\" for a displacement: a node that jumps has no velocity".into(),
        })
    }
}
