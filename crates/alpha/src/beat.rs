//! The beat part of the unknown force (Table 4).

use std::f64::consts::{PI, TAU};

use crate::AlphaError;
use crate::error::{all_finite, positive};
use crate::least_squares::{linear, nonlinear};

/// The paper's beat function, its ω and δ printed in Hz and read as cycles:
///
/// ```text
/// f(t) = F₀ cos(π δ t) cos(π (ω + δ) t)                                       (1)
///      = F₀/2 cos(2π (ω/2) t) + F₀/2 cos(2π (ω/2 + δ) t)                      (2)
/// ```
///
/// | symbol | field | unit |
/// |---|---|---|
/// | F₀ | `amplitude` | N |
/// | ω | `base_hz` | Hz |
/// | δ | `split_hz` | Hz |
///
/// Reference: `park-mold`, Table 4.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct BeatParameters {
    /// F₀.
    pub amplitude: f64,
    /// ω, Hz.
    pub base_hz: f64,
    /// δ, Hz.
    pub split_hz: f64,
}

/// The two lines of a beat, (2).
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct LinePair {
    /// Lower line ω/2, Hz.
    pub lower_hz: f64,
    /// Upper line ω/2 + δ, Hz.
    pub upper_hz: f64,
    /// Amplitude of each line, F₀/2.
    pub line_amplitude: f64,
}

impl BeatParameters {
    /// The two lines.
    ///
    /// ```
    /// use simgap_alpha::BeatParameters;
    /// let beat = BeatParameters { amplitude: 75236.49, base_hz: 97.94, split_hz: 2.0 };
    /// let lines = beat.lines();
    /// assert!((lines.lower_hz - 48.97).abs() < 1e-12 && (lines.upper_hz - 50.97).abs() < 1e-12);
    /// ```
    #[must_use]
    pub fn lines(&self) -> LinePair {
        LinePair {
            lower_hz: 0.5 * self.base_hz,
            upper_hz: 0.5 * self.base_hz + self.split_hz,
            line_amplitude: 0.5 * self.amplitude,
        }
    }

    /// (ω + δ)/2, Hz: the middle of the two lines.
    #[must_use]
    pub fn carrier_hz(&self) -> f64 {
        0.5 * (self.base_hz + self.split_hz)
    }

    /// f(t) of (1).
    #[must_use]
    pub fn value(&self, time_s: f64) -> f64 {
        self.amplitude
            * (PI * self.split_hz * time_s).cos()
            * (PI * (self.base_hz + self.split_hz) * time_s).cos()
    }
}

impl LinePair {
    /// The beat function these lines are.
    #[must_use]
    pub fn beat(&self) -> BeatParameters {
        BeatParameters {
            amplitude: 2.0 * self.line_amplitude,
            base_hz: 2.0 * self.lower_hz,
            split_hz: self.upper_hz - self.lower_hz,
        }
    }
}

/// A fitted beat function, with the two phases the paper leaves to be "corrected":
///
/// ```text
/// f(t) = F₀ cos(π δ t + φ_s) cos(π (ω + δ) t + φ_c)
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct BeatFit {
    /// F₀, ω, δ.
    pub parameters: BeatParameters,
    /// Their standard errors.
    pub standard_error: BeatParameters,
    /// φ_s, rad.
    pub slow_phase: f64,
    /// φ_c, rad.
    pub carrier_phase: f64,
    /// Root mean square of what is left.
    pub residual_rms: f64,
}

impl BeatFit {
    /// f(t).
    #[must_use]
    pub fn value(&self, time_s: f64) -> f64 {
        let BeatParameters {
            amplitude,
            base_hz,
            split_hz,
        } = self.parameters;
        amplitude
            * (PI * split_hz * time_s + self.slow_phase).cos()
            * (PI * (base_hz + split_hz) * time_s + self.carrier_phase).cos()
    }
}

