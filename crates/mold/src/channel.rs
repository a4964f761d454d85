//! Names of the channels of the machine.

/// Channel of the pressure force, N.
pub const FORCE_CHANNEL: &str = "F_pressure";

/// Channel of the mold displacement, m.
pub const DISPLACEMENT_CHANNEL: &str = "y";
