//! A beat function whose lines have folded about the Nyquist frequency.

use std::f64::consts::{PI, TAU};

use crate::AlphaError;
use crate::beat::{BeatFit, BeatParameters, Polar, wrap};
use crate::error::{all_finite, positive};
use crate::least_squares::{linear, nonlinear};

/// Fits a beat function whose carrier *is* the Nyquist frequency, the only one that samples with
/// lines near Nyquist can tell: there both lines, at f_s/2 − d and f_s/2 + d, fall on f_s/2 − d,
///
/// ```text
/// cos(2π (f_s/2) n h) = (−1)ⁿ,      f(n h) = F₀ (−1)ⁿ cos(2π d n h + φ_s)
/// δ = 2 d,   ω = f_s − 2 d
/// ```
///
/// That the carrier is f_s/2, and that there is an upper line at all, is the assumption of this
/// form and not a finding. The start must be within about half a bin of d = f_s/2 − `line_hz`.
///
/// ```
/// use simgap_alpha::fit_folded_beat;
/// let beat: Vec<f64> = (0..1000)
///     .map(|n| 5.0 * f64::from(1 - 2 * (n % 2)) * (std::f64::consts::TAU * 0.02 * f64::from(n)).cos())
///     .collect();
/// let fit = fit_folded_beat(&beat, 0.01, 0, 48.0)?;
/// assert!((fit.parameters.amplitude - 5.0).abs() < 1e-9);
/// assert!((fit.parameters.base_hz - 96.0).abs() < 1e-9);
/// # Ok::<(), simgap_alpha::AlphaError>(())
/// ```
///
/// # Errors
/// As [`fit_beat`](crate::fit_beat); `line_hz` must lie between f_s/4 and f_s/2.
pub fn fit_folded_beat(
    values: &[f64],
    time_step_s: f64,
    skip: usize,
    line_hz: f64,
) -> Result<BeatFit, AlphaError> {
    positive("time step", time_step_s)?;
    all_finite("series", values)?;
    let nyquist_hz = 0.5 / time_step_s;
    if !(line_hz > 0.5 * nyquist_hz && line_hz < nyquist_hz) {
        return Err(AlphaError::Parameter {
            name: "line in Hz",
            found: line_hz,
            needed: format!("between {} and {nyquist_hz}", 0.5 * nyquist_hz),
        });
    }
    let used = values.get(skip..).unwrap_or_default();
    let middle = skip as f64 + 0.5 * (used.len().max(1) - 1) as f64;
    let time: Vec<f64> = (0..used.len())
        .map(|i| ((skip + i) as f64 - middle) * time_step_s)
        .collect();
    // Turning every other sample over moves the line from f_s/2 − d to d.
    let turned: Vec<f64> = used
        .iter()
        .enumerate()
        .map(|(i, value)| {
            if (skip + i).is_multiple_of(2) {
                *value
            } else {
                -value
            }
        })
        .collect();
    let begin = start(&time, &turned, nyquist_hz - line_hz)?;
    let scales = [begin[0], nyquist_hz, 1.0];
    let fit = nonlinear("folded beat part", &turned, &begin, &scales, |p| {
        line_model(&time, p)
    })?;
    let p = &fit.coefficients;
    let error = &fit.standard_errors;
    let turn = if p[0] < 0.0 { PI } else { 0.0 };
    Ok(BeatFit {
        parameters: BeatParameters {
            amplitude: p[0].abs(),
            base_hz: 2.0 * (nyquist_hz - p[1]),
            split_hz: 2.0 * p[1],
        },
        standard_error: BeatParameters {
            amplitude: error[0],
            base_hz: 2.0 * error[1],
            split_hz: 2.0 * error[1],
        },
        slow_phase: wrap(p[2] + turn - TAU * p[1] * middle * time_step_s),
        carrier_phase: 0.0,
        residual_rms: (fit.residual_square_sum / used.len() as f64).sqrt(),
    })
}

/// Amplitude, frequency and phase of the line at the starting frequency.
fn start(time: &[f64], turned: &[f64], freq_hz: f64) -> Result<[f64; 3], AlphaError> {
    let columns = vec![
        time.iter().map(|t| (TAU * freq_hz * t).cos()).collect(),
        time.iter().map(|t| (TAU * freq_hz * t).sin()).collect(),
    ];
    let fit = linear("folded beat part", &columns, turned)?.coefficients;
    let line = Polar::new(fit[0], fit[1]);
    Ok([line.amplitude, freq_hz, line.phase])
}

/// Values and derivatives of a line at parameters A, f, φ.
fn line_model(time: &[f64], p: &[f64]) -> (Vec<f64>, Vec<Vec<f64>>) {
    let mut fitted = Vec::with_capacity(time.len());
    let mut columns = vec![vec![]; 3];
    for t in time {
        let (sin, cos) = (TAU * p[1] * t + p[2]).sin_cos();
        fitted.push(p[0] * cos);
        columns[0].push(cos);
        columns[1].push(-p[0] * TAU * t * sin);
        columns[2].push(-p[0] * sin);
    }
    (fitted, columns)
}
