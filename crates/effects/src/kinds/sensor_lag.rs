//! A sensor follows with a first-order lag.

use std::f64::consts::TAU;

use crate::effect::{Action, Effect, Family, Parameter, SiteKind, SiteScale};
use crate::signal_map::{BEFORE, POINTS, Sampled, SignalMap};

/// A sensor follows with a first-order lag: a low-pass filter, a slow transducer.
///
/// ```text
/// τ ẏ_measured + y_measured = y
/// ```
///
/// With x = Δt/τ, a = e⁻ˣ and, between two samples, the polynomial of degree five through the six around
/// them, lᵢ its basis over [0, 1], the solution at the samples is exactly
///
/// ```text
/// zₙ₊₁ = a zₙ + Σᵢ wᵢ yₙ₊ᵢ,   i = −2 … 3                             (1)
/// wᵢ = ∫₀¹ x e^(−x(1−s)) lᵢ(s) ds                                   (2)
/// ```
///
/// y is taken as linear in the two intervals at either end. What the filter held before the record shows in it
/// as a transient c aⁿ. Where the channel was measured, c is that of least squares, and fades for a lag of a
/// tenth of the run or of half a sample; else it is none, z₀ = y₀.
///
/// Reference: \[Franklin1998\], section 4.3.
pub(crate) struct SensorLag;

/// Below this x, moments are summed as a series: the recursion would lose digits.
const SMALL: f64 = 1.0;
/// Terms of that series: the next one is below 1e-16.
const TERMS: usize = 18;
/// The transient is over where less than this of it is left.
const OVER: f64 = 1e-3;
/// The transient fades where the lag is about this share of the run and longer: it could not be told from the rest.
const LONGEST_TRANSIENT: f64 = 0.1;
/// The same where it is about this share of a sample and shorter: it would only fit the first sample.
const SHORTEST_TRANSIENT: f64 = 0.5;
/// How sharply, as a power.
const FADES: i32 = 8;

/// Coefficients of the basis polynomials lᵢ(s) of the points −2 … 3, from the power 0 on, times [`COMMON`].
const BASIS: [[f64; POINTS]; POINTS] = [
    [0.0, 6.0, -5.0, -5.0, 5.0, -1.0],
    [0.0, -12.0, 16.0, -1.0, -4.0, 1.0],
    [12.0, -4.0, -15.0, 5.0, 3.0, -1.0],
    [0.0, 12.0, 8.0, -7.0, -2.0, 1.0],
    [0.0, -6.0, -1.0, 7.0, 1.0, -1.0],
    [0.0, 4.0, 0.0, -5.0, 0.0, 1.0],
];
const COMMON: [f64; POINTS] = [120.0, 24.0, 12.0, 12.0, 24.0, 120.0];

pub(super) struct Lag {
    pub(super) time_constant_s: f64,
    /// Whether what is delivered is what the record holds, so that its start can be told.
    pub(super) is_measured: bool,
}

/// ∫₀¹ x e^(−x(1−s)) sᵏ ds for k = 0 … 5.
fn moments(x: f64) -> [f64; POINTS] {
    let mut moments = [0.0; POINTS];
    if x < SMALL {
        for (k, moment) in moments.iter_mut().enumerate() {
            // x Σⱼ (−x)ʲ k!/(k + j + 1)!
            let mut term = x / (k as f64 + 1.0);
            for j in 0..TERMS {
                *moment += term;
                term *= -x / (k + j + 2) as f64;
            }
        }
    } else {
        moments[0] = -(-x).exp_m1();
        for k in 1..POINTS {
            moments[k] = 1.0 - k as f64 / x * moments[k - 1];
        }
    }
    moments
}

/// (1) from z₀ = y₀.
fn filtered(values: &[f64], x: f64) -> Vec<f64> {
    let moments = moments(x);
    let weights: [f64; POINTS] = std::array::from_fn(|i| {
        let terms = BASIS[i].iter().zip(&moments);
        let sum: f64 = terms
            .map(|(coefficient, moment)| coefficient * moment)
            .sum();
        sum / COMMON[i]
    });
    // Linear: l₀ = 1 − s, l₁ = s.
    let line = [moments[0] - moments[1], moments[1]];
    let mut delivered = values.first().copied().unwrap_or(0.0);
    let mut signal = vec![delivered];
    for n in 1..values.len() {
        // (1), as a change: at rest nothing is left to rounding.
        let change = |points: &[f64], weights: &[f64]| -> f64 {
            let terms = points.iter().zip(weights);
            terms
                .map(|(value, weight)| weight * (value - delivered))
                .sum()
        };
        let first = (n - 1).checked_sub(BEFORE);
        let around = first.and_then(|first| values.get(first..first + POINTS));
        delivered += match around {
            Some(points) => change(points, &weights),
            None => change(&values[n - 1..=n], &line),
        };
        signal.push(delivered);
    }
    signal
}

impl SignalMap for Lag {
    fn ends_the_chain(&self) -> bool {
        self.is_measured
    }

    fn apply(&self, signal: Sampled<'_>) -> Vec<f64> {
        let x = signal.time_step_s / self.time_constant_s;
        if signal.values.is_empty() || !x.is_finite() {
            return signal.values.to_vec();
        }
        let mut delivered = filtered(signal.values, x);
        let Some(measured) = signal.measured.filter(|_| self.is_measured) else {
            return delivered;
        };
        let count = (-OVER.ln() / x).ceil() as usize;
        let decay = |n: usize| (-x * n as f64).exp();
        let (mut along, mut square) = (0.0, 0.0);
        for (n, (measured, value)) in measured.iter().zip(&delivered).take(count).enumerate() {
            along += decay(n) * (measured - value);
            square += decay(n) * decay(n);
        }
        let long = 1.0 / (x * LONGEST_TRANSIENT * delivered.len() as f64);
        let short = x * SHORTEST_TRANSIENT;
        let fades = 1.0 + long.powi(FADES) + short.powi(FADES);
        let transient = along / (f64::max(square, 1.0) * fades);
        for (n, value) in delivered.iter_mut().take(count).enumerate() {
            *value += transient * decay(n);
        }
        delivered
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
            is_measured: true,
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
