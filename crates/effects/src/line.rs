//! What some effects do whatever moves.

/// What an effect adds to a signal, or pushes with, whatever moves: A sin(2π f t + φ), at f = 0 only A.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Line {
    /// f, Hz.
    pub frequency_hz: f64,
    /// A, in the unit of the signal, or N.
    pub amplitude: f64,
    /// φ, rad; 0 where f = 0.
    pub phase_rad: f64,
}

impl Line {
    /// What does not swing.
    #[must_use]
    pub const fn constant(amplitude: f64) -> Line {
        Line {
            frequency_hz: 0.0,
            amplitude,
            phase_rad: 0.0,
        }
    }
}
