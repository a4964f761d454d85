//! The Fourier part of the unknown force (Table 3).

use std::f64::consts::TAU;

use crate::AlphaError;
use crate::error::{all_finite, positive};
use crate::least_squares::linear;

/// Points of a period on which the peak-to-peak value is read; with the highest harmonic in
/// reach (20) the peak is missed by less than (20 π/7200)² / 2 = 4e-5 of it.
const GRID: usize = 7200;

/// A mean and harmonics fitted to a series,
///
/// ```text
/// f(t) = a₀ + Σ_n a_n cos(2π n f t) + b_n sin(2π n f t),   n = 1 .. N
/// ```
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct FourierFit {
    /// f, Hz.
    pub base_freq_hz: f64,
    /// a₀.
    pub mean: f64,
    /// Standard error of a₀.
    pub mean_error: f64,
    /// a_1 .. a_N.
    pub cosine: Vec<f64>,
    /// b_1 .. b_N.
    pub sine: Vec<f64>,
    /// Standard errors of a_1 .. a_N.
    pub cosine_error: Vec<f64>,
    /// Standard errors of b_1 .. b_N.
    pub sine_error: Vec<f64>,
    /// Root mean square of what is left.
    pub residual_rms: f64,
}

impl FourierFit {
    /// f(t).
    #[must_use]
    pub fn value(&self, time_s: f64) -> f64 {
        let base = TAU * self.base_freq_hz * time_s;
        self.cosine
            .iter()
            .zip(&self.sine)
            .enumerate()
            .fold(self.mean, |sum, (n, (a, b))| {
                let (sin, cos) = ((n + 1) as f64 * base).sin_cos();
                sum + a * cos + b * sin
            })
    }

    /// max f − min f over one period, read on a grid of 7200 points.
    #[must_use]
    pub fn peak_to_peak(&self) -> f64 {
        let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
        for n in 0..GRID {
            let value = self.value(n as f64 / (GRID as f64 * self.base_freq_hz));
            least = least.min(value);
            most = most.max(value);
        }
        most - least
    }

    /// Amplitude of the n-th harmonic, n from 1; `None` beyond the last.
    #[must_use]
    pub fn amplitude(&self, harmonic: usize) -> Option<f64> {
        let at = harmonic.checked_sub(1)?;
        Some(self.cosine.get(at)?.hypot(*self.sine.get(at)?))
    }
}

/// Fits a mean and `harmonics` harmonics of a known frequency by least squares. Sample n is at
/// n h; `skip` samples at the start are left out.
///
/// Valid for 1 to 20 harmonics below the Nyquist frequency and more samples than coefficients.
///
/// ```
/// use simgap_alpha::fit_fourier;
/// let wave: Vec<f64> = (0..200).map(|n| 3.0 + (0.05 * f64::from(n)).sin()).collect();
/// let freq = 5.0 / std::f64::consts::TAU;
/// let fit = fit_fourier(&wave, 0.01, 0, freq, 1)?;
/// assert!((fit.mean - 3.0).abs() < 1e-9 && (fit.peak_to_peak() - 2.0).abs() < 1e-5);
/// # Ok::<(), simgap_alpha::AlphaError>(())
/// ```
///
/// # Errors
/// [`AlphaError::Parameter`] out of range, [`AlphaError::Length`] for too few samples,
/// [`AlphaError::Undetermined`] for a record far shorter than a period.
pub fn fit_fourier(
    values: &[f64],
    time_step_s: f64,
    skip: usize,
    base_freq_hz: f64,
    harmonics: usize,
) -> Result<FourierFit, AlphaError> {
    positive("time step", time_step_s)?;
    positive("base frequency", base_freq_hz)?;
    all_finite("series", values)?;
    if !(1..=20).contains(&harmonics) {
        return Err(AlphaError::Parameter {
            name: "number of harmonics",
            found: harmonics as f64,
            needed: "1 to 20".to_owned(),
        });
    }
    let nyquist_hz = 0.5 / time_step_s;
    let highest_hz = harmonics as f64 * base_freq_hz;
    if highest_hz >= nyquist_hz {
        return Err(AlphaError::Parameter {
            name: "highest harmonic in Hz",
            found: highest_hz,
            needed: format!("below the Nyquist frequency {nyquist_hz}"),
        });
    }
    let used = values.get(skip..).unwrap_or_default();
    let phase = |i: usize| TAU * base_freq_hz * (skip + i) as f64 * time_step_s;
    let mut columns = vec![vec![1.0; used.len()]];
    for n in 1..=harmonics {
        let order = n as f64;
        columns.push((0..used.len()).map(|i| (order * phase(i)).cos()).collect());
        columns.push((0..used.len()).map(|i| (order * phase(i)).sin()).collect());
    }
    let fit = linear("Fourier part", &columns, used)?;
    let every_other = |from: &[f64], first: usize| -> Vec<f64> {
        from.iter().skip(first).step_by(2).copied().collect()
    };
    Ok(FourierFit {
        base_freq_hz,
        mean: fit.coefficients[0],
        mean_error: fit.standard_errors[0],
        cosine: every_other(&fit.coefficients, 1),
        sine: every_other(&fit.coefficients, 2),
        cosine_error: every_other(&fit.standard_errors, 1),
        sine_error: every_other(&fit.standard_errors, 2),
        residual_rms: (fit.residual_square_sum / used.len() as f64).sqrt(),
    })
}
