//! A channel is stored in steps.

use crate::effect::{Action, Effect, Family, Parameter, SiteKind, SiteScale};
use crate::signal_map::{Sampled, SignalMap};

/// A channel is stored in steps: a converter of few bits, an encoder of few lines.
///
/// ```text
/// y_measured = o + q round((y − o) / q)
/// ```
///
/// Halves are rounded away from zero. The level o is one of those that the measured values lie on, as the record shows
/// it: zero is a level of some converters, and lies between two of others. Where nothing is measured, it is zero.
///
/// Reference: \[BendatPiersol2010\], quantization.
pub(crate) struct Quantisation;

struct Steps {
    step: f64,
}

/// Share of a step by which a value may miss its level: values are written with few digits.
const OFF_LEVEL: f64 = 0.05;
/// Share of the values that may lie on no level.
const STRAYS: f64 = 0.1;

impl Steps {
    /// A level near zero that the measured values lie on; zero where they lie on none.
    fn level(&self, measured: &[f64]) -> f64 {
        let beside = |value: f64| value - self.step * (value / self.step).round();
        let level = measured.first().map_or(0.0, |&first| beside(first));
        let misses = |value: &&f64| beside(**value - level).abs() > OFF_LEVEL * self.step;
        let strays = measured.iter().filter(misses).count() as f64;
        let is_level =
            level.abs() > OFF_LEVEL * self.step && strays <= STRAYS * measured.len() as f64;
        if is_level { level } else { 0.0 }
    }
}

impl SignalMap for Steps {
    fn apply(&self, signal: Sampled<'_>) -> Vec<f64> {
        if self.step <= 0.0 {
            return signal.values.to_vec();
        }
        let origin = self.level(signal.measured.unwrap_or_default());
        let rounded = |&value: &f64| {
            let level = origin + self.step * ((value - origin) / self.step).round();
            if level.is_finite() { level } else { value }
        };
        signal.values.iter().map(rounded).collect()
    }

    fn is_stepped(&self) -> bool {
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
        "y_measured = o + q round((y - o) / q), o a level of the record"
    }

    fn reference(&self) -> Option<&'static str> {
        Some("[BendatPiersol2010], quantization")
    }

    fn parameters(&self) -> &'static [Parameter] {
        const {
            &[Parameter::size(
                "step",
                "unit of the output",
                0.0,
                f64::INFINITY,
            )]
        }
    }

    /// The values of a record show the step; where they lie on no lattice there is none.
    fn starts(&self, scale: &SiteScale) -> Vec<Vec<f64>> {
        if scale.signal_step > 0.0 {
            vec![vec![scale.signal_step]]
        } else {
            vec![]
        }
    }

    fn action(&self, values: &[f64]) -> Action {
        Action::Sampling(Box::new(Steps { step: values[0] }))
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
    fn verify_the_levels_are_those_of_the_record() {
        let values = [-0.9, -0.3, 0.1, 0.4, 0.9, 1.2];
        let apply = |measured: Option<&[f64]>| {
            let signal = Sampled {
                measured,
                ..Sampled::from_start(&values, 0.1)
            };
            Steps { step: 0.5 }.apply(signal)
        };
        let about_zero = [-1.0, -0.5, 0.0, 0.5, 1.0, 1.0];
        assert_eq!(apply(None), about_zero);
        assert_eq!(apply(Some(&about_zero)), about_zero);
        // Zero lies between two levels.
        let between = [-0.75, -0.25, 0.25, 0.25, 0.75, 1.25];
        assert_eq!(apply(Some(&between)), between);
        // What lies on no lattice says nothing.
        assert_eq!(apply(Some(&[0.1, 0.3, 0.45, -0.9, -0.2, 0.6])), about_zero);
    }
}
