//! When check records refute a set.

use crate::Gap;

/// A set that leaves this many times what re-estimated parameters leave of the check records is refuted by them.
const HARMS: f64 = 1.05;
/// What leaves less than this multiple of all noise, that of the inputs too, may be nothing but noise.
const MAY_BE_NOISE: f64 = 1.2;
/// What the noise of the inputs does counts here from this part of the other noise, in squares.
const DRIVEN: f64 = 0.3;
/// Smallest part of what the noise of the inputs may have left of the check records that a set must close there, in
/// squares. Such noise looks like an effect in the records that were learned from, and in others like another one.
const CLOSES: f64 = 0.5;

/// Whether a set does worse on the check records than parameters alone, or no better than chance where the noise of the inputs
/// may be all there is. `gap` is over all noise.
pub(crate) fn is_refuted(gap: &Gap) -> bool {
    let [recalibrated, corrected, noise, driven] = [
        gap.recalibrated,
        gap.corrected,
        gap.noise_floor,
        gap.input_noise,
    ]
    .map(|rms| rms * rms);
    let white = noise - driven;
    let may_be_noise = driven > DRIVEN * white && recalibrated < MAY_BE_NOISE.powi(2) * noise;
    let closes = recalibrated - corrected >= CLOSES * (recalibrated - white);
    gap.corrected > HARMS * gap.recalibrated || may_be_noise && !closes
}

#[cfg(test)]
mod tests {
    use super::*;

    fn gap([recalibrated, corrected]: [f64; 2], [white, driven]: [f64; 2]) -> Gap {
        Gap {
            metric: "nrmse",
            nominal: recalibrated,
            recalibrated,
            corrected,
            noise_floor: white,
            input_noise: driven,
            closed: 0.0,
            channels: vec![],
        }
        .over_all_noise(0.0)
    }

    #[test]
    fn what_harms_is_refuted() {
        assert!(is_refuted(&gap([0.1, 0.12], [0.01, 0.0])));
        assert!(!is_refuted(&gap([0.1, 0.02], [0.01, 0.0])));
        // The check record need not show what the others do.
        assert!(!is_refuted(&gap([0.0101, 0.0101], [0.01, 0.0])));
    }

    /// An axis without a spring wanders with the noise of its drive.
    #[test]
    fn what_wanders_with_the_input_is_refuted_where_it_wanders_elsewhere() {
        let noise = [0.005, 0.023];
        assert!(is_refuted(&gap([0.0262, 0.0265], noise)));
        assert!(is_refuted(&gap([0.0262, 0.0255], noise)));
        assert!(!is_refuted(&gap([0.0262, 0.008], noise)));
        assert!(!is_refuted(&gap([0.1, 0.08], noise)));
        // A little of it beside more of the sensor is enough.
        assert!(is_refuted(&gap([0.00983, 0.00986], [0.00888, 0.0076])));
    }
}
