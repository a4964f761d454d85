//! The plants of the generated cases.

mod one;
mod parts;
mod servo;
mod several;
mod sizes;

use simgap_model::{InputKind, Model, OutputKind, damped_modes_of};
use simgap_record::Quantity;

use crate::BlindError;
use crate::random::Random;
use sizes::Sizes;

/// A plant and the sizes it is driven at.
#[derive(Debug, Clone)]
pub(crate) struct Plant {
    pub(crate) model: Model,
    /// Excited band, Hz.
    pub(crate) band_hz: [f64; 2],
    /// Peak of the excitation, unit of the input.
    pub(crate) amplitude: f64,
    /// Typical displacement, m or rad.
    pub(crate) displacement_m: f64,
    pub(crate) sample_rate_hz: f64,
}

/// Samples per period of the highest frequency, lowest and highest draw. At 40 the first-order hold
/// of the inputs errs by (2π/40)²/12 = 0.2 %, as on a decently sampled machine.
const OVERSAMPLED: [f64; 2] = [40.0, 110.0];

/// Draws a plant.
pub(crate) fn draw(random: &mut Random) -> Result<Plant, BlindError> {
    let (model, sizes) = match random.below(18) {
        0 => one::mold(random),
        1 => several::mold_on_support(random)?,
        2..=4 => one::rig(random),
        5 | 6 => one::axis(random),
        7..=9 => several::chain(random, 2),
        10 | 11 => several::chain(random, 3),
        12 => several::chain(random, 4),
        13 => one::shaken(random),
        14 => several::free(random),
        15 => one::pendulum(random),
        _ => one::damper(random),
    };
    finish(random, model, &sizes)
}

/// Draws a plant with a hydraulic drive, for what only such a plant has.
pub(crate) fn draw_hydraulic(random: &mut Random) -> Result<Plant, BlindError> {
    let (model, sizes) = servo::axis(random)?;
    finish(random, model, &sizes)
}

fn finish(random: &mut Random, model: Model, sizes: &Sizes) -> Result<Plant, BlindError> {
    let f = sizes.freq_hz;
    let band_hz = [
        f * random.log_uniform(0.15, 0.4),
        f * random.log_uniform(1.3, 2.5),
    ];
    let modes = damped_modes_of(&model.matrices()?, &model.first_order())?;
    let highest = modes
        .iter()
        .map(|mode| mode.damped_freq_hz)
        .fold(band_hz[1], f64::max);
    Ok(Plant {
        model,
        band_hz,
        amplitude: sizes.amplitude,
        displacement_m: sizes.displacement_m,
        sample_rate_hz: highest * random.log_uniform(OVERSAMPLED[0], OVERSAMPLED[1]),
    })
}

/// Unit of an output of the plant.
pub(crate) fn output_unit(model: &Model, kind: OutputKind) -> &'static str {
    unit_of(model, kind.unit())
}

/// Unit of an input of the plant.
pub(crate) fn input_unit(model: &Model, kind: InputKind) -> &'static str {
    unit_of(model, kind.unit())
}

/// The unit of rotation in the place of that of translation where the plant rotates.
fn unit_of(model: &Model, symbol: &'static str) -> &'static str {
    if model.pendulums.is_empty() {
        symbol
    } else {
        Quantity::of_si_symbol(symbol).rotational_symbol()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn prop_every_plant_is_a_model() -> Result<(), BlindError> {
        let mut names = std::collections::BTreeSet::new();
        let mut measured = std::collections::BTreeSet::new();
        for seed in 0..400 {
            let plant = draw(&mut Random::new(seed))?;
            plant.model.check()?;
            measured.extend(plant.model.outputs.iter().map(|o| format!("{:?}", o.kind)));
            assert!(plant.sample_rate_hz >= OVERSAMPLED[0] * plant.band_hz[1]);
            names.insert(plant.model.name.clone());
        }
        // one mass, mold on a support, axis, 2 to 4 masses, shaken mass, free decay, arm, test stand
        assert_eq!(names.len(), 10, "{names:?}");
        assert_eq!(measured.len(), 4, "{measured:?}");
        Ok(())
    }
}
