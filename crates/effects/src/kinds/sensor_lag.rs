//! A sensor follows with a first-order lag.

use std::f64::consts::TAU;

use crate::effect::{Action, Effect, Family, Parameter, SiteKind, SiteScale};
use crate::signal_map::{Sampled, SignalMap};

/// A sensor follows with a first-order lag: a low-pass filter, a slow transducer.
///
/// ```text
/// τ ẏ_measured + y_measured = y
/// ```
///
/// With y linear between samples, x = Δt/τ and a = e⁻ˣ, the solution at the samples is exactly
///
/// ```text
/// zₙ₊₁ = a zₙ + b₀ yₙ + b₁ yₙ₊₁,   z₀ = y₀                          (1)
/// b₁ = 1 − (1 − a)/x,   b₀ = 1 − a − b₁                             (2)
/// ```
///
/// Reference: \[Franklin1998\], section 4.3.
pub(crate) struct SensorLag;

/// Below this x, (2) is summed as a series: the difference would lose digits.
const SMALL: f64 = 1e-2;

pub(super) struct Lag {
    pub(super) time_constant_s: f64,
}

/// b₁ of (2).
fn end_weight(x: f64) -> f64 {
    if x < SMALL {
        // 1 − (1 − e⁻ˣ)/x = x/2 − x²/6 + x³/24 − …; the next term is below 1e-13 of the first.
        x * (1.0 / 2.0 - x * (1.0 / 6.0 - x * (1.0 / 24.0 - x * (1.0 / 120.0 - x / 720.0))))
    } else {
        1.0 + (-x).exp_m1() / x
    }
}

impl SignalMap for Lag {
    fn apply(&self, signal: Sampled<'_>) -> Vec<f64> {
        let x = signal.time_step_s / self.time_constant_s;
        let Some(&first) = signal.values.first().filter(|_| x.is_finite()) else {
            return signal.values.to_vec();
        };
        let rise = -(-x).exp_m1(); // 1 − a
        let end = end_weight(x);
        let start = rise - end;
        let (mut before, mut delivered) = (first, first);
        signal
            .values
            .iter()
            .map(|&value| {
                // (1), as a change: at rest nothing is left to rounding.
                delivered += start * (before - delivered) + end * (value - delivered);
                before = value;
                delivered
            })
            .collect()
    }
}

impl Effect for SensorLag {
    fn kind(&self) -> &'static str {
        "sensor_lag"
    }

    fn family(&self) -> Family {
        Family::Measurement
    }

    fn site(&self) -> SiteKind {
        SiteKind::Channel
    }

    fn summary(&self) -> &'static str {
        "the sensor follows with a first-order lag, as behind a low-pass filter"
    }

    fn equation(&self) -> &'static str {
        "tau dy_measured/dt + y_measured = y"
    }

    fn reference(&self) -> Option<&'static str> {
        Some("[Franklin1998], section 4.3")
    }

    fn parameters(&self) -> &'static [Parameter] {
        const { &[Parameter::size("time_constant_s", "s", 0.0, f64::INFINITY)] }
    }

    fn starts(&self, scale: &SiteScale) -> Vec<Vec<f64>> {
        let mut starts = vec![
            vec![2.0 * scale.time_step_s],
            vec![20.0 * scale.time_step_s],
        ];
        // The corner at the strongest line of the motion.
        if scale.motion_hz[0] > 0.0 {
            starts.push(vec![1.0 / (TAU * scale.motion_hz[0])]);
        }
        starts
    }

    fn action(&self, values: &[f64]) -> Action {
        Action::Output(Box::new(Lag {
            time_constant_s: values[0],
        }))
    }

    fn confused_with(&self) -> &'static [(&'static str, &'static str)] {
        &[
            (
                "sensor_delay",
                "well below the corner frequency a lag is a delay by its time constant",
            ),
            (
                "input_lag",
                "with one input and one output of a linear plant the lag may be at either end",
            ),
        ]
    }

    fn experiment(&self) -> &'static str {
        "broadband excitation beyond the corner frequency: a lag lowers the amplitude, a delay only turns the phase"
    }
}
