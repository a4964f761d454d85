//! Averaged power and cross spectra (Welch's method) of long records.

use rustfft::FftPlanner;

use crate::spectrum::{Psd, bin_freqs, one_sided};
use crate::{Complex64, SignalError, Trend, Window, check};

/// How a record is cut into segments.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct WelchOptions {
    /// Samples of a segment; the bins are fs / `segment_len` apart.
    pub segment_len: usize,
    /// Part of a segment shared with the next one, from 0 to below 1.
    pub overlap: f64,
    /// Window of each segment.
    pub window: Window,
    /// What is taken out of each segment first.
    pub trend: Trend,
}

impl WelchOptions {
    /// Hann window, half overlap, the mean of each segment removed.
    #[must_use]
    pub const fn new(segment_len: usize) -> Self {
        Self {
            segment_len,
            overlap: 0.5,
            window: Window::Hann,
            trend: Trend::Mean,
        }
    }
}

/// Power spectral density averaged over overlapping segments.
///
/// ```text
/// P_k = s / (K fs Σ w²) · Σ_segments |X_k|²,     s = 2, but 1 at 0 Hz and at fs/2
/// ```
///
/// | Symbol | Argument | Unit | Shape |
/// |---|---|---|---|
/// | x | `values` | any | N |
/// | fs | `sample_rate_hz` | Hz | |
/// | P | `density` | unit²/Hz | `segment_len`/2 + 1 |
/// | K | `segments` | 1 | |
///
/// The relative standard error of a bin is 1/√`effective_averages`. Samples after the last whole
/// segment are not used. Two segments go through one complex transform. Reference: Welch1967.
///
/// # Errors
///
/// [`SignalError::TooShort`] for a record shorter than a segment or a segment shorter than
/// [`Window::min_len`], [`SignalError::NonFinite`], [`SignalError::OutOfRange`] for the sample rate or
/// the overlap.
///
/// # Examples
///
/// ```
/// use simgap_signal::welch::{WelchOptions, welch};
/// let fs = 128.0;
/// let x: Vec<f64> = (0..1024).map(|n| (std::f64::consts::TAU * 16.0 * n as f64 / fs).sin()).collect();
/// let p = welch(&x, fs, &WelchOptions::new(128))?;
/// // The power of a unit sine is 1/2.
/// assert!((p.band_power(12.0, 20.0) - 0.5).abs() < 1e-12);
/// # Ok::<(), simgap_signal::SignalError>(())
/// ```
pub fn welch(
    values: &[f64],
    sample_rate_hz: f64,
    options: &WelchOptions,
) -> Result<Psd, SignalError> {
    let plan = Plan::new("values", values, sample_rate_hz, options)?;
    let len = options.segment_len;
    let bins = len / 2 + 1;
    let mut power = vec![0.0; bins];
    let mut transform = Transform::new(len);
    let starts: Vec<usize> = plan.starts().collect();
    for pair in starts.chunks(2) {
        transform.buffer.fill(Complex64::ZERO);
        for (part, &start) in pair.iter().enumerate() {
            plan.load(&values[start..start + len], part, &mut transform.buffer);
        }
        transform.run();
        // Z = X + iY:  |X_k|² + |Y_k|² = ½ (|Z_k|² + |Z_{L-k}|²)
        for (k, p) in power.iter_mut().enumerate() {
            let mirror = if k == 0 { 0 } else { len - k };
            *p += 0.5 * (transform.buffer[k].norm_sqr() + transform.buffer[mirror].norm_sqr());
        }
    }
    for (k, p) in power.iter_mut().enumerate() {
        *p *= one_sided(k, len) * plan.scale;
    }
    Ok(Psd {
        freq_hz: bin_freqs(len, sample_rate_hz),
        density: power,
        bin_width_hz: sample_rate_hz / len as f64,
        segments: plan.segments,
        effective_averages: plan.effective_averages(),
    })
}

/// Averaged power and cross spectral densities of two records.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct CrossSpectra {
    /// Frequency of each bin, Hz.
    pub freq_hz: Vec<f64>,
    /// Density of the first record, unit²/Hz.
    pub xx: Vec<f64>,
    /// Density of the second record, unit²/Hz.
    pub yy: Vec<f64>,
    /// Cross density ⟨conj(X) Y⟩, product of the units per Hz; its phase is that of y ahead of x.
    #[cfg_attr(feature = "serde", serde(with = "crate::serial"))]
    pub xy: Vec<Complex64>,
    /// Distance of two bins, Hz.
    pub bin_width_hz: f64,
    /// Segments averaged.
    pub segments: usize,
    /// Independent segments they are worth.
    pub effective_averages: f64,
}

