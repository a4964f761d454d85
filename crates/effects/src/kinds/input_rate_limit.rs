//! An input follows its command no faster than at a limited rate.

use std::f64::consts::TAU;

use crate::effect::{Action, Effect, Family, Parameter, SiteKind, SiteScale};
use crate::signal_map::{Sampled, SignalMap};

/// An input follows its command no faster than at a limited rate: a valve spool, an amplifier, a drive with a ramp.
///
/// ```text
/// |du_plant/dt| ≤ R,   as close to u as that allows
/// u_plant,n = u_plant,n−1 + min(max(u_n − u_plant,n−1, −R Δt), R Δt)
/// ```
///
/// It begins at the first value of the record.
pub(crate) struct InputRateLimit;

/// Limits that a fit starts from, as multiples of the rms rate of an input at the frequency of the motion.
const STARTS: [f64; 2] = [1.0, 0.3];
/// Without a line in the motion, samples of a period.
const PERIOD: f64 = 50.0;

struct RateLimit {
    per_s: f64,
}

impl SignalMap for RateLimit {
    fn apply(&self, signal: Sampled<'_>) -> Vec<f64> {
        let most = self.per_s * signal.time_step_s;
        let mut delivered = signal.values.first().copied().unwrap_or(0.0);
        let follow = |&u: &f64| {
            let change = u - delivered;
            // Within the limit it arrives, without a rounding of the sum.
            delivered = if change.abs() <= most {
                u
            } else {
                delivered + most.copysign(change)
            };
            delivered
        };
        signal.values.iter().map(follow).collect()
    }
}

impl Effect for InputRateLimit {
    fn kind(&self) -> &'static str {
        "input_rate_limit"
    }

    fn family(&self) -> Family {
        Family::Dynamics
    }

    fn site(&self) -> SiteKind {
        SiteKind::Input
    }

    fn summary(&self) -> &'static str {
        "the input follows its command no faster than at a limited rate"
    }

    fn equation(&self) -> &'static str {
        "|du_plant/dt| <= R, as close to u as that allows"
    }

    fn parameters(&self) -> &'static [Parameter] {
        const { &[Parameter::limit("rate_limit_per_s", "unit of the input/s")] }
    }

    fn starts(&self, scale: &SiteScale) -> Vec<Vec<f64>> {
        let freq = match scale.motion_hz[0] {
            line if line > 0.0 => line,
            _ => 1.0 / (PERIOD * scale.time_step_s),
        };
        let rate = TAU * freq * scale.signal;
        STARTS.map(|share| vec![share * rate]).to_vec()
    }

    fn action(&self, values: &[f64]) -> Action {
        Action::Input(Box::new(RateLimit { per_s: values[0] }))
    }

    fn confused_with(&self) -> &'static [(&'static str, &'static str)] {
        &[
            (
                "input_lag",
                "of an input of one amplitude a limited rate delays and lowers it as a lag does",
            ),
            (
                "input_saturation",
                "limits cut off the peaks of an input, a limited rate turns its steps into ramps",
            ),
        ]
    }

    fn experiment(&self) -> &'static str {
        "steps of the input of several sizes: under a limited rate the larger ones take longer"
    }
}
