//! A channel is stored in steps.

use crate::effect::{Action, Effect, Family, Parameter, SiteKind, SiteScale};
use crate::signal_map::{Sampled, SignalMap};

/// A channel is stored in steps: a converter of few bits, an encoder of few lines.
///
/// ```text
/// y_measured = q round(y / q)
/// ```
///
/// Halves are rounded away from zero, and zero is a level.
///
/// Reference: \[BendatPiersol2010\], quantization.
pub(crate) struct Quantisation;

struct Steps {
    step: f64,
}

impl SignalMap for Steps {
    fn apply(&self, signal: Sampled<'_>) -> Vec<f64> {
        if self.step <= 0.0 {
            return signal.values.to_vec();
        }
        let rounded = |&value: &f64| {
            let level = self.step * (value / self.step).round();
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
        "y_measured = q round(y / q)"
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
