//! How large the motion at a place is, and the values of an effect by size.

/// How large the motion is at a place without the effect.
#[derive(Debug, Clone, Copy)]
pub struct Scale {
    /// Root mean square of the signal: displacement across, reading or input.
    pub rms: f64,
    /// Lowest and highest value.
    pub range: (f64, f64),
    /// Root mean square of its rate.
    pub rate: f64,
    /// Typical force at the place.
    pub force: f64,
    /// Stiffness of the springs there, or of the plant.
    pub stiffness: f64,
    /// Mass there.
    pub mass: f64,
    /// s.
    pub duration_s: f64,
    /// s.
    pub step_s: f64,
    /// Hz.
    pub band_hz: (f64, f64),
}

/// Values by name.
pub type Values = Vec<(&'static str, f64)>;

/// Values for any size from about 0.01 (hardly there) to 1 (dominant).
pub type Template = Box<dyn Fn(f64) -> Values>;
