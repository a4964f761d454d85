//! A channel is stored in steps.

use crate::effect::{Action, Effect, Family, Parameter, SiteKind, SiteScale};
use crate::signal_map::{Sampled, SignalMap};

/// A channel is stored in steps: a converter of few bits, an encoder of few lines.
///
/// ```text
/// y_measured = o + q round((y − o) / q)
/// ```
///
/// Halves are rounded away from zero. Zero is a level of some converters, and lies between two of others.
///
/// Reference: \[BendatPiersol2010\], quantization.
pub(crate) struct Quantisation;

struct Steps {
    step: f64,
    level: f64,
}

impl SignalMap for Steps {
    fn apply(&self, signal: Sampled<'_>) -> Vec<f64> {
        if self.step <= 0.0 {
            return signal.values.to_vec();
        }
        let rounded = |&value: &f64| {
            let level = self.level + self.step * ((value - self.level) / self.step).round();
            if level.is_finite() { level } else { value }
        };
        signal.values.iter().map(rounded).collect()
    }

    fn step(&self) -> Option<f64> {
        Some(self.step)
    }

    fn is_lossy(&self) -> bool {
        true
    }
}

impl Effect for Quantisation {
    fn kind(&self) -> &'static str {
        "quantisation"
    }

    fn family(&self) -> Family {
        Family::Measurement
    }

    fn site(&self) -> SiteKind {
        SiteKind::Channel
    }

    fn summary(&self) -> &'static str {
        "the channel is stored in coarse steps: its values lie on a lattice"
    }

    fn equation(&self) -> &'static str {
        "y_measured = o + q round((y - o) / q)"
    }

    fn reference(&self) -> Option<&'static str> {
        Some("[BendatPiersol2010], quantization")
    }

    fn parameters(&self) -> &'static [Parameter] {
        const {
            &[
                Parameter::size("step", "unit of the output", 0.0, f64::INFINITY),
                Parameter::shape(
                    "level",
                    "unit of the output",
                    f64::NEG_INFINITY,
                    f64::INFINITY,
                ),
            ]
        }
    }

    /// The values of the records show the step and its levels; where they lie on no lattice there is none.
    fn starts(&self, scale: &SiteScale) -> Vec<Vec<f64>> {
        if scale.signal_step > 0.0 {
            vec![vec![scale.signal_step, scale.signal_level]]
        } else {
            vec![]
        }
    }

    /// The lattice says its step and its level as finely as its values are written.
    fn is_chosen(&self, _: usize) -> bool {
        true
    }

    fn left_out(&self, parameter: &str) -> Option<f64> {
        (parameter == "level").then_some(0.0)
    }

    fn action(&self, values: &[f64]) -> Action {
        Action::Sampling(Box::new(Steps {
            step: values[0],
            level: values[1],
        }))
    }

    fn confused_with(&self) -> &'static [(&'static str, &'static str)] {
        &[(
            "dropouts",
            "a slow signal stored in steps repeats its values as a held sample does",
        )]
    }

    fn experiment(&self) -> &'static str {
        "a small slow motion of a few steps: the values stay on the same lattice"
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verify_zero_is_a_level_or_lies_between_two() {
        let values = [-0.9, -0.3, 0.1, 0.4, 0.9, 1.2];
        let apply = |level| Steps { step: 0.5, level }.apply(Sampled::from_start(&values, 0.1));
        assert_eq!(apply(0.0), [-1.0, -0.5, 0.0, 0.5, 1.0, 1.0]);
        assert_eq!(apply(0.25), [-0.75, -0.25, 0.25, 0.25, 0.75, 1.25]);
    }
}
