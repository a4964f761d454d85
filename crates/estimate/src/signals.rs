//! The signals of a run.

/// Signals of one run: one vector for each channel.
pub(crate) type Signals = Vec<Vec<f64>>;
