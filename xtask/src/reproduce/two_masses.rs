//! The model of two masses for the rows of Table 5, and its motion.

use simgap_mold::TwoDof;

use super::context::FAST_RATE_HZ;
use super::simulated::{TwoMassMotion, two_mass_motion};
use super::{Context, ReproduceError};

/// Rate of the simulations, Hz.
pub(crate) const RATE_HZ: f64 = FAST_RATE_HZ;

/// Samples of a simulation: 20 s.
const COUNT: usize = 20 * RATE_HZ as usize;

/// Printed and restored model for one excitation.
pub(crate) fn models(context: &Context, freq_hz: f64) -> Result<[TwoDof; 2], ReproduceError> {
    let printed = TwoDof::published(freq_hz)?;
    let base = context.stated.image_base.si();
    Ok([printed, printed.restored(base - freq_hz, base + freq_hz)?])
}

/// From rest, driven by the sine force that moves m₁ by the paper's amplitude in steady state.
pub(crate) fn motion_of(
    context: &Context,
    model: &TwoDof,
    freq_hz: f64,
) -> Result<TwoMassMotion, ReproduceError> {
    two_mass_motion(model, context.amplitude(), freq_hz, RATE_HZ, COUNT)
}
