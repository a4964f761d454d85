//! Agreement of a measured and a predicted curve.
//!
//! | Metric | Perfect | Says | Function |
//! |---|---|---|---|
//! | NRMSE | 0 | size of the discrepancy against the spread of the measurement | [`nrmse`] |
//! | Sprague-Geers | 0, 0, 0 | magnitude, phase, both | [`sprague_geers`] |
//! | Russell | 0, 0, 0 | the same, symmetric in over- and underprediction | [`russell`] |
//! | FRAC | 1 | shape of two complex frequency responses | [`frac`] |
//! | ISO/TS 18571 | 1 | corridor, phase, magnitude and slope scores | [`iso18571()`] |

mod dtw;
mod frac;
mod iso18571;
mod nrmse;
mod russell;
mod sprague_geers;

pub use frac::frac;
pub use iso18571::{Grade, Iso18571, iso18571};
pub use nrmse::{nrmse, nrmse_over_channels};
pub use russell::{Russell, russell};
pub use sprague_geers::{SpragueGeers, sprague_geers};
