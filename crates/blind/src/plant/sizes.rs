//! The sizes a plant is made for.

/// Sizes from which a plant is finished.
pub(super) struct Sizes {
    /// Frequency the plant is about, Hz.
    pub(super) freq_hz: f64,
    pub(super) displacement_m: f64,
    pub(super) amplitude: f64,
}