/// One-sided power and cross spectral densities averaged over overlapping segments.
///
/// ```text
/// S_xy = s / (K fs Σ w²) · Σ_segments conj(X_k) Y_k
/// ```
///
/// Scaling, validity and reference as [`welch`]; y = h * x gives S_xy = H S_xx.
///
/// # Errors
///
/// As [`welch`], and [`SignalError::LengthMismatch`].
///
/// # Examples
///
/// ```
/// use simgap_signal::welch::{WelchOptions, cross_spectra};
/// let x: Vec<f64> = (0..500).map(|n| ((n * n) % 17) as f64).collect();
/// let y: Vec<f64> = x.iter().map(|v| -2.0 * v).collect();
/// let s = cross_spectra(&x, &y, 10.0, &WelchOptions::new(50))?;
/// assert!((s.xy[7] + s.xx[7] * 2.0).norm() < 1e-9);
/// # Ok::<(), simgap_signal::SignalError>(())
/// ```
pub fn cross_spectra(
    x: &[f64],
    y: &[f64],
    sample_rate_hz: f64,
    options: &WelchOptions,
) -> Result<CrossSpectra, SignalError> {
    check::same_len("y", y.len(), "x", x.len())?;
    let plan = Plan::new("x", x, sample_rate_hz, options)?;
    check::finite("y", y, 1)?;
    let len = options.segment_len;
    let bins = len / 2 + 1;
    let (mut xx, mut yy) = (vec![0.0; bins], vec![0.0; bins]);
    let mut xy = vec![Complex64::ZERO; bins];
    let mut transform = Transform::new(len);
    for start in plan.starts() {
        plan.load(&x[start..start + len], 0, &mut transform.buffer);
        plan.load(&y[start..start + len], 1, &mut transform.buffer);
        transform.run();
        // X_k = ½ (Z_k + conj Z_{L-k}),  Y_k = -½ i (Z_k - conj Z_{L-k})
        for k in 0..bins {
            let z = transform.buffer[k];
            let mirror = transform.buffer[if k == 0 { 0 } else { len - k }].conj();
            let x_k = (z + mirror) * 0.5;
            let y_k = (z - mirror) * Complex64::new(0.0, -0.5);
            xx[k] += x_k.norm_sqr();
            yy[k] += y_k.norm_sqr();
            xy[k] += x_k.conj() * y_k;
        }
    }
    for k in 0..bins {
        let scale = one_sided(k, len) * plan.scale;
        xx[k] *= scale;
        yy[k] *= scale;
        xy[k] *= scale;
    }
    Ok(CrossSpectra {
        freq_hz: bin_freqs(len, sample_rate_hz),
        xx,
        yy,
        xy,
        bin_width_hz: sample_rate_hz / len as f64,
        segments: plan.segments,
        effective_averages: plan.effective_averages(),
    })
}

/// Checked options, the weights, and the common scale 1/(K fs Σ w²).
struct Plan {
    weights: Vec<f64>,
    trend: Trend,
    step: usize,
    segments: usize,
    scale: f64,
}

impl Plan {
    fn new(
        what: &'static str,
        values: &[f64],
        sample_rate_hz: f64,
        options: &WelchOptions,
    ) -> Result<Self, SignalError> {
        let len = options.segment_len;
        let weights = options.window.coefficients(len)?;
        check::finite(what, values, len.max(2))?;
        check::positive("sample_rate_hz", sample_rate_hz)?;
        if !(0.0..1.0).contains(&options.overlap) {
            return Err(SignalError::OutOfRange {
                what: "overlap",
                value: options.overlap,
                needed: "a number from 0 to below 1",
            });
        }
        let step = ((len as f64 * (1.0 - options.overlap)).round() as usize).max(1);
        let segments = (values.len() - len) / step + 1;
        let energy = len as f64 * options.window.power_gain();
        let scale = 1.0 / (segments as f64 * sample_rate_hz * energy);
        Ok(Self {
            weights,
            trend: options.trend,
            step,
            segments,
            scale,
        })
    }

    fn starts(&self) -> impl Iterator<Item = usize> + use<> {
        let step = self.step;
        (0..self.segments).map(move |i| i * step)
    }

    /// Detrends and weighs a segment into the real (0) or imaginary (1) part of the buffer.
    fn load(&self, segment: &[f64], part: usize, buffer: &mut [Complex64]) {
        let (mean, slope) = self.trend.line(segment);
        let mid = 0.5 * (segment.len() as f64 - 1.0);
        let mut put = |i: usize, value: f64| {
            if part == 0 {
                buffer[i].re = value;
            } else {
                buffer[i].im = value;
            }
        };
        let weighed = segment.iter().zip(&self.weights).enumerate();
        if slope == 0.0 {
            weighed.for_each(|(i, (v, w))| put(i, w * (v - mean)));
        } else {
            weighed.for_each(|(i, (v, w))| put(i, w * (v - mean - slope * (i as f64 - mid))));
        }
    }

    /// K / (1 + 2 Σ_m (1 - m/K) ρ_m),  ρ_m = ( Σ_n w_n w_{n+mS} / Σ w² )²
    fn effective_averages(&self) -> f64 {
        let count = self.segments as f64;
        let len = self.weights.len();
        let energy: f64 = self.weights.iter().map(|w| w * w).sum();
        let mut sum = 1.0;
        for m in 1..self.segments {
            let shift = m * self.step;
            if shift >= len {
                break;
            }
            let product: f64 = self
                .weights
                .iter()
                .zip(&self.weights[shift..])
                .map(|(a, b)| a * b)
                .sum();
            sum += 2.0 * (1.0 - m as f64 / count) * (product / energy).powi(2);
        }
        count / sum
    }
}

/// A planned complex transform with its buffers.
struct Transform {
    fft: std::sync::Arc<dyn rustfft::Fft<f64>>,
    buffer: Vec<Complex64>,
    scratch: Vec<Complex64>,
}

impl Transform {
    fn new(len: usize) -> Self {
        let fft = FftPlanner::new().plan_fft_forward(len);
        let scratch = vec![Complex64::ZERO; fft.get_inplace_scratch_len()];
        Self {
            fft,
            buffer: vec![Complex64::ZERO; len],
            scratch,
        }
    }

    fn run(&mut self) {
        self.fft
            .process_with_scratch(&mut self.buffer, &mut self.scratch);
    }
}
