//! Small values of an input do not reach the plant.

use crate::effect::{Action, Effect, Family, Parameter, SiteKind, SiteScale};
use crate::signal_map::{Sampled, SignalMap};

/// Small values of an input do not reach the plant: a valve with overlap, a drive below its threshold.
///
/// ```text
/// u_plant = u − δ   for u > δ,   u + δ   for u < −δ,   0   between
/// ```
///
/// Reference: \[Tao1996\], chapter 2.
pub(crate) struct InputDeadZone;

/// Half widths that a fit starts from, as shares of the rms of the input.
const STARTS: [f64; 2] = [0.1, 0.5];

struct DeadZone {
    half_width: f64,
}

impl SignalMap for DeadZone {
    fn apply(&self, signal: Sampled<'_>) -> Vec<f64> {
        let beyond = |&u: &f64| u - u.clamp(-self.half_width, self.half_width);
        signal.values.iter().map(beyond).collect()
    }
}

impl Effect for InputDeadZone {
    fn kind(&self) -> &'static str {
        "input_dead_zone"
    }

    fn family(&self) -> Family {
        Family::Dynamics
    }

    fn site(&self) -> SiteKind {
        SiteKind::Input
    }

    fn summary(&self) -> &'static str {
        "small values of the input do not reach the plant, larger ones by so much less"
    }

    fn equation(&self) -> &'static str {
        "u_plant = u - delta (u > delta), u + delta (u < -delta), 0 between"
    }

    fn reference(&self) -> Option<&'static str> {
        Some("[Tao1996], chapter 2")
    }

    fn parameters(&self) -> &'static [Parameter] {
        const {
            &[Parameter::size(
                "half_width",
                "unit of the input",
                0.0,
                f64::INFINITY,
            )]
        }
    }

    fn starts(&self, scale: &SiteScale) -> Vec<Vec<f64>> {
        STARTS.map(|share| vec![share * scale.signal]).to_vec()
    }

    /// Of friction that takes as much of a force, where the plant moves one way.
    fn resembles(&self) -> &'static [&'static str] {
        &["coulomb_friction"]
    }

    fn grown_from(&self, kind: &str, values: &[f64], _scale: &SiteScale) -> Vec<Vec<f64>> {
        let is_start = self.resembles().contains(&kind) && values[0] > 0.0;
        is_start.then(|| vec![values[0]]).into_iter().collect()
    }

    fn action(&self, values: &[f64]) -> Action {
        Action::Input(Box::new(DeadZone {
            half_width: values[0].max(0.0),
        }))
    }

    fn confused_with(&self) -> &'static [(&'static str, &'static str)] {
        &[
            (
                "input_gain",
                "of an input of one amplitude a dead zone takes a part as a smaller gain does",
            ),
            (
                "coulomb_friction",
                "what a force has to overcome before anything moves may be friction",
            ),
        ]
    }

    fn experiment(&self) -> &'static str {
        "a slow triangle of the input through zero: the plant stands still while the input is small"
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::find;

    /// While a plant moves one way, what is missing of a force is the same in its channel and at the plant.
    #[test]
    fn verify_a_dead_zone_and_friction_take_as_much_of_a_force() {
        let scale = SiteScale::plain(1.0, 1.0, 1.0);
        let Some(friction) = find("coulomb_friction") else {
            panic!("a kind of the catalogue");
        };
        let level = friction.grown_from("input_dead_zone", &[6.7], &scale);
        assert_eq!(level, [[6.7]]);
        let Action::Force(law) = friction.action(&level[0]) else {
            panic!("a force");
        };
        let Action::Input(zone) = InputDeadZone.action(&[6.7]) else {
            panic!("a map of the input");
        };
        let drives = [7.0, 9.5, 20.0];
        let sampled = Sampled {
            values: &drives,
            time_step_s: 0.1,
            first_index: 0,
            start_s: 0.0,
            measured: None,
        };
        for (drive, through) in drives.iter().zip(zone.apply(sampled)) {
            let dry = law.dry_level(0.3).unwrap_or(0.0);
            assert!((drive - dry - through).abs() < 1e-12);
        }
        let back = InputDeadZone.grown_from("coulomb_friction", &[6.7], &scale);
        assert_eq!(back, [[6.7]]);
        assert!(
            InputDeadZone
                .grown_from("backlash", &[6.7], &scale)
                .is_empty()
        );
    }
}
