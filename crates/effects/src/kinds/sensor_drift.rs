//! A sensor drifts steadily.

use crate::effect::{Action, Effect, Family, Parameter, SiteKind, SiteScale};
use crate::signal_map::{Sampled, SignalMap};

/// A sensor drifts steadily.
///
/// ```text
/// y_measured(t) = y(t) + r t,   t from the start of the record
/// ```
///
/// Reference: \[BendatPiersol2010\], spurious trends.
pub(crate) struct SensorDrift;

struct Drift {
    rate_per_s: f64,
}

impl SignalMap for Drift {
    fn apply(&self, signal: Sampled<'_>) -> Vec<f64> {
        let per_sample = self.rate_per_s * signal.time_step_s;
        let values = signal.values.iter().enumerate();
        values
            .map(|(i, value)| value + per_sample * (signal.first_index + i) as f64)
            .collect()
    }
}

impl Effect for SensorDrift {
    fn kind(&self) -> &'static str {
        "sensor_drift"
    }

    fn family(&self) -> Family {
        Family::Measurement
    }

    fn site(&self) -> SiteKind {
        SiteKind::Channel
    }

    fn summary(&self) -> &'static str {
        "the reading of the sensor drifts steadily with time"
    }

    fn equation(&self) -> &'static str {
        "y_measured(t) = y(t) + r t, t from the start of the record"
    }

    fn reference(&self) -> Option<&'static str> {
        Some("[BendatPiersol2010], spurious trends")
    }

    fn parameters(&self) -> &'static [Parameter] {
        const {
            &[Parameter::size(
                "drift_rate_per_s",
                "unit of the output/s",
                f64::NEG_INFINITY,
                f64::INFINITY,
            )]
        }
    }

    fn starts(&self, scale: &SiteScale) -> Vec<Vec<f64>> {
        vec![vec![0.1 * scale.signal / scale.duration_s]]
    }

    fn action(&self, values: &[f64]) -> Action {
        Action::Output(Box::new(Drift {
            rate_per_s: values[0],
        }))
    }

    fn confused_with(&self) -> &'static [(&'static str, &'static str)] {
        &[
            (
                "sensor_bias",
                "in a short record a drift has hardly left its mean",
            ),
            (
                "constant_force",
                "a mass that only a damper holds creeps away steadily under a constant force",
            ),
        ]
    }

    fn experiment(&self) -> &'static str {
        "a long record of the machine at rest, the sensor warmed up and then cold"
    }
}
