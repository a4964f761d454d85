//! Amplitude and phase spectrum and periodogram of a whole record.

use crate::real_fft::real_fft;
use crate::{Complex64, SignalError, Trend, Window, check};

/// One-sided amplitude and phase spectrum of a real record.
///
/// ```text
/// X_k = Σ_n w_n x_n e^{-2πi k n / N}
/// A_k = s |X_k| / (N a_0),   φ_k = arg X_k      s = 2, but 1 at 0 Hz and at fs/2
/// ```
///
/// so that x(t) = A cos(2π f t + φ) with f on a bin gives `amplitude` A and `phase_rad` φ.
///
/// | Symbol | Field | Unit | Shape |
/// |---|---|---|---|
/// | f_k = k fs/N | `freq_hz` | Hz | ⌊N/2⌋+1 |
/// | A_k | `amplitude` | that of the values | ⌊N/2⌋+1 |
/// | φ_k | `phase_rad` | rad, at the first sample | ⌊N/2⌋+1 |
/// | a_0 | `window.coherent_gain()` | 1 | |
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Spectrum {
    /// Frequency of each bin, Hz.
    pub freq_hz: Vec<f64>,
    /// Amplitude (half peak to peak) in each bin, unit of the values.
    pub amplitude: Vec<f64>,
    /// Phase of the cosine at the first sample, rad.
    pub phase_rad: Vec<f64>,
    /// Window the record was weighted with.
    pub window: Window,
    /// Samples of the record.
    pub sample_count: usize,
    /// Sample rate of the record, Hz.
    pub sample_rate_hz: f64,
}

impl Spectrum {
    /// Distance of two bins fs/N, Hz.
    #[must_use]
    pub fn bin_width_hz(&self) -> f64 {
        self.sample_rate_hz / self.sample_count as f64
    }

    /// Index of the bin nearest to a frequency (the last bin for any above it).
    #[must_use]
    pub fn nearest_bin(&self, freq_hz: f64) -> usize {
        let k = (freq_hz / self.bin_width_hz()).round().max(0.0) as usize;
        k.min(self.freq_hz.len().saturating_sub(1))
    }
}

/// Amplitude and phase spectrum of a record of any length, O(N log N).
///
/// # Errors
///
/// [`SignalError::TooShort`] below [`Window::min_len`] (and below 2 samples),
/// [`SignalError::NonFinite`], [`SignalError::OutOfRange`] for a sample rate that is not positive.
///
/// # Examples
///
/// ```
/// use simgap_signal::{Trend, Window, spectrum::spectrum};
/// let sample_rate_hz = 100.0;
/// let x: Vec<f64> = (0..200)
///     .map(|n| 3.0 * (std::f64::consts::TAU * 5.0 * n as f64 / sample_rate_hz).sin())
///     .collect();
/// let s = spectrum(&x, sample_rate_hz, Window::Hann, Trend::Mean)?;
/// let k = s.nearest_bin(5.0);
/// assert!((s.amplitude[k] - 3.0).abs() < 1e-12);
/// # Ok::<(), simgap_signal::SignalError>(())
/// ```
pub fn spectrum(
    values: &[f64],
    sample_rate_hz: f64,
    window: Window,
    trend: Trend,
) -> Result<Spectrum, SignalError> {
    let n = values.len();
    let bins = windowed_transform(values, sample_rate_hz, window, trend)?;
    let scale = 1.0 / (n as f64 * window.coherent_gain());
    let amplitude = bins
        .iter()
        .enumerate()
        .map(|(k, x)| one_sided(k, n) * scale * x.norm())
        .collect();
    Ok(Spectrum {
        freq_hz: bin_freqs(n, sample_rate_hz),
        amplitude,
        phase_rad: bins.iter().map(|x| x.arg()).collect(),
        window,
        sample_count: n,
        sample_rate_hz,
    })
}

/// One-sided power spectral density.
///
/// ```text
/// Σ_k density_k · Δf = mean square of the (detrended) signal
/// ```
///
/// The sum is exact for the rectangular window; with any other window it holds in the mean for
/// noise.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Psd {
    /// Frequency of each bin, Hz.
    pub freq_hz: Vec<f64>,
    /// Density, unit² per Hz.
    pub density: Vec<f64>,
    /// Distance of two bins, Hz.
    pub bin_width_hz: f64,
    /// Segments averaged.
    pub segments: usize,
    /// Independent segments they are worth, once overlap is accounted for (Welch1967).
    pub effective_averages: f64,
}

impl Psd {
    /// Mean square carried by the bins from `from_hz` to `to_hz`, both included.
    #[must_use]
    pub fn band_power(&self, from_hz: f64, to_hz: f64) -> f64 {
        self.freq_hz
            .iter()
            .zip(&self.density)
            .filter(|(f, _)| (from_hz..=to_hz).contains(*f))
            .map(|(_, d)| d * self.bin_width_hz)
            .sum()
    }
}

/// Periodogram of the whole record.
///
/// ```text
/// P_k = s |X_k|² / (fs Σ w²),    s = 2, but 1 at 0 Hz and at fs/2
/// ```
///
/// Its scatter does not shrink with the length of the record (one average): see [`crate::welch`].
///
/// # Errors
///
/// As [`spectrum`].
///
/// # Examples
///
/// ```
/// use simgap_signal::{Trend, Window, spectrum::periodogram};
/// let x = [1.0, -2.0, 0.5, 3.0, 1.0, -1.0, 0.0];
/// let p = periodogram(&x, 10.0, Window::Rectangular, Trend::Keep)?;
/// let mean_square = x.iter().map(|v| v * v).sum::<f64>() / 7.0;
/// assert!((p.band_power(0.0, 5.0) - mean_square).abs() < 1e-12);
/// # Ok::<(), simgap_signal::SignalError>(())
/// ```
pub fn periodogram(
    values: &[f64],
    sample_rate_hz: f64,
    window: Window,
    trend: Trend,
) -> Result<Psd, SignalError> {
    let n = values.len();
    let bins = windowed_transform(values, sample_rate_hz, window, trend)?;
    let scale = 1.0 / (sample_rate_hz * n as f64 * window.power_gain());
    let density = bins
        .iter()
        .enumerate()
        .map(|(k, x)| one_sided(k, n) * scale * x.norm_sqr())
        .collect();
    Ok(Psd {
        freq_hz: bin_freqs(n, sample_rate_hz),
        density,
        bin_width_hz: sample_rate_hz / n as f64,
        segments: 1,
        effective_averages: 1.0,
    })
}

/// 2 for bins with a mirror image, 1 for 0 Hz and for fs/2 (which only even lengths have).
pub(crate) fn one_sided(k: usize, n: usize) -> f64 {
    if k == 0 || 2 * k == n { 1.0 } else { 2.0 }
}

/// k fs/N for k = 0 … ⌊N/2⌋.
pub(crate) fn bin_freqs(n: usize, sample_rate_hz: f64) -> Vec<f64> {
    (0..=n / 2)
        .map(|k| k as f64 * sample_rate_hz / n as f64)
        .collect()
}

fn windowed_transform(
    values: &[f64],
    sample_rate_hz: f64,
    window: Window,
    trend: Trend,
) -> Result<Vec<Complex64>, SignalError> {
    check::finite("values", values, window.min_len().max(2))?;
    check::positive("sample_rate_hz", sample_rate_hz)?;
    let mut x = values.to_vec();
    trend.remove(&mut x);
    if window != Window::Rectangular {
        for (v, w) in x.iter_mut().zip(window.coefficients(values.len())?) {
            *v *= w;
        }
    }
    Ok(real_fft(&x))
}
