//! A case before its records are written.

use crate::bench::Bench;
use crate::effect::Effect;
use crate::plant::Plant;

/// What is known of a case while it is drawn.
pub(crate) struct Draft {
    pub(crate) nominal: Plant,
    pub(crate) bench: Bench,
    pub(crate) effects: Vec<Effect>,
    /// True factor of a parameter and the channel gap it causes, for wrong nominal parameters.
    pub(crate) wrong: Vec<Effect>,
    /// Small errors of the nominal parameters.
    pub(crate) deviations: Vec<Effect>,
    pub(crate) gap: f64,
    /// Largest gap of each channel over the records.
    pub(crate) gaps: Vec<f64>,
}
