//! What a pole says of the motion: whether it vibrates, dies away, or is a level that nothing fixes.

use faer::c64;

/// What a pole says of the motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum PoleKind {
    /// One of a complex pair: a vibration.
    Oscillatory,
    /// Real: a motion that dies away, or grows, without vibrating.
    Real,
    /// Real and next to zero beside the vibrations: an integral, such as a position that no spring holds or the level of
    /// two pressures that no flow corrects.
    Neutral,
}

/// A real pole below this share of the slowest vibration is neutral: in the time in which it changes by a factor e, that
/// goes through more than 1600 periods.
const NEUTRAL: f64 = 1e-4;

/// Of each pole of a plant, rad/s, what it is,
///
/// ```text
/// oscillatory   Im λ ≠ 0
/// neutral       Im λ = 0 and |λ| < 1e-4 min |λ_osc|; λ = 0 where nothing vibrates
/// ```
///
/// ```
/// use faer::c64;
/// use simgap_model::{PoleKind, pole_kinds};
/// let poles = [c64::new(3e-3, 0.0), c64::new(-24.0, 0.0), c64::new(-9.0, 188.0)];
/// assert_eq!(pole_kinds(&poles), [PoleKind::Neutral, PoleKind::Real, PoleKind::Oscillatory]);
/// ```
#[must_use]
pub fn pole_kinds(poles: &[c64]) -> Vec<PoleKind> {
    let pairs = poles.iter().filter(|pole| pole.im != 0.0);
    let slowest = pairs.map(|pole| pole.norm()).fold(f64::INFINITY, f64::min);
    let limit = if slowest.is_finite() {
        NEUTRAL * slowest
    } else {
        0.0
    };
    let kind = |pole: &c64| {
        if pole.im != 0.0 {
            PoleKind::Oscillatory
        } else if pole.norm() == 0.0 || pole.norm() < limit {
            PoleKind::Neutral
        } else {
            PoleKind::Real
        }
    };
    poles.iter().map(kind).collect()
}