/// Fits a beat function whose two lines both lie below the Nyquist frequency. The start must be
/// within about half a bin, 1/(2 T), of the lines; its amplitude is not used.
///
/// ```text
/// f = F₀ S C,  S = cos θ_s,  C = cos θ_c,   θ_s = π δ t + φ_s,  θ_c = π (ω + δ) t + φ_c
/// ∂f/∂F₀ = S C                     ∂f/∂φ_s = −F₀ sin θ_s C     ∂f/∂φ_c = −F₀ S sin θ_c
/// ∂f/∂ω  = π t ∂f/∂φ_c             ∂f/∂δ   = π t (∂f/∂φ_s + ∂f/∂φ_c)
/// ```
///
/// # Errors
/// [`AlphaError::Parameter`] if a line is at or above the Nyquist frequency (there only
/// [`fit_folded_beat`](crate::fit_folded_beat) is possible), [`AlphaError::NoConvergence`] from a poor start,
/// [`AlphaError::Undetermined`] for lines closer than the record can tell.
pub fn fit_beat(
    values: &[f64],
    time_step_s: f64,
    start: BeatParameters,
) -> Result<BeatFit, AlphaError> {
    positive("time step", time_step_s)?;
    all_finite("series", values)?;
    let lines = start.lines();
    let nyquist_hz = 0.5 / time_step_s;
    positive("lower line", lines.lower_hz)?;
    positive("split", start.split_hz)?;
    if lines.upper_hz >= nyquist_hz {
        return Err(AlphaError::Parameter {
            name: "upper line in Hz",
            found: lines.upper_hz,
            needed: format!("below the Nyquist frequency {nyquist_hz}"),
        });
    }
    // Time from the middle of the record: frequency and phase errors are then uncorrelated.
    let middle_s = 0.5 * (values.len().max(1) - 1) as f64 * time_step_s;
    let time: Vec<f64> = (0..values.len())
        .map(|n| n as f64 * time_step_s - middle_s)
        .collect();
    let [line1, line2] = start_lines(values, &time, &lines)?;
    let amplitude = line1.amplitude + line2.amplitude;
    let begin = [
        amplitude,
        start.base_hz,
        start.split_hz,
        0.5 * (line2.phase - line1.phase),
        0.5 * (line1.phase + line2.phase),
    ];
    let scales = [amplitude.abs(), start.base_hz, start.base_hz, 1.0, 1.0];
    let fit = nonlinear("beat part", values, &begin, &scales, |p| {
        beat_model(&time, p)
    })?;
    let p = &fit.coefficients;
    // F₀ > 0 by half a turn of the carrier.
    let turn = if p[0] < 0.0 { PI } else { 0.0 };
    let slow = PI * p[2];
    let carrier = PI * (p[1] + p[2]);
    Ok(BeatFit {
        parameters: BeatParameters {
            amplitude: p[0].abs(),
            base_hz: p[1],
            split_hz: p[2],
        },
        standard_error: BeatParameters {
            amplitude: fit.standard_errors[0],
            base_hz: fit.standard_errors[1],
            split_hz: fit.standard_errors[2],
        },
        slow_phase: wrap(p[3] - slow * middle_s),
        carrier_phase: wrap(p[4] + turn - carrier * middle_s),
        residual_rms: (fit.residual_square_sum / values.len() as f64).sqrt(),
    })
}

/// Values and derivatives of the beat function at parameters F₀, ω, δ, φ_s, φ_c.
fn beat_model(time: &[f64], p: &[f64]) -> (Vec<f64>, Vec<Vec<f64>>) {
    let mut fitted = Vec::with_capacity(time.len());
    let mut columns = vec![vec![]; 5];
    for t in time {
        let (slow_sin, slow_cos) = (PI * p[2] * t + p[3]).sin_cos();
        let (carrier_sin, carrier_cos) = (PI * (p[1] + p[2]) * t + p[4]).sin_cos();
        let by_slow = -p[0] * slow_sin * carrier_cos;
        let by_carrier = -p[0] * slow_cos * carrier_sin;
        fitted.push(p[0] * slow_cos * carrier_cos);
        columns[0].push(slow_cos * carrier_cos);
        columns[1].push(PI * t * by_carrier);
        columns[2].push(PI * t * (by_slow + by_carrier));
        columns[3].push(by_slow);
        columns[4].push(by_carrier);
    }
    (fitted, columns)
}

/// Amplitude and phase of both lines at the starting frequencies.
fn start_lines(values: &[f64], time: &[f64], lines: &LinePair) -> Result<[Polar; 2], AlphaError> {
    let mut columns = Vec::with_capacity(4);
    for freq in [lines.lower_hz, lines.upper_hz] {
        columns.push(time.iter().map(|t| (TAU * freq * t).cos()).collect());
        columns.push(time.iter().map(|t| (TAU * freq * t).sin()).collect());
    }
    let b = linear("beat part", &columns, values)?.coefficients;
    Ok([Polar::new(b[0], b[1]), Polar::new(b[2], b[3])])
}

/// A cos(ωt + φ) of a fitted a cos ωt + b sin ωt.
pub(crate) struct Polar {
    /// A.
    pub(crate) amplitude: f64,
    /// φ, rad.
    pub(crate) phase: f64,
}

impl Polar {
    pub(crate) fn new(cosine: f64, sine: f64) -> Self {
        Self {
            amplitude: cosine.hypot(sine),
            phase: (-sine).atan2(cosine),
        }
    }
}

/// An angle brought into (−π, π].
pub(crate) fn wrap(angle: f64) -> f64 {
    let turned = angle.rem_euclid(TAU);
    if turned > PI { turned - TAU } else { turned }
}
